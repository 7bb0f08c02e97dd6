"""How motor, housing and foot hold together: holes that all of them share."""

from collections.abc import Iterator
from dataclasses import dataclass

from ocs_design.parts.outline import circle
from ocs_design.parts.solids import Prism
from ocs_design.parts.wheel import HoleRing
from ocs_design.robot.tree import Placement
from ocs_design.sizing.mount import MountHoles


@dataclass(frozen=True)
class Mount:
    """Through holes around the wheel's axis.

    The motor stands outside, on the foot's plate, or in a cage there; the screws of either go
    through the housing's floor and the plate, with their heads inside.

    Attributes:
        pilot_radius: of the hole in the middle, for shaft and centring collar [m]; 0: none.
        rings: for the motor's screws, and others; the first of each straight up.
    """

    pilot_radius: float = 0.0
    rings: tuple[HoleRing, ...] = ()

    @property
    def reach(self) -> float:
        """Radius that the holes stay within [m]."""
        return max(
            (self.pilot_radius, *(ring.radius + ring.hole_radius for ring in self.rings)),
        )

    def holes(self, low: float, high: float, placement: Placement | None = None) -> Iterator[Prism]:
        """Along the z axis of `placement`, between two heights on it [m]."""
        frame = placement or Placement.identity()
        if self.pilot_radius > 0.0:
            yield Prism(circle(self.pilot_radius), low, high, frame)
        for ring in self.rings:
            for hole in ring.prisms(low, high):
                yield Prism(hole.outline, low, high, frame)


def made_mount(holes: MountHoles) -> Mount:
    """As they are drilled."""
    screws = holes.screws
    rings = () if screws is None else (HoleRing(screws.radius, screws.bolts, screws.hole_radius),)
    return Mount(holes.pilot_radius, rings)
