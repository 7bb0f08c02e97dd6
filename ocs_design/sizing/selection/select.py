"""The lightest device that does everything that is required, at the best or a stated incidence."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import pi

import numpy as np

from ocs_design.device.layout import Criterion, incidence_by_criterion
from ocs_design.sizing.bound.device_problem import design_momenta
from ocs_design.sizing.selection.bounds import cells_of
from ocs_design.sizing.selection.candidates import Candidates, Guess, drives_of
from ocs_design.sizing.selection.device import device_of
from ocs_design.sizing.selection.fixed_point import FINE, Design, Solved, fixed_point
from ocs_design.sizing.selection.problem import (
    Candidate,
    Reason,
    Rejection,
    Selection,
    SelectionProblem,
    devices_by_mass,
    of_parts,
)
from ocs_design.sizing.selection.refinement import refine
from ocs_design.sizing.selection.rejections import Refused, rejections
from ocs_design.sizing.selection.search import Found, search

_CONVERGED = 1e-7
"""Error of an incidence [rad], with which a mass is right to nine digits."""
_ITERATIONS_MAX = 50
_WINNERS_MAX = 8
_ABOUT = 1e-4
"""Relative difference of masses that an incidence which is about right may make."""


def select(problem: SelectionProblem) -> Selection:
    """The lightest devices, those of the best motors among them, and why the others are rejected.

    No device of these motors, gears and materials that does every maneuver in time is lighter by
    0.1 %, at any incidence, with any rim within the envelope (docs/theory.md, The selection).

    Raises:
        Refused: no motor can do it; says what is missing.
        UsageError: there is nothing to choose from or nothing to do, or a limit is no limit.
    """
    found = _found(problem, refined=True)
    return Selection(
        ranking=tuple(map(device_of, found.devices)),
        candidates=int(found.known.sum())
        * len(problem.materials)
        * len(cells_of(problem.incidence)),
        reasons=partial(rejections, found, {rank.motor for rank in found.places}),
    )


def _found(problem: SelectionProblem, *, refined: bool) -> Found:
    """Devices that a search finds, at least one (`select`); not refined, the lightest alone."""
    problem.check()
    found = search(problem, ranks=refined)
    if refined:
        found.refine(refine)
    if not found.places:
        raise Refused(problem, rejections(found, ()))
    return found


def select_by(
    problem: SelectionProblem,
    criterion: Criterion | None,
    winner: Candidate | None = None,
) -> Selection:
    """The lightest devices at the incidence that a criterion sets.

    The criterion looks at robot and device together, so that the incidence is solved for one
    device at a time: for the lightest, then the selection is made anew at that incidence until the
    same device wins. Where none wins at its own incidence, the lightest of those that won at
    another's leads, each at its own; what would be lighter there is not at its own incidence, and
    has fallen out. Where none of them can be at its own, the last selection stands.

    Args:
        problem: its own incidence goes first.
        criterion: None: whatever makes the device lightest.
        winner: device of this problem that is likely to win; None: the lightest at the robot's own
            incidence.

    Raises:
        Refused, UsageError: see `select`.
    """
    if problem.incidence is not None or criterion is None:
        return select(problem)
    if winner is None:
        # Only its winner is of use, and a refined one would be at the wrong incidence too.
        found = _found(_at_robots(problem, criterion), refined=False)
        winner = device_of(found.devices[0])
    winners: list[Candidate] = []
    own: list[Candidate] = []
    while not any(same_parts(winner, earlier) for earlier in winners):
        angle, settled = at_own_incidence(problem, winner, criterion)
        selection = select(replace(problem, incidence=angle))
        if same_parts(selection.best, winner):
            _, exact = at_own_incidence(problem, selection.best, criterion)
            if exact is None:
                return selection
            # What is about as light is compared at exactly its incidence.
            about, others = exact.mass * (1.0 + _ABOUT), selection.ranking[1:]
            near = [entry for entry in others if entry.mass < about]
            turned = devices_at(problem, near, exact.incidence) if near else ()
            moved = [device or entry for device, entry in zip(turned, near, strict=True)]
            ranking = (*devices_by_mass((exact, *moved)), *others[len(near) :])
            return replace(selection, ranking=ranking)
        winners.append(winner)
        own += [] if settled is None else [settled]
        if len(winners) == _WINNERS_MAX:
            break
        winner = selection.best
    if not own:
        return selection
    lightest = devices_by_mass(own)[0]
    there = select(replace(problem, incidence=lightest.incidence))
    # It leads; motors that are lighter at this incidence, which is not their own, have fallen out.
    heavier = [entry for entry in there.ranking if entry.mass > lightest.mass]
    ranking = (lightest, *(entry for entry in heavier if not same_parts(entry, lightest)))
    listed = {entry.motor.name for entry in ranking}
    lighter = {entry.motor.name: entry.mass for entry in reversed(there.ranking)}
    fallen = [
        Rejection(name, Reason.INCIDENCE, f"{1e3 * mass:.0f} g, at another than its own", 0.0)
        for name, mass in lighter.items()
        if name not in listed
    ]
    rest = [rejection for rejection in there.rejections if rejection.motor not in listed]
    return replace(there, ranking=ranking, reasons=partial(tuple, (*fallen, *rest)))


def lightest_by(problem: SelectionProblem, criterion: Criterion | None) -> Candidate | None:
    """The lightest device alone, not refined; None: only the whole selection can tell."""
    problem.check()
    stated = problem.incidence is not None
    at = problem if stated or criterion is None else _at_robots(problem, criterion)
    found = search(at, ranks=False)
    if not found.places:
        return None
    device = device_of(found.devices[0])
    if stated or criterion is None:
        return device
    return at_own_incidence(problem, device, criterion)[1]


def lightest_below(problem: SelectionProblem, below: float) -> Candidate | None:
    """The lightest device, if there is one that is lighter than this [kg]."""
    found = search(problem, below, ranks=False)
    if not found.places:
        return None
    solved = found.devices[0]
    if problem.incidence is None:
        # There a search leaves up to 3 % of the mass.
        point = refine(solved.candidates, solved.point)
        better = replace(solved, point=point)
        solved = better if better.mass[0] < solved.mass[0] else solved
    return device_of(solved) if solved.mass[0] < below else None


def _at_robots(problem: SelectionProblem, criterion: Criterion) -> SelectionProblem:
    """The problem at the incidence that the criterion sets for the robot alone."""
    return replace(problem, incidence=incidence_by_criterion(problem.robot.inertia)[criterion])


def at_own_incidence(
    problem: SelectionProblem, winner: Candidate, criterion: Criterion
) -> tuple[float, Candidate | None]:
    """The incidence [rad] that the criterion sets for the device of these parts, and that device.

    It keeps its radius, which hardly depends on the incidence, as far as it can there. Where these
    parts make no device on the way there, the first incidence at which they do not, and None.
    """
    found, angle, last = winner, winner.incidence, None
    for _ in range(_ITERATIONS_MAX):
        momenta = design_momenta(problem.requirement, found.total.inertia)
        change = incidence_by_criterion(found.total.inertia, momenta)[criterion] - angle
        if abs(change) < _CONVERGED:
            break
        slope = 0.0 if last is None else (change - last[1]) / (angle - last[0])
        last = angle, change
        # The device's inertia hardly changes with the incidence: the slope is about -1.
        angle -= change / (slope if -2.0 < slope < -0.5 else -1.0)
        # From its own radius each time: one that is lost beyond that incidence would stay lost.
        turned = device_at(problem, winner, min(max(angle, 0.0), pi / 2.0))
        if turned is None:
            # Not of these parts, then: whether of others, the whole selection tells.
            return angle, None
        found = turned
    return angle, found


def lightest_near(
    problem: SelectionProblem, device: Candidate, criterion: Criterion | None
) -> Candidate | None:
    """The lightest device of the same parts for another problem, at its own incidence.

    None: there is none near it.

    Args:
        device: to begin with. criterion: see `select_by`.
    """
    free = problem.incidence is None and criterion is None
    solved = _solved_at(problem, [device], None if free else device.incidence)
    better = replace(solved, point=refine(solved.candidates, solved.point))
    lightest = better if better.mass[0] < solved.mass[0] else solved
    if not lightest.point.feasible[0]:
        return None
    found = device_of(lightest)
    if problem.incidence is not None or criterion is None:
        return found
    return at_own_incidence(problem, found, criterion)[1] or found


def device_at(problem: SelectionProblem, device: Candidate, incidence: float) -> Candidate | None:
    """The device of the same parts and radius for another problem, at an incidence [rad].

    None: there is none near it.
    """
    (found,) = devices_at(problem, [device], incidence)
    return found


def devices_at(
    problem: SelectionProblem, devices: Sequence[Candidate], incidence: float
) -> Iterator[Candidate | None]:
    """Each of these devices for another problem; see `device_at`."""
    solved = _solved_at(problem, devices, incidence)
    for row in range(len(devices)):
        one = solved.take(np.array([row]))
        if not one.point.feasible[0]:
            # The iteration runs away where a device can only just carry itself; a programme not.
            one = replace(one, point=refine(one.candidates, one.point))
        yield device_of(one) if one.point.feasible[0] else None


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


def same_parts(one: Candidate, other: Candidate) -> bool:
    """Whether motor, gear and material are the same."""
    return (one.motor, one.gear, one.material) == (other.motor, other.gear, other.material)
