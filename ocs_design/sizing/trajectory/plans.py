"""Reference turns that flights track: of least peak power, planned for the given device."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import inf, remainder
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.actuation.drive import PLANNED, DriveLine, power_less_friction
from ocs_design.common.quaternions import conjugate, from_axis_angle, product, scaled_vertical
from ocs_design.common.units import format_quantity, rpm
from ocs_design.requirement.boundary import Boundary, End
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.pivoted import HOLD_TIME_RATIO
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.trajectory.flight import Flight, fly
from ocs_design.sizing.trajectory.gyrostat import Gyrostat, takeover_factor
from ocs_design.sizing.trajectory.motion import HeadingLoop, Trajectory
from ocs_design.sizing.trajectory.program import Solution, solve
from ocs_design.sizing.trajectory.tracking import tracking_gains
from ocs_design.sizing.trajectory.transcription import Phase

if TYPE_CHECKING:
    from ocs_design.device.device import Device

INTERVALS = 24

GENTLE_SHARES = (0.8, 0.9)
"""Fractions of voltage, current and power that are tried first for a turn to an attitude: a heading
is corrected by tilting more, which takes more torque than holding the trunk level."""

HEADING_SHARE_MAX, EXTRA_DEMAND = 0.9, 1.1
"""Fraction of the drives that the plan of a heading may use, and least factor on the demand where
it uses more."""

TALL_SHARE_MAX = 0.65
"""The same fraction for a tall body that turns by a loop of the tilt. Residual momentum of a
push-off turns its heading more, by the ratio of its inertia about roll or pitch to that about
yaw."""

_TALL = 1.5
"""Ratio of the inertia about roll or pitch to that about yaw above which a body counts as tall:
quadrupeds have 0.4 to 1.0, humanoids 3 to 5."""

TIME_STEP, LONGEST = 0.05, 8.0
"""Precision of a time that is searched for, and the longest one, relative to the time given."""

BALANCE_STEP, _BALANCE_DELAY = 5e-3, 1e-9
"""Time step of the gains that hold a robot upright, and delay after the plan at which they start
[s]."""

_NO_HEADING = 1e-6
"""Change of heading that counts as zero [rad]."""

_TOO_MUCH_FOR_OTHERS = "if a drive fails early in the turn, the other wheels cannot follow it"

_UNFORESEEN = "a push is not known beforehand: no trajectory is planned, feedback holds the trunk"


@dataclass(frozen=True, eq=False)
class Planned(Flight):
    """A maneuver of least peak power, integrated from the start of the turn (the end of a push).

    Attributes:
        solution: of the program.
    """

    solution: Solution

    @property
    def failure(self) -> str:
        """Fault of the plan in a few words; empty if there is none."""
        solution = self.solution
        if solution.solved:
            return super().failure
        # Whether IPOPT gives up or proves infeasibility depends on the processor.
        status = solution.status.replace("_", " ").lower()
        return f"no solution within the limits in {solution.iterations} iterations, IPOPT: {status}"


@dataclass(frozen=True, eq=False)
class Reference:
    """A trajectory to track, or why there is none.

    Attributes:
        trajectory: its note equals `note`; None: the validation does without a reference.
        note: one sentence; empty if the trajectory leaves the feedback its reserve.
        time_needed: least time, relative to the time given, of a turn that cannot be made in it;
            None: it can, or no time would do.
        share: fraction of voltage, current and power that the trajectory keeps to; where a drive
            may stop, that to which the other drives are then held.
        share_max: fraction of the drives that a plan of a heading may use.
        tilt_fraction: fraction of the tilt from which a robot on a pivot could stand up, if not
            from all of it.
        braked_speed: speed of the fastest wheel that a brake stops at the start [rad/s]; 0: none
            does.
    """

    trajectory: Trajectory | None
    note: str
    time_needed: float | None = None
    share: float = 1.0
    share_max: float = HEADING_SHARE_MAX
    tilt_fraction: float | None = None
    braked_speed: float = 0.0

    def missing_demand(self, end: str) -> float | None:
        """Factor on the demand of the closed forms for a device that can do it; None: this one can.

        Momentum scales with the inverse of the time, torque with its inverse square. For a robot
        that falls over from most tilts, the factor is capped, as `tilt_fraction` then says little.
        `end`: of the turn, see `End`.
        """
        if self.trajectory is not None and (end == End.LEVEL or self.share <= self.share_max):
            return None
        if self.tilt_fraction is not None:
            return EXTRA_DEMAND / max(self.tilt_fraction, 0.5)
        if self.trajectory is not None:
            return max(EXTRA_DEMAND, self.share / self.share_max)
        return EXTRA_DEMAND if self.time_needed is None else EXTRA_DEMAND * self.time_needed**1.5


def plan(
    robot: MassProperties,
    device: "Device",
    maneuvers: Sequence[Maneuver],
    kept: Mapping[str, float] | None = None,
    *,
    one_stops: bool = False,
) -> Mapping[str, Reference]:
    """The turn of least peak power for each maneuver, by name; none is planned for a push.

    Args:
        robot: without the device, in B.
        device: with a real motor.
        maneuvers: each at its own incidence, if it has one.
        one_stops: see `reference`.
        kept: factor on the demand that the device keeps in reserve for a maneuver, by name; 1 if
            absent.
    """
    line, factors, references = drive_line_of(device), kept or {}, {}
    for maneuver in maneuvers:
        device_there = device.as_flown(maneuver)
        maneuver_there = maneuver.on(device_there.on(robot))
        gyrostat = gyrostat_of(robot, device_there, maneuver_there)
        factor = factors.get(maneuver.name, 1.0)
        references[maneuver.name] = reference(
            gyrostat, line, maneuver_there, factor, one_stops=one_stops
        )
    return references


def reference(
    gyrostat: Gyrostat,
    line: DriveLine,
    maneuver: Maneuver,
    kept: float = 1.0,
    *,
    one_stops: bool = False,
) -> Reference:
    """Least peak power within `PLANNED` of voltage, current and power, else with all of them.

    The device's reserve is left to the feedback: a plan of least power would use it up and run at
    top speed, which a robot with more inertia than designed could not follow. For the same reason,
    a plan that the other wheels must be able to take over leaves room for that: the torques of a
    plan for all wheels then grow by `takeover_factor`, and the device was sized for them.

    Args:
        gyrostat: robot and device, at the incidence of the maneuver.
        line: voltage line of the drives, without reserve.
        maneuver: of robot and device (`Maneuver.on`); an unforeseen one gets no reference, but a
            robot on a pivot gets the gains that balance it.
        kept: factor on the demand that the device keeps in reserve.
        one_stops: whether the other wheels must be able to follow it after any one drive has
            stopped.
    """
    if not maneuver.foreseen and not gyrostat.stands:
        return Reference(None, _UNFORESEEN)
    boundary = maneuver.boundary()
    if not maneuver.foreseen:
        return Reference(_with_balancing(gyrostat, line, boundary.duration), "")
    braked_speed = 0.0
    if gyrostat.stands and boundary.rate.any():
        # Wheel speeds that the brake must stop about the controlled axes, h A W = I w.
        controlled, momentum = gyrostat.controlled_axes, gyrostat.inertia @ boundary.rate
        absorbed = np.linalg.pinv(controlled @ gyrostat.axes) @ (controlled @ momentum)
        braked_speed = float(np.abs(absorbed / gyrostat.spin_inertia).max())
        top_speed = float(line.top_speed)
        if braked_speed > top_speed:
            note = (
                f"the brake would have to stop the wheels from {rpm(braked_speed)}, but the motors "
                f"reach only {rpm(top_speed)}"
            )
            return Reference(
                None, note, tilt_fraction=top_speed / braked_speed, braked_speed=braked_speed
            )
    # Wheels of two axes turn the heading by a loop of the tilt; tall bodies yaw more easily.
    x, y, z = np.diag(gyrostat.inertia)
    is_tall = not gyrostat.stands and gyrostat.axis_rank == 2 and max(x, y) > _TALL * z
    loops = boundary.end == End.ATTITUDE and is_tall
    share_max = TALL_SHARE_MAX if loops else HEADING_SHARE_MAX
    gentle = () if boundary.end == End.LEVEL else (TALL_SHARE_MAX, *GENTLE_SHARES)[not loops :]
    shares = tuple(dict.fromkeys((*gentle, PLANNED / kept, PLANNED, 1.0)))
    takeover = takeover_factor(gyrostat.axes) if one_stops else 1.0
    for share, divisor in [
        (fraction, factor) for factor in dict.fromkeys((takeover, 1.0)) for fraction in shares
    ]:
        usable = line.divided(divisor).reserved(share)
        planned = least_power_turn(boundary, gyrostat, usable, one_stops=divisor > 1.0)
        if not planned.failure:
            break
    else:
        return _unplanned(maneuver, boundary, gyrostat, line, planned)
    trajectory, note = planned.trajectory, ""
    if divisor != takeover:
        share, note = share * takeover, _TOO_MUCH_FOR_OTHERS
    elif share == 1.0:
        note = f"the turn takes more than {PLANNED:.1%} of voltage, current or power"
    if gyrostat.stands:
        trajectory = _with_balancing(gyrostat, line, boundary.duration, trajectory)
        if braked_speed:
            text = (
                f"the wheels are stopped from {rpm(braked_speed)} by brakes, which are neither "
                "designed nor included in the mass"
            )
            note = "; ".join(filter(None, (text, note)))
    elif boundary.end != End.LEVEL:
        # The feedback that holds the trunk level does not correct the heading.
        trajectory = replace(trajectory, gains=tracking_gains(gyrostat, line, trajectory, share))
    return Reference(
        replace(trajectory, note=note),
        note,
        share=share,
        share_max=share_max,
        braked_speed=braked_speed,
    )


def _unplanned(
    maneuver: Maneuver, boundary: Boundary, gyrostat: Gyrostat, line: DriveLine, planned: Planned
) -> Reference:
    """Why there is no plan, and what would do; `planned` is the last one that failed."""
    if maneuver.estimated and not gyrostat.stands:
        time_ratio = least_time_ratio(boundary, gyrostat, line)
        text = f"not even in {LONGEST:g} times that"
        if time_ratio is not None:
            text = f"they need {time_ratio * boundary.duration:.3g} s"
        note = f"the wheels cannot make this turn in {boundary.duration:.3g} s: {text}"
        return Reference(None, note, time_ratio)
    if gyrostat.stands:
        # Largest fraction of the tilt from which it stands up in time, by bisection to 1/16.
        low, high = 0.0, 1.0
        for _ in range(4):
            tilt_fraction = 0.5 * (low + high)
            rate_ratio = np.sin(0.5 * tilt_fraction * boundary.angle) / np.sin(0.5 * boundary.angle)
            smaller_tilt = replace(
                boundary,
                attitude=product(
                    from_axis_angle(boundary.axis, -tilt_fraction * boundary.angle),
                    boundary.final_attitude,
                ),
                angle=tilt_fraction * boundary.angle,
                rate=rate_ratio * boundary.rate,
            )
            low, high = (
                (low, tilt_fraction)
                if least_power_turn(smaller_tilt, gyrostat, line).failure
                else (tilt_fraction, high)
            )
        tilt_fraction, tilt = low, abs(float(boundary.angle))
        full, reduced = (format_quantity(angle, "deg") for angle in (tilt, tilt_fraction * tilt))
        text = (
            f"from {reduced} they can"
            if tilt_fraction > 0.0
            else "not even from a sixteenth of that"
        )
        note = f"the wheels cannot stand it up from {full} in {boundary.duration:.3g} s: {text}"
        return Reference(None, note, tilt_fraction=tilt_fraction)
    return Reference(None, f"no optimal turn was found ({planned.failure})")


def _with_balancing(
    gyrostat: Gyrostat, line: DriveLine, duration: float, planned: Trajectory | None = None
) -> Trajectory:
    """Hold upright on a pivot after the plan, `HOLD_TIME_RATIO` times as long, wheels to rest."""
    wheels, start_time = gyrostat.axes.shape[1], 0.0 if planned is None else planned.time[-1]
    until = (1.0 + HOLD_TIME_RATIO) * duration
    # The plan applies until then.
    time = start_time + np.array([_BALANCE_DELAY, BALANCE_STEP])
    zeros, upright = np.zeros((len(time), 3)), np.tile(gyrostat.upright, (len(time), 1))
    at_rest = Trajectory(
        time=time,
        vertical=scaled_vertical(upright),
        rate=zeros,
        acceleration=zeros,
        wheel_speed=np.zeros((len(time), wheels)),
        wheel_torque=np.zeros((len(time), wheels)),
        note="",
        attitude=upright,
    )
    if planned is not None:
        rows = {
            field.name: np.concatenate([getattr(planned, field.name), getattr(at_rest, field.name)])
            for field in fields(Trajectory)
            if field.name not in {"note", "step_torque", "gains"}
        }
        at_rest = Trajectory(**rows, note="")
    gains = tracking_gains(gyrostat, line, at_rest)
    return replace(at_rest, gains=gains, time=np.append(at_rest.time[:-1], until))


def least_power_turn(
    boundary: Boundary,
    gyrostat: Gyrostat,
    line: DriveLine,
    intervals: int = INTERVALS,
    *,
    one_stops: bool = False,
) -> Planned:
    """The turn of least peak power, or of least effort without a power limit, and its check.

    It is the best from several initial guesses, as a change of heading has several optima. Nothing
    is required at the end about an axis that the wheels do not control. `one_stops`: see `Phase`.
    """
    # Wheels of one axis cannot command a heading; wheels of two change it by a loop of the tilt.
    if boundary.end == End.ATTITUDE and gyrostat.axis_rank == 1:
        boundary = replace(boundary, end=End.LEVEL)
    about_axis = Phase(boundary, gyrostat, one_stops=one_stops)
    start = about_axis.outline.attitude
    w, x, y, z = product(conjugate(start), boundary.final_attitude)
    heading = remainder(2.0 * np.arctan2(z, w), 2.0 * np.pi)
    guesses = [about_axis]
    loops = boundary.end == End.ATTITUDE and gyrostat.axis_rank < len(gyrostat.inertia)
    if loops and abs(heading) >= _NO_HEADING:
        # Try both ways round; the turn is a swing without heading, followed by a twist about z.
        w, x, y, z = product(
            np.array([w, x, y, z]), from_axis_angle(np.array([0.0, 0.0, 1.0]), -heading)
        )
        sine = np.hypot(x, y)
        swing = np.array([x, y, 0.0]) * (2.0 * np.arctan2(sine, w) / sine if sine > 0.0 else 0.0)
        guesses = [
            replace(about_axis, guess=loop.motion(gyrostat, intervals))
            for initial_direction in (0.0, np.pi)
            for loop in [HeadingLoop(start, swing, heading, initial_direction, boundary.duration)]
        ]
    candidates = []
    for turn in guesses:
        solution = solve([turn], line, (intervals,))
        flight = fly(turn, line, solution.motions[0])
        candidates.append(Planned(**vars(flight), solution=solution))
    best = min(candidates, key=lambda planned: (planned.failure != "", planned.solution.cost))
    per_axis = 0 if one_stops or np.ndim(boundary.wheel_speed) else _wheels_per_axis(gyrostat)
    if not best.failure or per_axis < 2:
        return best
    # Wheels of one axis share evenly, but the program may fail in what they can do against each
    # other: it is solved with one wheel for all of an axis.
    merged = replace(
        gyrostat,
        axes=gyrostat.axes[:, : gyrostat.axes.shape[1] // per_axis],
        spin_inertia=per_axis * gyrostat.spin_inertia,
        armature=per_axis * gyrostat.armature,
    )
    merged_line = replace(
        line,
        stall_torque=per_axis * line.stall_torque,
        torque_limit=per_axis * line.torque_limit,
        power_max=per_axis * line.power_max,
    )
    planned = least_power_turn(boundary, merged, merged_line, intervals)
    if planned.failure:
        return best
    trajectory, steps = planned.trajectory, planned.trajectory.step_torque
    split = replace(
        trajectory,
        wheel_speed=np.tile(trajectory.wheel_speed, per_axis),
        wheel_torque=np.tile(trajectory.wheel_torque, per_axis) / per_axis,
        step_torque=None if steps is None else np.tile(steps, per_axis) / per_axis,
    )
    return replace(planned, trajectory=split)


def _wheels_per_axis(gyrostat: Gyrostat) -> int:
    """Number of wheels on each axis, if the axes are those of equal groups one after the other."""
    axes = gyrostat.axes
    wheels = int(axes.shape[1])
    for axis_count in range(1, wheels):
        per_axis, rest = divmod(wheels, axis_count)
        if not rest and np.array_equal(np.tile(axes[:, :axis_count], per_axis), axes):
            return per_axis
    return 1


def least_time_ratio(boundary: Boundary, gyrostat: Gyrostat, line: DriveLine) -> float | None:
    """Least time of the turn, relative to the time given, to within `TIME_STEP`, by bisection.

    The time given is assumed too short. None: not even `LONGEST` times that is enough.
    """
    too_short, enough = 1.0, 1.0 + TIME_STEP

    def fails(factor: float) -> bool:
        longer = replace(boundary, duration=factor * boundary.duration)
        return least_power_turn(longer, gyrostat, line).failure != ""

    while fails(enough):
        too_short, enough = enough, 1.0 + 2.0 * (enough - 1.0)
        if enough > LONGEST:
            return None
    while enough > (1.0 + TIME_STEP) * too_short:
        middle = 0.5 * (too_short + enough)
        too_short, enough = (middle, enough) if fails(middle) else (too_short, middle)
    return enough


def gyrostat_of(
    robot: MassProperties, device: "Device", maneuver: Maneuver | None = None
) -> Gyrostat:
    """Robot and device as a rigid trunk with its wheels, about a pivot if the maneuver has one."""
    total, figures = device.on(robot), (device.axes, device.flywheel.spin_inertia)
    if maneuver is None:
        return Gyrostat(total.inertia, *figures, device.motor.armature)
    inertia, gravity_moment, edge = maneuver.freedom(total)
    return Gyrostat(inertia, *figures, device.motor.armature, gravity_moment, edge)


def drive_line_of(device: "Device") -> DriveLine:
    """Voltage line of each drive at its wheel, net of friction and without reserve."""
    motor, supply, wheels = device.motor, device.supply, len(device.modules)
    power = inf
    if supply is not None:
        limit, gain = motor.torque_limit, motor.torque_per_current
        peak = limit / gain if limit is not None and gain > 0.0 else inf
        left = power_less_friction(supply, wheels, motor, peak)
        power = motor.gear_efficiency * left / wheels
    return DriveLine(
        stall_torque=inf
        if motor.stall_torque is None
        else motor.friction_factor * motor.stall_torque,
        no_load_speed=motor.friction_factor * motor.no_load_speed,
        torque_limit=inf if motor.torque_limit is None else motor.torque_limit,
        speed_max=inf if motor.speed_max is None else motor.speed_max,
        power_max=power,
    )
