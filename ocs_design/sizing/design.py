"""Design of a device for a resolved specification, by the bound alone or with a real motor."""

from contextlib import suppress
from dataclasses import replace

import numpy as np

from ocs_design.actuation.drive import Drive
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import Infeasible, UsageError
from ocs_design.common.records import recorded
from ocs_design.common.wording import some_of
from ocs_design.device.answers import FrontDevice
from ocs_design.device.device import Device, modules_at
from ocs_design.device.layout import PAIR, Criterion
from ocs_design.device.records.selection import CoDesignRecord
from ocs_design.parts.wheel import Flywheel
from ocs_design.requirement.checks import contradictions
from ocs_design.requirement.froude import standing_height, wheel_gains
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import CONTAINING, LIGHTEST, MORE_PAIRS, PYRAMID
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Robot
from ocs_design.robot.surface import trunk_surface
from ocs_design.sizing.bound.device_sizing import DeviceProblem, DeviceSizing, size_device
from ocs_design.sizing.footing.feet import FailedSearches
from ocs_design.sizing.footing.standing import standing_on
from ocs_design.sizing.free_place import specified_place
from ocs_design.sizing.limits import DEVICE_MASS, Progress
from ocs_design.sizing.on_robot import OnRobot
from ocs_design.sizing.reserve import NOMINAL, Reserve, SampledErrors, reserve_record
from ocs_design.sizing.selection.problem import Candidate, SelectionProblem
from ocs_design.sizing.selection.select import device_at, with_demands
from ocs_design.sizing.sized import Designed, DriveChoice, sized_by_bound, sized_selection
from ocs_design.sizing.specified import require_survival, selection_problem, specified_criterion

BY_HAND = "by hand"
"""Name for the criterion of an incidence, or the source of a spin inertia, that the user gave."""


KICK_ROUNDS, _KICK_TOLERANCE = 3, 0.01
"""Number of times a device is sized again for kicks about its own centre of mass, and change of
their angular impulse, relative to the largest, that counts as converged."""


def design_device(
    task: Task,
    *,
    ranked: bool = True,
    reserve: Reserve | None = None,
    near: Candidate | None = None,
) -> Designed:
    """The lightest device that meets the specification.

    A kick turns the robot about a centre of mass that depends on the device, so the device is sized
    for the kicks on the robot with the previous device, then by secants. If the first one, for the
    robot alone, is infeasible, a device for milder kicks comes before it. Where secants do not
    converge, the result is the lightest device that was sized for kicks no smaller than its own.

    Args:
        ranked: whether heavier devices are ranked too, which takes longer.
        reserve: reserve for sampled errors; None: that of the specified reliability.
        near: device to start from, whose motor, gear and material are kept; None: all parts on
            offer are searched.

    Raises:
        Infeasible: there is none.
        UsageError: nothing is required, or a limit is not a positive number.
    """
    # The device must not depend on the searches for other devices.
    failed = FailedSearches()
    tried: list[tuple[float, float, Designed]] = []
    previous: tuple[FloatArray, FloatArray] | None = None
    com, refusal = task.robot.com, None
    while len(tried) <= KICK_ROUNDS:
        try:
            designed = _designed(task, failed, ranked=ranked, reserve=reserve, near=near)
        except Infeasible as error:
            carried = None if tried or refusal else _carrying_a_device(task, failed)
            if carried is not None:
                # About the centre of mass with a device on, a kick may ask for less.
                refusal, com = error, carried.com
                task = task.with_requirement(task.resolved.requirement.on(carried))
                continue
            if all(excess > 0.0 for excess, _, _ in tried):
                requirement = task.resolved.requirement
                calmer = requirement.changed(lambda maneuver: maneuver.with_less_torque())
                if calmer.maneuvers == requirement.maneuvers:
                    raise refusal or error from None
                # Standing up more slowly takes less torque and more momentum.
                with suppress(Infeasible):
                    return design_device(
                        task.with_requirement(calmer), ranked=ranked, reserve=reserve
                    )
                raise refusal or error from None
            break
        total, requirement = designed.sized.total, task.resolved.requirement
        actual = requirement.on(total)
        largest = np.abs(actual.kicks).max(initial=0.0)
        change = np.abs(actual.kicks - requirement.kicks)
        converged = change.max(initial=0.0) <= _KICK_TOLERANCE * largest
        excess = max(
            largest - (1.0 + _KICK_TOLERANCE) * np.abs(requirement.kicks).max(initial=0.0), 0.0
        )
        designed = replace(designed, requirement=actual)
        if converged:
            return designed
        tried.append((excess, designed.device.mass, designed))
        com_found, offset = total.com, total.com - com
        com = com_found
        if previous is not None:
            change_of_offset = offset - previous[1]
            com = com_found - (com_found - previous[0]) * (offset @ change_of_offset) / (
                change_of_offset @ change_of_offset
            )
        previous = com_found, offset
        task = task.with_requirement(requirement.on(replace(total, com=com)))
    return min(tried, key=lambda attempt: attempt[:2])[2]


_MILDER_KICK = 0.5
"""Share of a kick with which a device is sized where none can meet the kick on the robot alone."""


def _carrying_a_device(task: Task, failed: FailedSearches) -> MassProperties | None:
    """The robot with a device sized for milder kicks; None: there is neither."""
    requirement = task.resolved.requirement
    milder = requirement.changed(
        lambda maneuver: (
            maneuver
            if maneuver.on_pivot or maneuver.momentum_of_body is None
            else maneuver.milder(_MILDER_KICK)
        )
    )
    if milder.maneuvers == requirement.maneuvers:
        return None
    with suppress(Infeasible):
        return _designed(
            task.with_requirement(milder), failed, ranked=False, reserve=Reserve(NOMINAL), near=None
        ).sized.total
    return None


def _designed(
    task: Task,
    failed: FailedSearches,
    *,
    ranked: bool,
    reserve: Reserve | None,
    near: Candidate | None,
) -> Designed:
    """The device for the task as resolved; see `design_device`."""
    problem = selection_problem(task)
    if problem is None:
        designed = _by_bound(task)
    else:
        reliability = task.resolved.reliability
        assert reliability is not None, "there are motors to choose from"
        require_survival(problem)
        reserve = reserve or Reserve(reliability)
        search = OnRobot(task.robot, specified_criterion(task.specification), near, failed)
        designed = _by_selection(task, problem, search, reserve, ranked=ranked)
        device, choice = designed.device, designed.choice
        formed = replace(problem, formed=True)
        # The last resort, after all mounts on flat surfaces.
        if (
            device.layout.pairs
            and choice is not None
            and choice.lacks_mount
            and search.footing(device, formed) is not None
        ):
            with suppress(Infeasible):
                on_formed_block = _by_selection(task, formed, search, reserve, ranked=ranked)
                designed = designed if on_formed_block.device.plate is None else on_formed_block
    device, mass_max = designed.device, task.specification.ocs.mass_max
    # This device is already the lightest: no search is needed.
    if mass_max is None or device.mass <= mass_max:
        return designed
    raise Infeasible(
        f"The lightest device that meets all requirements weighs {DEVICE_MASS.figure(device.mass)} "
        f"(all modules); ocs.mass_max allows {DEVICE_MASS.figure(mass_max)}.",
        binding=[DEVICE_MASS.name],
        required_spin_inertia=device.flywheel.spin_inertia,
        largest_spin_inertia=device.flywheel.spin_inertia,
        relaxations={DEVICE_MASS.name: device.mass},
        hint=f"{DEVICE_MASS.loose_text(device.mass)} would do. Without this limit, `size` reports "
        "what would make it lighter: more room, voltage or time.",
    )


def _by_bound(task: Task) -> Designed:
    """Two wheels without motors (docs/theory.md, Lower bound on the wheels' inertia)."""
    ocs, robot, resolved = task.specification.ocs, task.robot, task.resolved
    criterion = Criterion(ocs.alpha_criterion or Criterion.EQUAL_RATE)
    sizing = size_device(
        DeviceProblem(
            robot.mass_properties,
            resolved.requirement,
            resolved.envelope,
            resolved.material,
            specified_place(ocs.position, robot, resolved.envelope),
            incidence=ocs.alpha,
            criterion=criterion,
        )
    )
    return Designed(
        device=_driven_as_assumed(sizing, resolved),
        sized=sized_by_bound(sizing, resolved.requirement.wheel_speed_max),
        criterion=BY_HAND if ocs.alpha is not None else str(criterion),
        choice=None,
    )


def _driven_as_assumed(sizing: DeviceSizing, resolved: Resolved) -> Device:
    """Two modules at the sized places, each with the sized wheel and the assumed motor."""
    rim, speed = sizing.rim, resolved.requirement.wheel_speed_max
    cylinder = (rim.inner_radius, rim.outer_radius, rim.height)
    flywheel = Flywheel.of(cylinder, resolved.material, speed, rotor_share=0.0)
    return Device(
        sizing.incidence,
        modules_at(sizing.centers, sizing.incidence),
        # Exactly the mass that was minimised.
        replace(flywheel, mass=rim.mass),
        Drive(
            name="assumed",
            mass=0.0,
            stall_torque=None,
            no_load_speed=speed,
            torque_limit=resolved.torque_max,
            rotor_inertia=0.0,
            source="no motor is chosen; highest speed and torque as assumed or specified",
        ),
    )


def _by_selection(
    task: Task,
    problem: SelectionProblem,
    search: OnRobot,
    reserve: Reserve,
    *,
    ranked: bool,
) -> Designed:
    """Modules, each with a motor of the catalogue, co-designed where that is specified."""
    specification, robot, criterion = task.specification, task.robot, search.criterion
    errors = SampledErrors.of(
        specification.reality,
        robot,
        standing_height(robot),
        wheel_gains(robot, kp=specification.validation.kp, kd=specification.validation.kd),
        ballistic=specification.validation.ballistic is True,
    )
    requirement, in_rings = problem.requirement, None
    mounted = search.mounted(problem, errors, reserve, ranked=ranked)
    problem, selection, reserve = mounted.problem, mounted.selection, mounted.reserve
    if specification.ocs.guard == CONTAINING:
        problem, selection = search.in_rings(problem, selection.best)
        best = selection.best
        in_rings = (
            device_at(replace(problem, requirement=requirement), best, best.incidence) or best
        )
    if criterion is not None:
        problem = replace(problem, incidence=selection.best.incidence)
    # The lightest on its plate need not be the one that led the search.
    best = with_demands(problem, selection.best)
    selection = replace(selection, ranking=(best, *selection.ranking[1:]))
    chosen, co_designed = best, None
    specified = problem.layout != PAIR or specification.ocs.alpha is not None
    if specification.ocs.co_design:
        # CasADi takes a third of a second to import.
        from ocs_design.sizing.trajectory.co_design import co_design  # noqa: PLC0415

        result = co_design(problem, best)
        if result.adopted:
            # The co-design counted the selected device's plate.
            plated = search.with_plate(result.device, problem)
            result = replace(result, device=plated, mass=plated.mass)
            if plated.mass >= best.mass:
                remark = (
                    "the selected device is kept: a heavier plate outweighs the gain of the wheels"
                )
                result = replace(result, adopted=False, remark=remark, device=best)
        chosen, co_designed = result.device, recorded(CoDesignRecord, result)
    name = LIGHTEST if criterion is None else str(criterion)

    def mass_with_reserve(changed_reserve: Reserve) -> float | None:
        """Mass of the selected parts and the plate, sized with another reserve [kg]."""
        reserved = replace(
            problem,
            requirement=changed_reserve.applied_to(problem.requirement, incidence_is_free=False),
        )
        device = device_at(reserved, selection.best, chosen.incidence)
        return None if device is None else device.modules_mass + chosen.plate_mass

    def mass_without_reserve() -> float:
        """Mass of the device without a reserve [kg]."""
        if not any(kept.demand > 1.0 for kept in reserve.maneuvers.values()):
            return chosen.mass
        nominal = in_rings or search.without_reserve(mounted)
        return search.with_plate(nominal, problem).mass

    # A co-design makes the selected device smaller, and its plate with it.
    device, footing = chosen.device, search.footing(chosen.device, problem)
    lacks_mount = footing is None and trunk_surface(robot) is not None
    device = device if footing is None else standing_on(device, footing)
    sized = sized_selection(problem, chosen, robot.mass_properties)
    return Designed(
        device=device,
        sized=replace(sized, total=device.on(robot.mass_properties)),
        criterion=BY_HAND if specified else name,
        choice=DriveChoice(problem, selection, chosen, co_designed, lacks_mount),
        reserve=reserve,
        account=lambda: reserve_record(
            reserve, errors, problem, chosen, mass_with_reserve, nominal=mass_without_reserve()
        ),
    )


REDUNDANT_LAYOUTS = ("triad", *MORE_PAIRS[:1], PYRAMID)
"""Layouts that control roll and pitch with any one wheel missing, the fewest wheels first."""


def layouts_that_survive(specification: Specification, robot: Robot, progress: Progress) -> str:
    """Layouts that would survive a stopped drive, with their masses, for a layout that cannot."""
    masses: dict[str, float] = {}
    refusals: list[str] = []
    for done, layout in enumerate(REDUNDANT_LAYOUTS):
        progress(done / len(REDUNDANT_LAYOUTS))
        ocs = replace(
            specification.ocs, layout=layout, axes=None, position=None, alpha=None,
            alpha_criterion=None,
        )  # fmt: skip
        variant = replace(specification, ocs=ocs)
        if any(contradictions(variant)):
            continue
        try:
            masses[layout] = design_device(Task.of(variant, robot), ranked=False).device.mass
        except Infeasible as error:
            refusals.append(f"{layout}: {error.message.rstrip('.')}")
    if not masses:
        why = f" ({'; '.join(refusals)})" if refusals else ""
        return f"No layout that survives it has a feasible device either{why}."
    text = some_of([f"`--layout {name}` {1e3 * mass:.0f} g" for name, mass in masses.items()])
    return (
        f"Layouts that survive it: {text}. `validate DESIGN --survives one` reports at which "
        "instants of failure a device that was not sized to survive still lands."
    )


def mass_without_survival(task: Task) -> float | None:
    """Mass of the lightest device that need not survive a stopped drive [kg]; None: there is none.

    The task's device has to survive it.
    """
    with suppress(Infeasible):
        free = task.with_requirement(replace(task.resolved.requirement, detection=None))
        return design_device(free, ranked=False).device.mass
    return None


def lightest_device(task: Task) -> FrontDevice:
    """Lightest device that is selected for a task, before any co-design.

    Raises:
        Infeasible: there is none; without advice on what would help.
        UsageError: the specification has no motor.
    """
    if task.resolved.choice is None:
        raise UsageError(
            "a front needs motors to choose from",
            hint="leave out --motor none, or motor.name in the specification",
        )
    specified = task.specification
    without_co_design = replace(specified, ocs=replace(specified.ocs, co_design=False))
    designed = design_device(replace(task, specification=without_co_design), ranked=False)
    choice = designed.choice
    assert choice is not None, "there are motors to choose from"
    best = choice.chosen
    return recorded(
        FrontDevice,
        best,
        share=best.mass / task.robot.mass,
        motor=best.motor.name,
        gear=best.gear.name,
        material=best.material.name,
        rim_mass=best.flywheel.rim_mass,
        overvoltage=designed.device.motor.overvoltage,
    )
