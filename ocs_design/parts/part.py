"""A part: one piece of one material."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import Any, Generic

from ocs_design.parts.moments import MassMoments, Real, mass_properties
from ocs_design.parts.solids import Prism, Revolution, Solid
from ocs_design.robot.mass import MassProperties, combine


@dataclass(frozen=True)
class Part(Generic[Real]):
    """Solids joined, less solids cut out; with arrays for sizes, many parts at once to be weighed.

    What it weighs is right only if the solids that are joined do not overlap (they touch), and the
    holes lie within them and do not overlap either. Whoever makes a part sees to that; the tests
    compare it with its mesh and its B-rep, which do not rest on it.

    Attributes:
        name: of the part, also in files.
        density: [kg/m^3].
        solids: at least one.
        holes: holes, slots, marks.
    """

    name: str
    density: float
    solids: tuple[Revolution | Prism[Real], ...]
    holes: tuple[Prism[Real] | Revolution, ...] = ()

    @property
    def joined(self) -> tuple[Solid, ...]:
        """The solids of a drawn part, those of rings one by one."""
        return tuple(one for solid in self.solids for one in solid.each())

    @property
    def cut(self) -> tuple[Solid, ...]:
        """What is cut out of a drawn part, one by one."""
        return tuple(one for solid in self.holes for one in solid.each())

    def mass(self) -> Real:
        """Mass in closed form [kg]."""
        whole: Any = sum(solid.volume() for solid in self.solids)
        mass: Real = self.density * (whole - sum(hole.volume() for hole in self.holes))
        return mass

    def moments(self) -> MassMoments[Real]:
        """Mass and its moments in the part's frame, in closed form."""
        whole: MassMoments[Any] = reduce(add, (solid.moments() for solid in self.solids))
        if self.holes:
            whole += reduce(add, (hole.moments() for hole in self.holes)).times(-1.0)
        return whole.times(self.density)

    def mass_properties(self) -> MassProperties:
        """Mass properties of one part in its own frame, in closed form."""
        return mass_properties(self.moments())


def total(parts: Iterable[Part[float]]) -> MassProperties:
    """Mass properties of parts that share one frame."""
    return combine(part.mass_properties() for part in parts)
