"""Selection of devices on the robot, each with its own plate, feet and guard rings.

Plate, feet and rings depend on the device that they carry or guard, and add to what it must turn:
both are found in turn until they converge.
"""

from dataclasses import dataclass, field, replace

from ocs_design.common.errors import Constraint, Infeasible
from ocs_design.common.units import format_quantity
from ocs_design.device.device import Device
from ocs_design.device.joints import burst_of, least_web_thickness
from ocs_design.device.layout import Criterion
from ocs_design.parts.cage import floor_at_shock
from ocs_design.parts.foot import plate_thickness
from ocs_design.robot.robot import Robot
from ocs_design.sizing.footing.feet import FailedSearches, Footing
from ocs_design.sizing.footing.standing import footing_under
from ocs_design.sizing.reserve import Reserve, SampledErrors
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

_CONVERGED = 1e-3
"""Change of the plate's mass, relative to the device's, that counts as converged; the device's mass
then changes by a hundredth of it."""

_DIVERGED = 0.05
"""Change of that mass above which a device counts as mounted differently each time it is sized."""

_TOO_THICK = 0.2e-3
"""Excess thickness of feet that is tolerated [m]: 0.5 g each."""


class NoMountHolds(Infeasible):
    """The mount would need a larger device, which no mount can hold.

    Its arguments are the device and the mass of the heaviest mount that would hold it [kg].
    """

    def __init__(self, best: Candidate, mass: float) -> None:
        mount, device = (
            format_quantity(value, "kg", digits=3) for value in (mass, best.modules_mass)
        )
        super().__init__(
            f"A device of {device} needs a mount of {mount} on the trunk, but turning that mount "
            "too takes a larger device, which no mount can hold.",
            binding=[Constraint.MOUNT],
            largest_spin_inertia=best.spin_inertia,
            hint="Another incidence, more time or a higher voltage makes the device smaller.",
        )


@dataclass(frozen=True, eq=False)
class Mounted:
    """A selection on the footing of its best device.

    Attributes:
        problem: on this footing, which the selection solves. selection: its solution.
        reserve: that it keeps.
        unreserved: the problem without a reserve. nominal: the device that the reserve was computed
            for.
    """

    problem: SelectionProblem
    selection: Selection
    reserve: Reserve
    unreserved: SelectionProblem
    nominal: Candidate


@dataclass(frozen=True, eq=False)
class OnRobot:
    """Search for a device together with its mount on the robot.

    Attributes:
        robot: robot that carries it.
        criterion: see `select_by`; None: the incidence is specified or free.
        near: see `design_device`.
        failed: searches for a footing that have failed on this robot.
    """

    robot: Robot
    criterion: Criterion | None = None
    near: Candidate | None = None
    failed: FailedSearches = field(default_factory=FailedSearches)

    def footing(self, device: Device, problem: SelectionProblem) -> Footing | None:
        """Footing of a device, placed as the problem specifies; None: no known support."""
        specified, formed = problem.place.specified, problem.formed
        return footing_under(
            device, self.robot, specified=specified, formed=formed, failed=self.failed
        )

    def with_plate(self, candidate: Candidate, problem: SelectionProblem) -> Candidate:
        """A selected device with its plate or pedestals, where it needs any."""
        footing = self.footing(candidate.device, problem) or Footing(problem.place, None)
        return replace(candidate, plate_mass=sum(support.mass for support in footing.supports))

    def with_plates(
        self, selection: Selection, problem: SelectionProblem, *, ranked: bool = True
    ) -> Selection:
        """The selection with each device on its plate, the lightest with its plate first.

        Every device has a plate of its own size: a smaller device has a lighter plate. The first is
        at its own incidence.

        `ranked`: False skips devices that without a plate are already heavier than the lightest
        with one.
        """
        plated: list[Candidate] = []
        for entry in selection.ranking:
            if ranked or all(entry.modules_mass < other.mass for other in plated):
                plated.append(self.with_plate(entry, problem))
        first, lightest = plated[0], devices_by_mass(plated)[0]
        if lightest is not first and self.criterion is not None and problem.incidence is None:
            _, at_own = at_own_incidence(problem, lightest, self.criterion)
            lightest = first if at_own is None else self.with_plate(at_own, problem)
        others = [entry for entry in plated if not same_parts(entry, lightest)]
        return replace(selection, ranking=(lightest, *devices_by_mass(others)))

    def _selected(self, problem: SelectionProblem, start: Candidate | None) -> Selection:
        """The selection for a problem; where its parts are known, only the device near `start`."""
        near_start = self.near and start and lightest_near(problem, start, self.criterion)
        if near_start is None:
            return select_by(problem, self.criterion, winner=start)
        return Selection((near_start,), candidates=1, reasons=tuple)

    def _converged_footing(
        self, problem: SelectionProblem, best: Candidate
    ) -> tuple[SelectionProblem, Candidate]:
        """The problem for this device's footing, and the device for that problem, converged."""
        on_footing, criterion = problem, self.criterion
        for _ in range(_FOOTINGS_MAX):
            on_own_footing = self._own_footing(problem, best)
            masses = on_own_footing.robot.mass, on_footing.robot.mass
            change, mount_mass = abs(masses[0] - masses[1]), max(masses) - self.robot.mass
            same = (
                on_own_footing.place == on_footing.place
                and on_own_footing.foot_plate == on_footing.foot_plate
                and on_own_footing.web_thickness == on_footing.web_thickness
            )
            if same and change <= _CONVERGED * best.mass:
                break
            device = device_at(on_own_footing, best, best.incidence)
            if device is not None and criterion is not None and on_own_footing.incidence is None:
                _, device = at_own_incidence(on_own_footing, device, criterion)
            # Earlier estimates had no mast; with it another drive may be needed, or none suffices.
            device, winner = (device, None) if device else lightest_by(on_own_footing, criterion)
            try:
                best = device or select_by(on_own_footing, criterion, winner).best
            except Infeasible as error:
                mount = format_quantity(on_own_footing.robot.mass - self.robot.mass, "kg", digits=4)
                error.message = f"With a mount of {mount} on the trunk: {error.message}"
                raise
            on_footing = on_own_footing
        else:
            if change > _DIVERGED * best.mass:
                raise NoMountHolds(best, mount_mass)
        return on_footing, best

    def mounted(
        self, problem: SelectionProblem, errors: SampledErrors, reserve: Reserve, *, ranked: bool
    ) -> Mounted:
        """The selection on the footing of its best device.

        The problem given is for the plate and the place of the largest possible modules. The
        selection is for those of its lightest device, then for those of the best drive alone, to
        convergence.

        The reserve is computed for the lightest device without one. `ranked`: see `with_plates`.

        Raises:
            Infeasible: see `select_by`; also where no device can carry the mast or plate that it
                needs.
        """
        criterion, widest = self.criterion, problem
        first, winner = self.near and lightest_near(problem, self.near, criterion), None
        if first is None:
            first, winner = lightest_by(problem, criterion)
        if first is not None:
            problem, first = self._converged_footing(problem, first)
        nominal = select_by(problem, criterion, winner).best if first is None else first
        reserve = reserve.computed_for(errors, problem, nominal)
        incidence_is_free, unreserved = problem.incidence is None and criterion is None, problem
        problem, widest = (
            replace(
                variant,
                requirement=reserve.applied_to(
                    variant.requirement, incidence_is_free=incidence_is_free
                ),
            )
            for variant in (problem, widest)
        )
        first = device_at(problem, nominal, nominal.incidence)
        try:
            selection = self._selected(problem, first)
        except Infeasible:
            problem = widest
            selection = select_by(problem, criterion)
        # The first reserve was computed for a device without one, at that device's incidence:
        # where this device needs a larger one, it keeps that.
        for _ in range(_RESERVES_MAX if incidence_is_free else 0):
            best = selection.best
            needs = errors.needs(unreserved, best, reserve, errors.drawn(unreserved, best))
            if needs.reliability >= reserve.reliability:
                break
            larger_reserve = reserve.covering(needs)
            with_more = replace(
                problem,
                requirement=larger_reserve.applied_to(
                    unreserved.requirement, incidence_is_free=True
                ),
            )
            try:
                selection = self._selected(with_more, selection.best)
            except Infeasible:
                break
            problem, reserve = with_more, larger_reserve
        selection = self.with_plates(selection, problem, ranked=ranked)
        for _ in range(_FOOTINGS_MAX):
            best = selection.best
            on_own_footing, device = self._converged_footing(problem, best)
            if on_own_footing is problem:
                break
            device = lightest_near(on_own_footing, device, criterion) or device
            problem = on_own_footing
            others = [entry for entry in selection.ranking[1:] if not same_parts(entry, best)]
            selection = replace(
                selection, ranking=(self.with_plate(device, on_own_footing), *others)
            )
        return Mounted(problem, selection, reserve, unreserved, nominal)

    def without_reserve(self, mounted: Mounted) -> Candidate:
        """The lightest device without a reserve."""
        return lightest_near(mounted.unreserved, mounted.nominal, self.criterion) or mounted.nominal

    def _own_footing(self, problem: SelectionProblem, best: Candidate) -> SelectionProblem:
        """The problem for the plate, the place, the feet and the web of this device."""
        device = best.device
        cage, feet = device.mount.cage, device.foot_plate
        floor = (
            0.0 if cage is None else floor_at_shock(cage, best.motor.mass or 0.0, best.wheel.mass)
        )
        least_thickness = plate_thickness(device.foot, device.module_mass, floor)
        # Thicker feet are a little heavier, so a little excess is tolerated.
        if not least_thickness <= feet <= least_thickness + _TOO_THICK:
            feet = least_thickness
        footing = self.footing(device, problem) or Footing(problem.place, None)
        carried = footing.added_to(self.robot.mass_properties)
        place = problem.place if problem.place.specified else footing.place
        # A thicker web leaves a lighter rim, so webs only grow.
        web = device.flywheel.web
        thin = problem.web_thickness if web is None else web.thickness
        least_web = max(least_web_thickness(device), thin)
        mounted = replace(problem, robot=carried, place=place, foot_plate=feet)
        return replace(mounted, least_web=least_web)

    def in_rings(
        self, problem: SelectionProblem, best: Candidate
    ) -> tuple[SelectionProblem, Selection]:
        """The selection with guard rings around the wheels of its best device, and its problem.

        All drives are ranked with rings of one wall thickness, then the lightest with rings that
        contain its own wheels, until no other is lighter. `best` is the lightest device without
        rings; its rings set the first wall thickness.

        Raises:
            Infeasible: every device is too heavy with its rings.
        """

        def ringed(best: Candidate, least: float) -> SelectionProblem:
            burst = burst_of(best.device)
            with_own_rings = self._own_footing(problem, best)
            return replace(with_own_rings, guard_wall=max(least, burst.built_wall))

        ringed_problem, tried = ringed(best, 0.0), set[tuple[str, str]]()
        try:
            selection = select_by(ringed_problem, self.criterion)
        except Infeasible as error:
            raise _too_heavy_with_rings(ringed_problem.guard_wall, error) from error
        selection = self.with_plates(selection, ringed_problem)
        for _ in range(_RINGS_MAX):
            best = selection.best
            drive = best.motor.name, best.gear.name
            # The rings of a drive only grow, so the last ones contain its wheels.
            with_own_rings = ringed(best, best.problem.guard_wall if drive in tried else 0.0)
            tried.add(drive)
            change = abs(with_own_rings.robot.mass - ringed_problem.robot.mass)
            walls = (
                with_own_rings.guard_wall == best.problem.guard_wall
                and with_own_rings.foot_plate == best.problem.foot_plate
                and with_own_rings.web_thickness == best.problem.web_thickness
            )
            converged = with_own_rings.place == ringed_problem.place and walls
            if converged and change <= _CONVERGED * best.mass:
                break
            others = [
                entry
                for entry in selection.ranking
                if (entry.motor, entry.gear) != (best.motor, best.gear)
            ]
            of_this_drive = replace(with_own_rings, motors=(best.motor,), gears=(best.gear,))
            try:
                reselected = select_by(of_this_drive, self.criterion)
            except Infeasible as error:
                if not others:
                    raise _too_heavy_with_rings(with_own_rings.guard_wall, error) from error
                selection = replace(selection, ranking=tuple(others))
                continue
            reselected, ringed_problem = self.with_plates(reselected, of_this_drive), with_own_rings
            ranking = devices_by_mass((*reselected.ranking, *others))
            selection = replace(selection, ranking=tuple(ranking))
        return ringed_problem, selection


def _too_heavy_with_rings(wall: float, error: Infeasible) -> Infeasible:
    """The error where every device is too heavy with rings that contain its wheels."""
    return Infeasible(
        f"With guard rings of {1e3 * wall:.1f} mm steel no motor meets all requirements: {error}",
        binding=[Constraint.GUARD, *error.binding],
        required_spin_inertia=error.required_spin_inertia,
        largest_spin_inertia=error.largest_spin_inertia,
        relaxations=error.relaxations,
        hint="Leave out --guard containing and run it behind a wall, or allow more voltage, room "
        "or time.",
    )
