"""How a motor is held, and how it holds its wheel, as its data sheet draws it."""

from dataclasses import dataclass
from enum import StrEnum
from math import pi, sin

from ocs_design.fasteners import screw


class Face(StrEnum):
    """Of a motor, on which its own threads are."""

    OUTPUT = "output"
    """The one that its shaft comes out of: flat motors, inrunners."""
    BACK = "back"
    """The other: outrunners of aircraft."""


@dataclass(frozen=True)
class BoltCircle:
    """Threads around a motor's axis, evenly spaced.

    Attributes:
        diameter: of the circle that they are on [m].
        bolts: how many.
        thread: of each, such as "M3".
    """

    diameter: float
    bolts: int
    thread: str

    def __str__(self) -> str:
        """For people, as in `4 x M3 on 25 mm`."""
        return f"{self.bolts} x {self.thread} on {1e3 * self.diameter:.4g} mm"

    @property
    def radius(self) -> float:
        """Of the circle [m]."""
        return self.diameter / 2.0

    @property
    def hole_radius(self) -> float:
        """Of the holes that its screws pass through, ISO 273 medium [m]."""
        return screw(self.thread).clearance_hole / 2.0

    @property
    def inside(self) -> float:
        """Radius that the holes stay outside of [m]."""
        return self.radius - self.hole_radius

    @property
    def reach(self) -> float:
        """Radius that the holes stay within [m]."""
        return self.radius + self.hole_radius

    @property
    def spacing(self) -> float:
        """Material between neighbouring holes [m]."""
        return 2.0 * (self.radius * sin(pi / self.bolts) - self.hole_radius)


@dataclass(frozen=True)
class Mounting:
    """What holds a wheel on a motor, and the motor on what stands still.

    None is what no source gives.

    Attributes:
        shaft_diameter: of the shaft where it comes out of the motor on the wheel's side [m].
        rotor: threads in what turns, on the wheel's side.
        stator: threads in what stands still. stator_face: where they are.
        shaft_length: by which the shaft stands out there, from the motor's face [m].
    """

    shaft_diameter: float | None = None
    rotor: BoltCircle | None = None
    stator: BoltCircle | None = None
    stator_face: Face | None = None
    shaft_length: float | None = None
