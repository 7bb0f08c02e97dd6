"""The lightest device that meets the requirement, at the best or a specified incidence.

A solved candidate becomes a whole device, with its figures.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import pi

import numpy as np

from ocs_design.actuation.slew import slew_profile
from ocs_design.actuation.spin_root import capability
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import WheelTask, smallest_spin_inertia, spin_demand
from ocs_design.device.layout import Criterion, incidence_by_criterion
from ocs_design.device.records.selection import TaskDemand
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.bound.device_sizing import design_momenta
from ocs_design.sizing.lightest_module import binding_limits
from ocs_design.sizing.selection.bounds import incidence_intervals
from ocs_design.sizing.selection.candidates import Candidates, Guess, drives_of
from ocs_design.sizing.selection.demand import rate_demands, roll_cancelling_momentum, wheel_task
from ocs_design.sizing.selection.fixed_point import FINE, Design, Solved, fixed_point
from ocs_design.sizing.selection.problem import (
    Candidate,
    Reason,
    Rejection,
    Selection,
    SelectionProblem,
    devices_by_mass,
    inertia_at,
    of_parts,
)
from ocs_design.sizing.selection.refinement import refine
from ocs_design.sizing.selection.rejections import Refused, rejections
from ocs_design.sizing.selection.search import SearchState, search

_CONVERGED = 1e-7
"""Error of an incidence [rad] at which the mass is accurate to nine digits."""
_ITERATIONS_MAX = 50
_WINNERS_MAX = 8
_NEARLY_EQUAL = 1e-4
"""Relative difference of masses that an incidence not quite converged may cause."""

_ROUNDING = 1e-6
"""Relative shortfall that counts as rounding for a device sized exactly for the demand."""


def select(problem: SelectionProblem) -> Selection:
    """The lightest devices, including those of the best motors, and why the others are rejected.

    No device of these motors, gears and materials that does every maneuver in time is lighter by
    0.1 %, at any incidence, with any rim within the envelope (docs/theory.md, The selection).

    Raises:
        Refused: no motor can do it; says what is missing.
        UsageError: there is nothing to choose from or nothing to do, or a limit is invalid.
    """
    state = _search(problem, refined=True)
    return Selection(
        ranking=tuple(map(device_of, state.devices)),
        candidates=int(state.known.sum())
        * len(problem.materials)
        * len(incidence_intervals(problem.incidence)),
        reasons=partial(rejections, state, {rank.motor for rank in state.ranking}),
    )


def _search(problem: SelectionProblem, *, refined: bool) -> SearchState:
    """The search with at least one device found (`select`); unrefined, only the lightest."""
    problem.check()
    state = search(problem, ranked=refined)
    if refined:
        state.refine(refine)
    if not state.ranking:
        raise Refused(problem, rejections(state, ()))
    return state


def select_by(
    problem: SelectionProblem,
    criterion: Criterion | None,
    winner: Candidate | None = None,
) -> Selection:
    """The lightest devices at the incidence that a criterion sets.

    The criterion applies to robot and device together, so the incidence is solved for one device at
    a time: for the lightest, then the selection is repeated at that incidence until the same device
    wins. Where none wins at its own incidence, the previous winners are compared, each at its own,
    and the lightest is first; devices that would be lighter at its incidence are not at their own,
    and are rejected. Where no winner is feasible at its own incidence, the last selection is
    returned.

    Args:
        problem: an incidence given there takes precedence.
        criterion: None: the incidence that makes the device lightest.
        winner: device of this problem that is likely to win; None: the lightest at the incidence
            for the robot alone.

    Raises:
        Refused, UsageError: see `select`.
    """
    if problem.incidence is not None or criterion is None:
        return select(problem)
    if winner is None:
        # Only its winner is used, and refining it would not correct its incidence.
        state = _search(_at_incidence_of_robot(problem, criterion), refined=False)
        winner = device_of(state.devices[0])
    winners: list[Candidate] = []
    own: list[Candidate] = []
    while not any(same_parts(winner, earlier) for earlier in winners):
        angle, settled = at_own_incidence(problem, winner, criterion)
        selection = select(replace(problem, incidence=angle))
        if same_parts(selection.best, winner):
            _, exact = at_own_incidence(problem, selection.best, criterion)
            if exact is None:
                return selection
            # Devices that are about as light are compared at exactly this incidence.
            mass_max, others = exact.mass * (1.0 + _NEARLY_EQUAL), selection.ranking[1:]
            comparable = [entry for entry in others if entry.mass < mass_max]
            turned = devices_at(problem, comparable, exact.incidence) if comparable else ()
            at_exact_angle = [
                device or entry for device, entry in zip(turned, comparable, strict=True)
            ]
            ranking = (*devices_by_mass((exact, *at_exact_angle)), *others[len(comparable) :])
            return replace(selection, ranking=ranking)
        winners.append(winner)
        own += [] if settled is None else [settled]
        if len(winners) == _WINNERS_MAX:
            break
        winner = selection.best
    if not own:
        return selection
    lightest = devices_by_mass(own)[0]
    at_its_incidence = select(replace(problem, incidence=lightest.incidence))
    # It is first; motors that are lighter at this incidence, which is not their own, are rejected.
    heavier = [entry for entry in at_its_incidence.ranking if entry.mass > lightest.mass]
    ranking = (lightest, *(entry for entry in heavier if not same_parts(entry, lightest)))
    listed = {entry.motor.name for entry in ranking}
    lighter = {entry.motor.name: entry.mass for entry in reversed(at_its_incidence.ranking)}
    only_lighter_here = [
        Rejection(
            name, Reason.INCIDENCE, f"{1e3 * mass:.0f} g, only at another device's incidence", 0.0
        )
        for name, mass in lighter.items()
        if name not in listed
    ]
    other_rejections = [
        rejection for rejection in at_its_incidence.rejections if rejection.motor not in listed
    ]
    return replace(
        at_its_incidence,
        ranking=ranking,
        reasons=partial(tuple, (*only_lighter_here, *other_rejections)),
    )


def lightest_by(
    problem: SelectionProblem, criterion: Criterion | None
) -> tuple[Candidate | None, Candidate | None]:
    """The lightest device alone, unrefined; None: the full selection must decide.

    The second is that of the same parts at the incidence for the robot alone (`select_by`).
    """
    problem.check()
    is_specified = problem.incidence is not None
    at_angle = (
        problem if is_specified or criterion is None else _at_incidence_of_robot(problem, criterion)
    )
    state = search(at_angle, ranked=False)
    if not state.ranking:
        return None, None
    device = device_of(state.devices[0])
    if is_specified or criterion is None:
        return device, device
    return at_own_incidence(problem, device, criterion)[1], device


def lightest_below(problem: SelectionProblem, mass_max: float) -> Candidate | None:
    """The lightest device, if it is lighter than this [kg]."""
    state = search(problem, mass_max, ranked=False)
    if not state.ranking:
        return None
    solved = state.devices[0]
    if problem.incidence is None:
        # With free incidence, a search is up to 3 % too heavy.
        point = refine(solved.candidates, solved.point)
        refined = replace(solved, point=point)
        solved = refined if refined.mass[0] < solved.mass[0] else solved
    return device_of(solved) if solved.mass[0] < mass_max else None


def _at_incidence_of_robot(problem: SelectionProblem, criterion: Criterion) -> SelectionProblem:
    """The problem at the incidence that the criterion sets for the robot alone."""
    return replace(problem, incidence=incidence_by_criterion(problem.robot.inertia)[criterion])


def at_own_incidence(
    problem: SelectionProblem, winner: Candidate, criterion: Criterion
) -> tuple[float, Candidate | None]:
    """The incidence [rad] that the criterion sets for the device of these parts, and that device.

    It keeps its radius, which hardly depends on the incidence, as far as possible. Where these
    parts become infeasible on the way, the result is the first such incidence and None.
    """
    device, angle, previous = winner, winner.incidence, None
    for _ in range(_ITERATIONS_MAX):
        momenta = design_momenta(problem.requirement, device.total.inertia)
        change = incidence_by_criterion(device.total.inertia, momenta)[criterion] - angle
        if abs(change) < _CONVERGED:
            break
        slope = 0.0 if previous is None else (change - previous[1]) / (angle - previous[0])
        previous = angle, change
        # The device's inertia hardly changes with the incidence: the slope is about -1.
        angle -= change / (slope if -2.0 < slope < -0.5 else -1.0)
        # Start from its own radius each time: a radius changed at one incidence would not return.
        start = replace(winner, spin_inertia=device.spin_inertia)
        turned = device_at(problem, start, min(max(angle, 0.0), pi / 2.0))
        if turned is None:
            # Infeasible with these parts; the full selection decides about others.
            return angle, None
        device = turned
    return angle, device


def lightest_near(
    problem: SelectionProblem, device: Candidate, criterion: Criterion | None
) -> Candidate | None:
    """The lightest device of the same parts for another problem, at its own incidence.

    None: there is none near it. The criterion is that of `select_by`.
    """
    incidence_is_free = problem.incidence is None and criterion is None
    solved = _solved_at(problem, [device], None if incidence_is_free else device.incidence)
    refined = replace(solved, point=refine(solved.candidates, solved.point))
    lightest = refined if refined.mass[0] < solved.mass[0] else solved
    if not lightest.point.feasible[0]:
        return None
    lightest_device = device_of(lightest)
    if problem.incidence is not None or criterion is None:
        return lightest_device
    return at_own_incidence(problem, lightest_device, criterion)[1] or lightest_device


def device_at(problem: SelectionProblem, device: Candidate, incidence: float) -> Candidate | None:
    """The device of the same parts and radius for another problem, at an incidence [rad].

    None: there is none near it.
    """
    (resized,) = devices_at(problem, [device], incidence)
    return resized


def devices_at(
    problem: SelectionProblem, devices: Sequence[Candidate], incidence: float
) -> Iterator[Candidate | None]:
    """Each of these devices for another problem; see `device_at`."""
    solved = _solved_at(problem, devices, incidence)
    for row in range(len(devices)):
        entry = solved.take(np.array([row]))
        if not entry.point.feasible[0]:
            # Fixed-point iteration diverges for marginal devices; the nonlinear programme does not.
            entry = replace(entry, point=refine(entry.candidates, entry.point))
        yield device_of(entry) if entry.point.feasible[0] else None


def _solved_at(
    problem: SelectionProblem, devices: Sequence[Candidate], incidence: float | None
) -> Solved:
    """Each of these devices for another problem, with the same radius; None: the incidence too."""
    problem = replace(of_parts(problem, *devices), incidence=incidence)
    rows = np.arange(len(devices))
    drives = drives_of(problem, np.stack([rows, rows], axis=1), rows)
    candidates, nothing = Candidates(problem, drives, rows), np.zeros(rows.size)
    angles = [device.incidence if incidence is None else incidence for device in devices]
    radius, angle = np.array([device.outer_radius for device in devices]), np.array(angles)
    start = np.array([device.spin_inertia for device in devices])
    point = fixed_point(candidates, start, Design(radius, angle, nothing), FINE)
    return Solved(candidates, Guess(start, nothing, angle, nothing), point)


def same_parts(first: Candidate, second: Candidate) -> bool:
    """Whether motor, gear and material are the same."""
    return (first.motor, first.gear, first.material) == (second.motor, second.gear, second.material)


def device_of(solved: Solved) -> Candidate:
    """The device of a single solved candidate, without its demands."""
    candidates, shapes = solved.candidates, solved.point.shapes
    problem, drives = candidates.problem, candidates.drives
    motor, gear = problem.motors[drives.motor[0]], problem.gears[drives.gear[0]]
    material = problem.materials[candidates.material[0]]
    limits, shape = candidates.limits.take(0), shapes.take(0)
    return Candidate(
        inner_radius=float(shape.inner_radius),
        outer_radius=float(shape.outer_radius),
        height=float(shape.height),
        material=material,
        motor=motor,
        gear=gear,
        line=drives.full_line.take(0),
        supply=problem.supply,
        hub=problem.hub(motor, gear, problem.lightenings[drives.web[0]]),
        cuts=limits.cuts,
        web_material=problem.web_material,
        incidence=float(solved.point.angle[0]),
        spin_inertia=float(solved.point.spin_inertia[0]),
        limits=limits,
        problem=problem,
        binding=binding_limits(shape, limits, problem.envelope),
        residual=float(solved.point.residual[0]),
        iterations=int(solved.point.iterations[0]),
    )


def with_demands(problem: SelectionProblem, device: Candidate) -> Candidate:
    """The device with the demands of each part of the requirement, which take time to compute.

    Each demand uses the inertia at its own incidence.
    """
    demands: list[TaskDemand] = []
    requirement, line, spin = problem.requirement, device.line.reserved(), device.spin_inertia
    top_speed = float(line.top_speed)
    for maneuver in requirement.maneuvers:
        incidence = device.incidence if maneuver.incidence is None else maneuver.incidence
        inertia = inertia_at(problem, device, incidence)
        task = _task_of(maneuver, requirement, device, inertia, incidence)
        least_inertia = smallest_spin_inertia(task, line, device.drive.armature).item()
        roll, yaw_inertia = requirement.reserve(maneuver).roll, device.total.inertia[2, 2]
        momentum = roll_cancelling_momentum(
            roll, inertia, yaw_inertia, device.layout.axes(incidence), requirement
        )
        least_inertia = max(least_inertia, float(momentum) / top_speed)
        load = task.load()
        reduced = load.reduced_inertia(spin, device.drive.armature)
        shifted_line, initial_speed = load.from_initial_speed(line)
        profile = slew_profile(
            load.angle(spin), reduced, shifted_line, load.final_speed(spin), initial_speed
        )
        peak_speed = profile.peak_speed + load.initial_speed - initial_speed
        demand = TaskDemand(
            source=maneuver.name,
            incidence=incidence,
            spin_inertia=least_inertia,
            time_needed=profile.end.item(),
            time_given=np.asarray(task.duration).item(),
            peak_speed=max(abs(load.initial_speed.item()), peak_speed.item()),
            peak_torque=profile.peak_torque.item(),
        )
        demands.append(demand)
    demands += rate_demands(requirement, device, inertia_at(problem, device, device.incidence))
    return replace(device, demands=tuple(demands))


def _task_of(
    maneuver: Maneuver,
    requirement: Requirement,
    device: Candidate,
    inertia: TiltInertia,
    angle: float,
) -> WheelTask:
    """Task of the device's wheels in a maneuver, at an angle of the layout [rad]."""
    axes = device.layout.axes(np.array([[angle]]))
    return wheel_task([maneuver], requirement, inertia, device.total.inertia[2:, 2], axes)


def maneuvers_survived(
    problem: SelectionProblem, device: Candidate, detection: float
) -> tuple[str, ...]:
    """Names of the maneuvers that the device does with any one wheel missing, by closed form.

    Conservatively, that wheel is assumed missing from the start, and the others to respond only
    after `detection` [s].
    """
    requirement, names = replace(problem.requirement, detection=detection, reserves={}), []
    for maneuver in requirement.maneuvers:
        incidence = device.incidence if maneuver.incidence is None else maneuver.incidence
        task = _task_of(
            maneuver, requirement, device, inertia_at(problem, device, incidence), incidence
        )
        demand = spin_demand(task, device.line.reserved(), device.drive.armature)
        with np.errstate(invalid="ignore"):
            capacity = capability(demand, np.asarray(device.spin_inertia)).sweep
        if (capacity >= demand.sweep * (1.0 - _ROUNDING)).all():
            names.append(maneuver.name)
    return tuple(names)
