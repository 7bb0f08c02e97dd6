"""Units in which a program counts, so that its numbers are around one, and the limits in them."""

from dataclasses import dataclass
from math import inf, isfinite

from ocs_design.drive.line import DriveLine


@dataclass(frozen=True)
class Units:
    """What a program counts in.

    Attributes:
        time: [s]. rate: of the trunk [rad/s]. speed: of a wheel [rad/s].
        torque: of a motor at its wheel [N m]. inertia: of the whole robot [kg m^2].
    """

    time: float
    rate: float
    speed: float
    torque: float
    inertia: float


@dataclass(frozen=True)
class Limits:
    """Of a drive, its no-load speed being the unit of speed.

    Attributes:
        slope: of the voltage line, |speed + slope torque| <= 1; 0: no line.
        torque: largest; inf: not limited.
        speed: largest; inf: the voltage is what limits it.
    """

    slope: float
    torque: float
    speed: float

    @classmethod
    def of(cls, line: DriveLine, units: Units) -> "Limits":
        """Those of `line`, whose no-load speed is `units.speed`."""
        slope = units.torque / float(line.stall_torque)
        highest = float(line.speed_max) / units.speed
        return cls(
            slope=slope,
            torque=float(line.torque_limit) / units.torque,
            speed=min(highest, 1.0) if slope == 0.0 or highest < 1.0 else inf,
        )


def torque_unit(line: DriveLine, demand: float) -> float:
    """The current limit, else the stall torque, else what the turn asks for [N m]."""
    candidates = (float(line.torque_limit), float(line.stall_torque), demand)
    return next(torque for torque in candidates if isfinite(torque))
