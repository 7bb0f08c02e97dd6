"""The turns that flights track: of least peak power, planned for the device at hand."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.actuation.drive import PLANNED, DriveLine, power_less_friction
from ocs_design.parts.moments import Carrier
from ocs_design.requirement.maneuver import Maneuver, Unforeseen
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.selection.device import braked
from ocs_design.sizing.trajectory.boundary import boundary
from ocs_design.sizing.trajectory.flight import FineGrid, Trajectory, fly
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.program import Solution, Turn, solve

if TYPE_CHECKING:
    from ocs_design.device.device import Device

INTERVALS = 24

_UNFORESEEN = "a push is not known beforehand: no trajectory is planned, feedback holds the trunk"


@dataclass(frozen=True, eq=False)
class Planned:
    """A maneuver of least peak power.

    Attributes:
        solution: of the program. fine: its errors on a finer grid.
        trajectory: from the start of the turn, which is the end of a push.
    """

    solution: Solution
    fine: FineGrid
    trajectory: Trajectory

    @property
    def failure(self) -> str:
        """What is wrong with it, in a few words; empty if nothing is."""
        solution = self.solution
        return self.fine.failure if solution.solved else f"IPOPT: {solution.status}"


@dataclass(frozen=True, eq=False)
class Reference:
    """A trajectory to track, or why there is none.

    Attributes:
        trajectory: its note says what `note` says; None: the validation makes do without.
        note: one sentence; empty if the trajectory leaves the feedback its reserve.
        planned: the trajectory's program, or the last one that failed; None: not tried.
    """

    trajectory: Trajectory | None
    note: str
    planned: Planned | None


def plan(
    robot: MassProperties,
    device: "Device",
    maneuvers: Sequence[Maneuver],
    standing_height: float,
    kept: Mapping[str, float] | None = None,
) -> Mapping[str, Reference]:
    """The turn of least peak power for each maneuver by its name; none is planned for a push.

    Args:
        robot: without the device, in B.
        device: with a real motor.
        maneuvers: each at its own incidence, if it has one.
        standing_height: of the trunk over the ground [m].
        kept: factor on what is asked that the device keeps for a maneuver, by its name; 1 if none.
    """
    line, factors = drive_line_of(device), kept or {}
    return {
        maneuver.name: reference(
            gyrostat_of(robot, device.as_flown(maneuver)),
            line,
            maneuver,
            standing_height,
            factors.get(maneuver.name, 1.0),
        )
        for maneuver in maneuvers
    }


def reference(
    gyrostat: Gyrostat,
    line: DriveLine,
    maneuver: Maneuver,
    standing_height: float,
    kept: float = 1.0,
) -> Reference:
    """Least peak power within `PLANNED` of voltage, current and power, else with all of them.

    What the device keeps in reserve is left to the feedback: a plan of least power would use it up
    and run at top speed, which a robot with more inertia than designed cannot follow.

    Args:
        gyrostat: robot and device, at the incidence of the maneuver.
        line: of the drives, nothing held back.
        maneuver: what nobody foresees gets no reference, because it comes unforeseen.
        standing_height: of the trunk over the ground [m].
        kept: factor on what is asked that the device keeps.
    """
    if isinstance(maneuver, Unforeseen):
        return Reference(None, _UNFORESEEN, None)
    turn = Turn(boundary(maneuver, standing_height), gyrostat)
    for share in dict.fromkeys((PLANNED / kept, PLANNED)):
        planned = gentlest(turn, line.reserved(share))
        if not planned.failure:
            return Reference(planned.trajectory, "", planned)
    planned = gentlest(turn, line)
    if planned.failure:
        return Reference(None, f"no optimal turn was found ({planned.failure})", planned)
    note = f"the turn takes more than {PLANNED:.1%} of voltage, current or power"
    return Reference(replace(planned.trajectory, note=note), note, planned)


def gentlest(turn: Turn, line: DriveLine, intervals: int = INTERVALS) -> Planned:
    """The turn of least peak power, or of least effort where none is limited, flown once more.

    Where the wheels do not reach an axis, nothing is asked about it at the end.
    """
    solution = solve([turn], line, (intervals,))
    flight = fly(turn.gyrostat, line, turn.asked, turn.outline, solution.motions[0])
    return Planned(solution, flight.fine, flight.trajectory)


def gyrostat_of(robot: MassProperties, device: "Device") -> Gyrostat:
    """Robot and device as a rigid trunk with its wheels."""
    wheel = device.flywheel
    rim = Carrier(
        wheel.mass,
        wheel.spin_inertia - device.motor.rotor_inertia,
        wheel.transverse_inertia,
    )
    centers = np.stack([module.position for module in device.modules])
    whole = braked(device.plated(robot), (rim, device.carrier), centers, device.incidence)
    return Gyrostat(whole.inertia, device.axes, wheel.spin_inertia, device.motor.armature)


def drive_line_of(device: "Device") -> DriveLine:
    """What each drive does at its wheel, nothing held back."""
    motor, supply, wheels = device.motor, device.supply, len(device.modules)
    power, k_t = inf, motor.torque_constant
    if supply is not None:
        limit = motor.torque_limit
        gain = motor.gear_ratio * motor.gear_efficiency * (k_t or 0.0)
        peak = limit / gain if limit is not None and gain > 0.0 else inf
        left = power_less_friction(supply, wheels, motor, peak)
        power = motor.gear_efficiency * left / wheels
    return DriveLine(
        stall_torque=inf if motor.stall_torque is None else motor.stall_torque,
        no_load_speed=motor.no_load_speed,
        torque_limit=inf if motor.torque_limit is None else motor.torque_limit,
        speed_max=inf if motor.speed_max is None else motor.speed_max,
        power_max=power,
    )
