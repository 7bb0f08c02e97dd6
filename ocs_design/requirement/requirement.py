"""Requirement on the flywheels: maneuvers, rate change, and the reserve for each maneuver."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.requirement.maneuver import Maneuver, Slew
from ocs_design.robot.mass import MassProperties


@dataclass(frozen=True)
class ManeuverReserve:
    """Reserve of a device for a maneuver that deviates from the design.

    Attributes:
        demand: factor on the demand on the wheels, at least 1.
        rate: initial roll and pitch rates of the trunk to allow for [rad/s].
        demand_with_rate: factor on the demand that includes this rate; below 1 where the margin is
            ample.
        roll: roll rate at lift-off that a flip must cancel [rad/s], see `roll_momentum_per_rate`.
        short: whether a device without this reserve falls short of it.
    """

    demand: float = 1.0
    rate: tuple[float, float] = (0.0, 0.0)
    demand_with_rate: float = 1.0
    roll: float = 0.0
    short: bool = False


_NO_RESERVE = ManeuverReserve()


@dataclass(frozen=True, eq=False)
class Requirement:
    """What the flywheels must be able to do.

    Attributes:
        maneuvers: see `Maneuver`; may be empty.
        rate_change: of the trunk about roll and pitch, one at a time [rad/s]; None: not required.
        wheel_speed_max: of a wheel relative to the trunk [rad/s].
        spin_inertia: required of one wheel, in place of all else [kg m^2]; None: to be found.
        reserves: reserve of each maneuver, by name; maneuvers that are not listed have none.
        incidence_is_free: whether the incidence is still to be chosen.
        detection: time until a failed drive is detected [s], where the wheels must do everything
            with any one of them failed; None: no drive fails.
    """

    maneuvers: tuple[Maneuver, ...]
    rate_change: float | None
    wheel_speed_max: float
    spin_inertia: float | None
    reserves: Mapping[str, ManeuverReserve] = field(default_factory=dict)
    incidence_is_free: bool = False
    detection: float | None = None

    def changed(self, change: Callable[[Maneuver], Maneuver]) -> "Requirement":
        """Requirement with `change` applied to each maneuver."""
        return replace(self, maneuvers=tuple(map(change, self.maneuvers)))

    def on(self, body: MassProperties) -> "Requirement":
        """Requirement for a body, on which kicks and pivots depend (`Maneuver.on`)."""
        return self.changed(lambda maneuver: maneuver.on(body))

    @property
    def kicks(self) -> FloatArray:
        """Momenta about roll and pitch that depend on the body [N m s], shape (n, 2).

        They are the angular impulses of forces, and the wheels' momenta about a pivot.
        """
        momenta = (maneuver.momentum_of_body for maneuver in self.maneuvers)
        return np.reshape([momentum for momentum in momenta if momentum is not None], (-1, 2))

    def reserve(self, maneuver: Maneuver) -> ManeuverReserve:
        """Reserve for a maneuver; a neutral one if there is none."""
        return self.reserves.get(maneuver.name, _NO_RESERVE)

    def slew(self, maneuver: Maneuver, inertia: TiltInertia, *, with_rate: bool = False) -> Slew:
        """Slew that the motors must make for a maneuver, with its reserve (`Maneuver.slew`).

        Args:
            maneuver: of this requirement. inertia: see there.
            with_rate: whether the trunk starts at the reserve's rate, whose momentum the wheels
                hold to the end, in the direction of the momentum they hold anyway.
        """
        slew, reserve = maneuver.slew(inertia), self.reserve(maneuver)
        factor, momentum = reserve.demand, slew.momentum
        if with_rate:
            factor = reserve.demand_with_rate
            momentum = momentum + np.copysign(inertia.diagonal * np.array(reserve.rate), momentum)
        return replace(
            slew,
            swept=factor * slew.swept,
            momentum=factor * momentum,
            duration=slew.duration - (self.detection or 0.0),
        )
