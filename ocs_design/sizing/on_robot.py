"""Selection of devices on the robot, each with its own plate, feet and guard rings.

Plate, feet and rings depend on the device that they carry or guard, and add to what it must turn:
both are found in turn until they converge.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

from ocs_design.common.errors import Infeasible
from ocs_design.common.units import format_quantity
from ocs_design.device.joints import burst_of
from ocs_design.device.layout import Criterion
from ocs_design.device.solids import foot_of, motor_mount
from ocs_design.parts.cage import floor_at_shock
from ocs_design.parts.foot import plate_thickness
from ocs_design.robot.robot import Robot
from ocs_design.sizing.assembly import assemble_selected
from ocs_design.sizing.footing.feet import Footing
from ocs_design.sizing.footing.standing import footing_under, stand_on_trunk
from ocs_design.sizing.reserve import Reality, Reserve
from ocs_design.sizing.selection.problem import (
    Candidate,
    Selection,
    SelectionProblem,
    devices_by_mass,
)
from ocs_design.sizing.selection.select import (
    at_own_incidence,
    device_at,
    lightest_by,
    lightest_near,
    same_parts,
    select_by,
)

_FOOTINGS_MAX, _RINGS_MAX, _RESERVES_MAX = 6, 16, 3

_SETTLED = 1e-3
"""Change of the plate's mass, relative to the device's, that counts as converged; the device's mass
then changes by a hundredth of it."""

_NEVER_SETTLES = 0.05
"""Change of that mass above which a device counts as mounted differently each time it is sized."""

_TOO_THICK = 0.2e-3
"""Excess thickness of feet that is tolerated [m]: 0.5 g each."""


class NeverHeld(Infeasible):
    """The mount would need a larger device, which no mount can hold.

    Its arguments are the device and the mass of the heaviest mount that would hold it [kg].
    """

    def __init__(self, best: Candidate, mass: float) -> None:
        held, device = (format_quantity(each, "kg", digits=3) for each in (mass, best.modules_mass))
        super().__init__(
            f"A device of {device} needs a mount of {held} on the trunk, but turning that mount "
            "too takes a larger device, which no mount can hold.",
            binding=["ocs.place"],
            largest_spin_inertia=best.spin_inertia,
            hint="Another incidence, more time or a higher voltage makes the device smaller.",
        )


def with_plate(candidate: Candidate, problem: SelectionProblem, robot: Robot) -> Candidate:
    """A selected device with its plate or pedestals, where it needs any."""
    device = assemble_selected(candidate)
    stated, formed = problem.place.stated, problem.formed
    device = stand_on_trunk(device, robot, stated=stated, formed=formed)
    return replace(candidate, plate=device.plate, pedestals=device.pedestals)


def with_plates(
    selection: Selection,
    problem: SelectionProblem,
    criterion: Criterion | None,
    robot: Robot,
    *,
    ranked: bool = True,
) -> Selection:
    """The selection with each device on its plate, the lightest with its plate first.

    Every device has a plate of its own size: a smaller device has a lighter plate.

    Args:
        problem: the problem solved. criterion: see `select_by`; the first device is at its own
            incidence.
        ranked: False skips devices that without a plate are already heavier than the lightest with
            one.
    """
    plated: list[Candidate] = []
    for entry in selection.ranking:
        if ranked or all(entry.modules_mass < other.mass for other in plated):
            plated.append(with_plate(entry, problem, robot))
    first, lightest = plated[0], devices_by_mass(plated)[0]
    if lightest is not first and criterion is not None and problem.incidence is None:
        _, own = at_own_incidence(problem, lightest, criterion)
        lightest = first if own is None else with_plate(own, problem, robot)
    others = [entry for entry in plated if not same_parts(entry, lightest)]
    return replace(selection, ranking=(lightest, *devices_by_mass(others)))


@dataclass(frozen=True, eq=False)
class _Search:
    """Search for a device together with its mount on the robot.

    Attributes:
        criterion: see `select_by`. robot: robot that carries it. near: see `design_device`.
    """

    criterion: Criterion | None
    robot: Robot
    near: Candidate | None

    def selected(self, problem: SelectionProblem, start: Candidate | None) -> Selection:
        """The selection for a problem; where its parts are known, only the device near `start`."""
        alone = self.near and start and lightest_near(problem, start, self.criterion)
        if alone is None:
            return select_by(problem, self.criterion, winner=start)
        return Selection((alone,), candidates=1, reasons=tuple)

    def settled(
        self, problem: SelectionProblem, best: Candidate
    ) -> tuple[SelectionProblem, Candidate]:
        """The problem for this device's footing, and the device for that problem, converged."""
        at, criterion = problem, self.criterion
        for _ in range(_FOOTINGS_MAX):
            own = _own_footing(problem, best, self.robot)
            masses = own.robot.mass, at.robot.mass
            change, heavier = abs(masses[0] - masses[1]), max(masses) - self.robot.mass
            same = own.place == at.place and own.foot_plate == at.foot_plate
            if same and change <= _SETTLED * best.mass:
                break
            again = device_at(own, best, best.incidence)
            if again is not None and criterion is not None and own.incidence is None:
                _, again = at_own_incidence(own, again, criterion)
            # Earlier estimates had no mast; with it another drive may be needed, or none suffices.
            again = again or lightest_by(own, criterion)
            try:
                best = again or select_by(own, criterion).best
            except Infeasible as error:
                held = format_quantity(own.robot.mass - self.robot.mass, "kg", digits=4)
                error.message = f"With a mount of {held} on the trunk: {error.message}"
                raise
            at = own
        else:
            if change > _NEVER_SETTLES * best.mass:
                raise NeverHeld(best, heavier)
        return at, best


def on_its_footing(
    problem: SelectionProblem,
    criterion: Criterion | None,
    robot: Robot,
    kept: tuple[Reality, Reserve],
    *,
    ranked: bool,
    near: Candidate | None,
) -> tuple[SelectionProblem, Selection, Reserve, Callable[[], Candidate]]:
    """The selection on the footing of its best device, preceded by the problem that it solves.

    They are followed by the reserve that it keeps, and a function that finds the lightest device
    without a reserve.

    The problem given is for the plate and the place of the largest possible modules. The selection
    is for those of its lightest device, then for those of the best drive alone, to convergence.

    Args:
        problem: to solve. criterion: see `select_by`. robot: robot that carries the device.
        ranked: see `with_plates`.
        near: see `design_device`.
        kept: sampled errors and the reserve for them, which is computed for the lightest device
            without a reserve.

    Raises:
        Infeasible: see `select_by`; also where no device can carry the mast or plate that it needs.
    """
    search, widest = _Search(criterion, robot, near), problem
    first = near and lightest_near(problem, near, criterion)
    first = first or lightest_by(problem, criterion)
    if first is not None:
        problem, first = search.settled(problem, first)
    nominal = select_by(problem, criterion).best if first is None else first
    reality, reserve = kept
    reserve = reserve.settled(reality, problem, nominal)
    free, plain = problem.incidence is None and criterion is None, problem
    problem, widest = (
        replace(each, requirement=reserve.kept(each.requirement, free=free))
        for each in (problem, widest)
    )
    first = device_at(problem, nominal, nominal.incidence)
    try:
        selection = search.selected(problem, first)
    except Infeasible:
        problem = widest
        selection = select_by(problem, criterion)
    # The first reserve was computed for a device without one, at that device's incidence: where
    # this device needs a larger one, it keeps that.
    for _ in range(_RESERVES_MAX if free else 0):
        needed = reality.needed(plain, selection.best, reserve)
        if needed.reliability >= reserve.reliability:
            break
        more = reserve.of(needed)
        surer = replace(problem, requirement=more.kept(plain.requirement, free=True))
        try:
            selection = search.selected(surer, selection.best)
        except Infeasible:
            break
        problem, reserve = surer, more
    selection = with_plates(selection, problem, criterion, robot, ranked=ranked)
    for _ in range(_FOOTINGS_MAX):
        best = selection.best
        own, device = search.settled(problem, best)
        if own is problem:
            break
        device, problem = lightest_near(own, device, criterion) or device, own
        others = [entry for entry in selection.ranking[1:] if not same_parts(entry, best)]
        selection = replace(selection, ranking=(with_plate(device, own, robot), *others))

    def least() -> Candidate:
        return lightest_near(plain, nominal, criterion) or nominal

    return problem, selection, reserve, least


def _own_footing(problem: SelectionProblem, best: Candidate, robot: Robot) -> SelectionProblem:
    """The problem for the plate, the place and the feet of this device."""
    device, stated = assemble_selected(best), problem.place.stated
    module = best.modules_mass / len(best.layout)
    cage, feet = motor_mount(device).cage, best.foot_plate
    floor = 0.0 if cage is None else floor_at_shock(cage, best.motor.mass or 0.0, best.wheel.mass)
    least = plate_thickness(foot_of(device), module, floor)
    # Thicker feet are a little heavier, so a little excess is tolerated.
    if not least <= feet <= least + _TOO_THICK:
        feet = least
    found = footing_under(device, robot, stated=stated, formed=problem.formed)
    footing = found or Footing(problem.place, None)
    carried = footing.carried(robot.mass_properties)
    place = problem.place if stated else footing.place
    return replace(problem, robot=carried, place=place, foot_plate=feet)


def in_rings(
    problem: SelectionProblem,
    best: Candidate,
    criterion: Criterion | None,
    robot: Robot,
) -> tuple[SelectionProblem, Selection]:
    """The selection with guard rings that contain the wheels of its best device, and its problem.

    All drives are ranked with rings of one wall thickness, then the lightest with rings for its own
    wheels, until no other is lighter.

    Args:
        problem: without rings. best: its lightest device, whose rings set the first wall thickness.
        criterion: see `select_by`. robot: robot that carries the device.

    Raises:
        Infeasible: every device is too heavy with its rings.
    """

    def ringed(best: Candidate, least: float) -> SelectionProblem:
        burst = burst_of(assemble_selected(best))
        own = _own_footing(problem, best, robot)
        return replace(own, guard_wall=max(least, burst.built_wall))

    at, tried = ringed(best, 0.0), set[tuple[str, str]]()
    try:
        selection = select_by(at, criterion)
    except Infeasible as error:
        raise _unheld(at.guard_wall, error) from error
    selection = with_plates(selection, at, criterion, robot)
    for _ in range(_RINGS_MAX):
        best = selection.best
        drive = best.motor.name, best.gear.name
        # The rings of a drive only grow, so the last ones contain its wheels.
        own = ringed(best, best.guard_wall if drive in tried else 0.0)
        tried.add(drive)
        change = abs(own.robot.mass - at.robot.mass)
        walls = own.guard_wall == best.guard_wall and own.foot_plate == best.foot_plate
        same = own.place == at.place and walls
        if same and change <= _SETTLED * best.mass:
            break
        others = [
            entry
            for entry in selection.ranking
            if (entry.motor, entry.gear) != (best.motor, best.gear)
        ]
        alone = replace(own, motors=(best.motor,), gears=(best.gear,))
        try:
            again = select_by(alone, criterion)
        except Infeasible as error:
            if not others:
                raise _unheld(own.guard_wall, error) from error
            selection = replace(selection, ranking=tuple(others))
            continue
        again, at = with_plates(again, alone, criterion, robot), own
        ranking = devices_by_mass((*again.ranking, *others))
        selection = replace(selection, ranking=tuple(ranking))
    return at, selection


def _unheld(wall: float, error: Infeasible) -> Infeasible:
    """The error where every device is too heavy with rings that contain its wheels."""
    return Infeasible(
        f"With guard rings of {1e3 * wall:.1f} mm steel no motor meets all requirements: {error}",
        binding=["ocs.guard", *error.binding],
        required_spin_inertia=error.required_spin_inertia,
        largest_spin_inertia=error.largest_spin_inertia,
        relaxations=error.relaxations,
        hint="Leave out --guard containing and run it behind a wall, or allow more voltage, room "
        "or time.",
    )
