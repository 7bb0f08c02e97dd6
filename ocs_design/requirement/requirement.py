"""Everything that the flywheels must be able to do, and what is kept in reserve for it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.requirement.maneuver import Disturbance, Maneuver, Slew
from ocs_design.requirement.pivoted import Pivoted
from ocs_design.robot.mass import MassProperties


@dataclass(frozen=True)
class ManeuverReserve:
    """What a device keeps for a maneuver that is not quite as designed.

    Attributes:
        demand: factor on what is asked of the wheels, at least 1.
        rate: of roll and pitch that the trunk may begin with [rad/s].
        begun: factor on what is asked with that rate; below 1 where there is enough to spare.
        roll: rate of roll at lift-off that a flip undoes [rad/s], see `turned_roll`.
        short: whether a device that keeps nothing lacks any of this.
    """

    demand: float = 1.0
    rate: tuple[float, float] = (0.0, 0.0)
    begun: float = 1.0
    roll: float = 0.0
    short: bool = False


_NOTHING_KEPT = ManeuverReserve()


@dataclass(frozen=True, eq=False)
class Requirement:
    """Everything that the flywheels must be able to do.

    Attributes:
        maneuvers: see `Maneuver`; may be empty.
        rate_change: of the trunk, on roll and pitch one at a time [rad/s]; None: not asked.
        wheel_speed_max: of a wheel relative to the trunk [rad/s].
        spin_inertia: of one wheel, asked for in place of all else [kg m^2]; None: solved for.
        standing_height: of the trunk over the ground, for maneuvers that end there [m].
        reserves: kept for maneuvers by their names; none for those that are not in it.
        free: whether the incidence is still to be chosen.
        detection: time until it is known that a drive has stopped, where the wheels must do all
            with any one of them left out [s]; None: they need not.
    """

    maneuvers: tuple[Maneuver, ...]
    rate_change: float | None
    wheel_speed_max: float
    spin_inertia: float | None
    standing_height: float
    reserves: Mapping[str, ManeuverReserve] = field(default_factory=dict)
    free: bool = False
    detection: float | None = None

    def changed(self, change: Callable[[Maneuver], Maneuver]) -> "Requirement":
        """Requirement with what becomes of each maneuver."""
        return replace(self, maneuvers=tuple(map(change, self.maneuvers)))

    def on(self, body: MassProperties) -> "Requirement":
        """Requirement of a body, which kicks and pivots depend on (`Maneuver.on`)."""
        return self.changed(lambda each: each.on(body))

    @property
    def kicks(self) -> FloatArray:
        """Momenta about roll and pitch that follow from the body [N m s], shape (n, 2).

        They are the angular impulses of forces, and what wheels take about a pivot.
        """
        found = []
        for each in self.maneuvers:
            if isinstance(each, Disturbance) and any(each.impulse):
                found.append(np.multiply(each.torque[:2], each.duration))
            elif isinstance(each, Pivoted):
                found.append(each.momentum(TiltInertia.uncoupled(np.ones(2)), 0.0))
        return np.reshape(found, (-1, 2))

    def reserve(self, maneuver: Maneuver) -> ManeuverReserve:
        """What is kept for a maneuver; nothing where there is no reserve."""
        return self.reserves.get(maneuver.name, _NOTHING_KEPT)

    def slew(self, maneuver: Maneuver, inertia: TiltInertia, *, begun: bool = False) -> Slew:
        """What a motor must do for a maneuver with its reserve (`Maneuver.slew`).

        Args:
            maneuver: of this requirement. inertia: see there.
            begun: whether the trunk begins with the rate of the reserve: momentum that the wheels
                hold till the end, with the sense of what they hold anyway.
        """
        slew, kept = maneuver.slew(inertia, self.standing_height), self.reserve(maneuver)
        factor, momentum = kept.demand, slew.momentum
        if begun:
            factor = kept.begun
            momentum = momentum + np.copysign(inertia.diagonal * np.array(kept.rate), momentum)
        return replace(
            slew,
            swept=factor * slew.swept,
            momentum=factor * momentum,
            duration=slew.duration - (self.detection or 0.0),
        )
