"""The turns that flights track: of least peak power, planned for the device at hand."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import inf, remainder
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.actuation.drive import PLANNED, DriveLine, power_less_friction
from ocs_design.common.quaternions import conjugate, from_axis_angle, product
from ocs_design.common.units import format_quantity, rpm
from ocs_design.requirement.maneuver import End, Maneuver, Unforeseen
from ocs_design.requirement.pivoted import Balance, Pivoted
from ocs_design.requirement.turns import TurnTo
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.place import with_device
from ocs_design.sizing.trajectory.boundary import (
    HELD_ON,
    Boundary,
    boundary,
    pivot_boundary,
    vertical_of,
)
from ocs_design.sizing.trajectory.flight import Flight, fly
from ocs_design.sizing.trajectory.gyrostat import Gyrostat, taken_over
from ocs_design.sizing.trajectory.motion import HeadingLoop, Trajectory
from ocs_design.sizing.trajectory.program import Solution, solve
from ocs_design.sizing.trajectory.tracking import tracking_gains
from ocs_design.sizing.trajectory.transcription import Turn

if TYPE_CHECKING:
    from ocs_design.device.device import Device

INTERVALS = 24

GENTLE = (0.8, 0.9)
"""Shares of voltage, current and power that a turn to an attitude is first tried with: a heading is
put right by tilting more, which takes more torque than holding the trunk level."""

LEAST_SPARE, SPARE = 0.9, 1.1
"""Share of the drives that the plan of a heading may take, and least factor where it takes more."""

TALL_SPARE = 0.65
"""The same share for a tall body that turns by a loop of the tilt. What is left of a push-off turns
its heading by so much more as it has more inertia about roll or pitch than about yaw."""

_TALL = 1.5
"""Inertia about roll or pitch over that about yaw, from which a body counts as tall: quadrupeds
have 0.4 to 1.0, humanoids 3 to 5."""

TIME_STEP, LONGEST = 0.05, 8.0
"""How closely a time is looked for, and how long at most, over the one asked for."""

BALANCE_STEP, _AT_ONCE = 5e-3, 1e-9
"""Step that the gains which hold a robot are for, and how soon they follow on a plan [s]."""

_SAME = 1e-6
"""Change of heading that is none [rad]."""

_TOO_MUCH_FOR_OTHERS = "the wheels left do not follow the turn if a drive stops early in it"

_UNFORESEEN = "a push is not known beforehand: no trajectory is planned, feedback holds the trunk"


@dataclass(frozen=True, eq=False)
class Planned(Flight):
    """A maneuver of least peak power, flown from the start of the turn, the end of a push.

    Attributes:
        solution: of the program.
    """

    solution: Solution

    @property
    def failure(self) -> str:
        """What is wrong with it, in a few words; empty if nothing is."""
        solution = self.solution
        if solution.solved:
            return super().failure
        # Whether it gives up or proves that there is none depends on the processor.
        status = solution.status.replace("_", " ").lower()
        return f"nothing within the limits in {solution.iterations} iterations, IPOPT: {status}"


@dataclass(frozen=True, eq=False)
class Reference:
    """A trajectory to track, or why there is none.

    Attributes:
        trajectory: its note says what `note` says; None: the validation makes do without.
        note: one sentence; empty if the trajectory leaves the feedback its reserve.
        needed: least time over the one asked for, of a turn that is not made in it; None: it is, or
            no time would do.
        share: of voltage, current and power that the trajectory keeps to; where a drive may stop,
            that it leaves the others to keep to.
        most: share that a plan of a heading may take of the drives.
        part: of the tilt from which a robot on a pivot would stand up, where it does not from all.
        spun: speed of the fastest wheel that a brake stops at the start [rad/s]; 0: none does.
    """

    trajectory: Trajectory | None
    note: str
    needed: float | None = None
    share: float = 1.0
    most: float = LEAST_SPARE
    part: float | None = None
    spun: float = 0.0

    def lacking(self, end: str) -> float | None:
        """Factor on what the closed forms ask for a device that makes it; None: this one does.

        Momentum goes with the inverse of the time, torque with its square. What falls over from
        most tilts tells little. `end`: of the turn, see `End`.
        """
        if self.trajectory is not None and (end == End.LEVEL or self.share <= self.most):
            return None
        if self.part is not None:
            return SPARE / max(self.part, 0.5)
        if self.trajectory is not None:
            return max(SPARE, self.share / self.most)
        return SPARE if self.needed is None else SPARE * self.needed**1.5


def plan(
    robot: MassProperties,
    device: "Device",
    maneuvers: Sequence[Maneuver],
    standing_height: float,
    kept: Mapping[str, float] | None = None,
    *,
    one_stops: bool = False,
) -> Mapping[str, Reference]:
    """The turn of least peak power for each maneuver by its name; none is planned for a push.

    Args:
        robot: without the device, in B.
        device: with a real motor.
        maneuvers: each at its own incidence, if it has one.
        standing_height: of the trunk over the ground [m].
        kept: factor on what is asked that the device keeps for a maneuver, by its name; 1 if none.
        one_stops: see `reference`.
    """
    line, factors, found = drive_line_of(device), kept or {}, {}
    for maneuver in maneuvers:
        flown = device.as_flown(maneuver)
        own = maneuver.on(with_device(robot, flown))
        gyrostat = gyrostat_of(robot, flown, own)
        kept_of = factors.get(maneuver.name, 1.0)
        found[maneuver.name] = reference(
            gyrostat, line, own, standing_height, kept_of, one_stops=one_stops
        )
    return found


def reference(
    gyrostat: Gyrostat,
    line: DriveLine,
    maneuver: Maneuver,
    standing_height: float,
    kept: float = 1.0,
    *,
    one_stops: bool = False,
) -> Reference:
    """Least peak power within `PLANNED` of voltage, current and power, else with all of them.

    What the device keeps in reserve is left to the feedback: a plan of least power would use it up
    and run at top speed, which a robot with more inertia than designed cannot follow. For the same
    reason a plan that others shall take over leaves them all of that: torques of a plan for all
    wheels grow by `taken_over`, and the device was sized for them.

    Args:
        gyrostat: robot and device, at the incidence of the maneuver.
        line: of the drives, nothing held back.
        maneuver: of robot and device (`Maneuver.on`); what nobody foresees gets no reference, but
            a robot on a pivot the gains that balance it.
        standing_height: of the trunk over the ground [m].
        kept: factor on what is asked that the device keeps.
        one_stops: whether the others shall follow it after any one drive has stopped.
    """
    if isinstance(maneuver, Unforeseen):
        return Reference(None, _UNFORESEEN)
    if isinstance(maneuver, Balance):
        return Reference(_balanced(gyrostat, line, maneuver), "")
    asked = (
        pivot_boundary(maneuver, gyrostat)
        if isinstance(maneuver, Pivoted)
        else boundary(maneuver, standing_height)
    )
    spun = 0.0
    if isinstance(maneuver, Pivoted) and asked.rate.any():
        # What the brake takes off the wheels about the axes that they reach, h A W = I w.
        reached, momentum = gyrostat.turns_about, gyrostat.inertia @ asked.rate
        taken = np.linalg.pinv(reached @ gyrostat.axes) @ (reached @ momentum)
        spun = float(np.abs(taken / gyrostat.spin_inertia).max())
        most = float(line.top_speed)
        if spun > most:
            note = (
                f"the brake would have to stop the wheels from {rpm(spun)}, and the motors reach "
                f"only {rpm(most)}"
            )
            return Reference(None, note, part=most / spun, spun=spun)
    # Two axes turn the heading by a loop of the tilt; a tall body yaws more easily than it tilts.
    x, y, z = np.diag(gyrostat.inertia)
    tall = not gyrostat.stands and gyrostat.spanned == 2 and max(x, y) > _TALL * z
    loops = asked.end == End.ATTITUDE and tall
    most = TALL_SPARE if loops else LEAST_SPARE
    first = () if asked.end == End.LEVEL else (TALL_SPARE, *GENTLE)[not loops :]
    shares = tuple(dict.fromkeys((*first, PLANNED / kept, PLANNED, 1.0)))
    grows = taken_over(gyrostat.axes) if one_stops else 1.0
    for share, left in [(own, each) for each in dict.fromkeys((grows, 1.0)) for own in shares]:
        own_line = line.divided(left).reserved(share)
        planned = gentlest(asked, gyrostat, own_line, one_stops=left > 1.0)
        if not planned.failure:
            break
    else:
        return _refused(maneuver, asked, gyrostat, line, planned)
    trajectory, note = planned.trajectory, ""
    if left != grows:
        share, note = share * grows, _TOO_MUCH_FOR_OTHERS
    elif share == 1.0:
        note = f"the turn takes more than {PLANNED:.1%} of voltage, current or power"
    if isinstance(maneuver, Pivoted):
        trajectory = _balanced(gyrostat, line, maneuver, trajectory)
        if spun:
            told = (
                f"the wheels are stopped from {rpm(spun)}, by brakes that are "
                "not designed and not in the mass"
            )
            note = "; ".join(filter(None, (told, note)))
    elif asked.end != End.LEVEL:
        # What holds the trunk level corrects no heading.
        trajectory = replace(trajectory, gains=tracking_gains(gyrostat, line, trajectory, share))
    return Reference(replace(trajectory, note=note), note, share=share, most=most, spun=spun)


def _refused(
    maneuver: Maneuver, asked: Boundary, gyrostat: Gyrostat, line: DriveLine, planned: Planned
) -> Reference:
    """Why there is no plan, with what would do; `planned` is the last that failed."""
    if isinstance(maneuver, TurnTo):
        needed = quickest(asked, gyrostat, line)
        told = f"nor in {LONGEST:g} times that"
        if needed is not None:
            told = f"they need {needed * asked.duration:.3g} s"
        note = f"the wheels do not make this turn in {asked.duration:.3g} s: {told}"
        return Reference(None, note, needed)
    if isinstance(maneuver, Pivoted):
        # Largest part of the tilt from which it stands up in the time, by bisection to 1/16.
        low, high = 0.0, 1.0
        for _ in range(4):
            part = 0.5 * (low + high)
            smaller = np.sin(0.5 * part * asked.angle) / np.sin(0.5 * asked.angle)
            tried = replace(
                asked,
                attitude=product(
                    from_axis_angle(asked.axis, -part * asked.angle), asked.final_attitude
                ),
                angle=part * asked.angle,
                rate=smaller * asked.rate,
            )
            low, high = (low, part) if gentlest(tried, gyrostat, line).failure else (part, high)
        part, tilt = low, abs(float(asked.angle))
        all_of_it, less = (format_quantity(each, "deg") for each in (tilt, part * tilt))
        told = f"from {less} they would" if part > 0.0 else "nor from a sixteenth of that"
        note = (
            f"the wheels do not make it stand up from {all_of_it} in {asked.duration:.3g} s: {told}"
        )
        return Reference(None, note, part=part)
    return Reference(None, f"no optimal turn was found ({planned.failure})")


def _balanced(
    gyrostat: Gyrostat, line: DriveLine, maneuver: Pivoted, planned: Trajectory | None = None
) -> Trajectory:
    """Upright on a pivot with the wheels to rest, after what is planned, `HELD_ON` as long."""
    wheels, begins = gyrostat.axes.shape[1], 0.0 if planned is None else planned.time[-1]
    until = (1.0 + HELD_ON) * maneuver.duration
    # Up to it the plan holds.
    time = begins + np.array([_AT_ONCE, BALANCE_STEP])
    none, upright = np.zeros((len(time), 3)), np.tile(gyrostat.upright, (len(time), 1))
    held = Trajectory(
        time=time,
        vertical=vertical_of(upright),
        rate=none,
        acceleration=none,
        wheel_speed=np.zeros((len(time), wheels)),
        wheel_torque=np.zeros((len(time), wheels)),
        note="",
        attitude=upright,
    )
    if planned is not None:
        rows = {
            each.name: np.concatenate([getattr(planned, each.name), getattr(held, each.name)])
            for each in fields(Trajectory)
            if each.name not in {"note", "step_torque", "gains"}
        }
        held = Trajectory(**rows, note="")
    gains = tracking_gains(gyrostat, line, held)
    return replace(held, gains=gains, time=np.append(held.time[:-1], until))


def gentlest(
    asked: Boundary,
    gyrostat: Gyrostat,
    line: DriveLine,
    intervals: int = INTERVALS,
    *,
    one_stops: bool = False,
) -> Planned:
    """The turn of least peak power, or of least effort where none is limited, flown once more.

    The best of those from several initial guesses, where a change of heading has several optima.
    Where the wheels do not reach an axis, nothing is asked about it at the end. `one_stops`: see
    `Turn`.
    """
    # Wheels of one axis command no heading, and wheels of two turn it by a loop of the tilt.
    if asked.end == End.ATTITUDE and gyrostat.spanned == 1:
        asked = replace(asked, end=End.LEVEL)
    about_axis = Turn(asked, gyrostat, one_stops=one_stops)
    start = about_axis.outline.attitude
    w, x, y, z = product(conjugate(start), asked.final_attitude)
    heading = remainder(2.0 * np.arctan2(z, w), 2.0 * np.pi)
    guesses = [about_axis]
    loops = asked.end == End.ATTITUDE and gyrostat.spanned < len(gyrostat.inertia)
    if loops and abs(heading) >= _SAME:
        # Either way round; the turn is a swing without heading, and then a twist about z.
        w, x, y, z = product(
            np.array([w, x, y, z]), from_axis_angle(np.array([0.0, 0.0, 1.0]), -heading)
        )
        sine = np.hypot(x, y)
        swing = np.array([x, y, 0.0]) * (2.0 * np.arctan2(sine, w) / sine if sine > 0.0 else 0.0)
        guesses = [
            replace(about_axis, guess=loop.motion(gyrostat, intervals))
            for begins in (0.0, np.pi)
            for loop in [HeadingLoop(start, swing, heading, begins, asked.duration)]
        ]
    found = []
    for turn in guesses:
        solution = solve([turn], line, (intervals,))
        flight = fly(turn, line, solution.motions[0])
        found.append(Planned(**vars(flight), solution=solution))
    return min(found, key=lambda planned: (planned.failure != "", planned.solution.cost))


def quickest(asked: Boundary, gyrostat: Gyrostat, line: DriveLine) -> float | None:
    """Least time of the turn over the one asked for, within `TIME_STEP`, by bisection.

    None: not in `LONGEST` times the time asked for, which is taken to be too short.
    """
    short, enough = 1.0, 1.0 + TIME_STEP

    def fails(factor: float) -> bool:
        lasting = replace(asked, duration=factor * asked.duration)
        return gentlest(lasting, gyrostat, line).failure != ""

    while fails(enough):
        short, enough = enough, 1.0 + 2.0 * (enough - 1.0)
        if enough > LONGEST:
            return None
    while enough > (1.0 + TIME_STEP) * short:
        middle = 0.5 * (short + enough)
        short, enough = (middle, enough) if fails(middle) else (short, middle)
    return enough


def gyrostat_of(
    robot: MassProperties, device: "Device", maneuver: Maneuver | None = None
) -> Gyrostat:
    """Robot and device as a rigid trunk with its wheels, about a pivot if the maneuver has one."""
    whole, figures = with_device(robot, device), (device.axes, device.flywheel.spin_inertia)
    if isinstance(maneuver, Pivoted):
        own = maneuver.on(whole)
        return Gyrostat(own.inertia, *figures, device.motor.armature, own.pull, own.axis)
    return Gyrostat(whole.inertia, *figures, device.motor.armature)


def drive_line_of(device: "Device") -> DriveLine:
    """What each drive does at its wheel beside its friction, nothing held back."""
    motor, supply, wheels = device.motor, device.supply, len(device.modules)
    power = inf
    if supply is not None:
        limit, gain = motor.torque_limit, motor.torque_per_current
        peak = limit / gain if limit is not None and gain > 0.0 else inf
        left = power_less_friction(supply, wheels, motor, peak)
        power = motor.gear_efficiency * left / wheels
    return DriveLine(
        stall_torque=inf if motor.stall_torque is None else motor.line_left * motor.stall_torque,
        no_load_speed=motor.line_left * motor.no_load_speed,
        torque_limit=inf if motor.torque_limit is None else motor.torque_limit,
        speed_max=inf if motor.speed_max is None else motor.speed_max,
        power_max=power,
    )
