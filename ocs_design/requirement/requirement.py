"""What the device must do, put together."""

from dataclasses import dataclass

from ocs_design.requirement.maneuver import Maneuver


@dataclass(frozen=True, eq=False)
class Requirement:
    """Everything that the flywheels must be able to do.

    Attributes:
        maneuvers: see `Maneuver`; may be empty.
        rate_change: of the trunk, on roll and pitch one at a time [rad/s]; None: not asked.
        wheel_speed_max: of a wheel relative to the trunk [rad/s].
        spin_inertia: of one wheel, asked for in place of all else [kg m^2]; None: solved for.
        standing_height: of the trunk over the ground, for maneuvers that end there [m].
    """

    maneuvers: tuple[Maneuver, ...]
    rate_change: float | None
    wheel_speed_max: float
    spin_inertia: float | None
    standing_height: float
