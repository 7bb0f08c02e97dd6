"""A part: one piece of one material."""

from dataclasses import dataclass

from ocs_design.arrays import FloatArray
from ocs_design.parts.solids import Revolution, Solid
from ocs_design.robot.mass_properties import MassProperties, combine


@dataclass(frozen=True)
class Part:
    """Solids joined, less solids cut out.

    Its mass properties are right only if the solids that are joined do not overlap (they touch),
    and the cuts lie within them and do not overlap either. Whoever makes a part sees to that; the
    tests compare it with its mesh and its B-rep, which do not rest on it.

    Attributes:
        name: of the part, also in files.
        density: [kg/m^3].
        joined: at least one solid.
        cut: holes, slots, marks.
    """

    name: str
    density: float
    joined: tuple[Solid, ...]
    cut: tuple[Solid, ...] = ()

    def mass_properties(self) -> MassProperties:
        """In the part's frame, in closed form."""
        return combine(
            [
                *(solid.mass_properties(self.density) for solid in self.joined),
                *(solid.mass_properties(-self.density) for solid in self.cut),
            ]
        )

    def swept_profiles(self) -> tuple[FloatArray, ...]:
        """Cross-sections of what its bodies of revolution sweep over a turn, cuts not regarded.

        Each r and z [m], shape (n, 2). Prisms are not in it.
        """
        return tuple(solid.profile for solid in self.joined if isinstance(solid, Revolution))


def total(parts: tuple[Part, ...]) -> MassProperties:
    """Mass properties of parts that share one frame."""
    return combine(part.mass_properties() for part in parts)
