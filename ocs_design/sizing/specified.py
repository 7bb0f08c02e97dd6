"""The selection's problem for a specification, with its layout, criterion, webs and cuts."""

from dataclasses import replace
from math import inf, isfinite

import numpy as np

from ocs_design.actuation.drive import speed_limit
from ocs_design.actuation.motor import Motor, Mounting
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import gauge, without_each
from ocs_design.catalogue.materials import material
from ocs_design.common.arrays import FloatArray, vector
from ocs_design.common.errors import Constraint, Infeasible, SpecificationError, UsageError
from ocs_design.common.units import format_quantity
from ocs_design.common.wording import some_of
from ocs_design.device.layout import PAIR, Criterion, Layout, LayoutName
from ocs_design.parts.bell import bell_of
from ocs_design.parts.joints import SERVICE, hub_joint
from ocs_design.parts.motor_mount import bond_length, hub_height, is_held, motor_front, mount_of
from ocs_design.parts.rim import NO_CUTS, WEB_MATERIAL, RimCuts
from ocs_design.requirement.choices import MotorChoice
from ocs_design.requirement.device_sections import Envelope, FlywheelSection
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.resolving import Resolved
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import (
    ALL_LAYOUTS,
    ALUMINIUM_WEB,
    AUTO,
    BALANCING_DEPTH,
    BALANCING_DIAMETER,
    CHAMFER,
    EQUAL_RATE,
    LARGEST_CHAMFER,
    LIGHTENING,
    LIGHTEST,
    NO_WEB,
    RING,
)
from ocs_design.sizing.footing.standing import footing_of
from ocs_design.sizing.selection.problem import SelectionProblem


def selection_problem(task: Task) -> SelectionProblem | None:
    """The problem that a specification poses; None where it has no motor."""
    specification, robot, resolved = task.specification, task.robot, task.resolved
    choice = resolved.choice
    if choice is None:
        return None
    specified, layout = specification.ocs, specified_layout(specification)
    footing = footing_of(robot, resolved.envelope, specified.position, layout)
    angle = layout.angle if specified.alpha is None else specified.alpha
    problem = SelectionProblem(
        robot=footing.added_to(robot.mass_properties),
        requirement=specified_requirement(task),
        envelope=resolved.envelope,
        place=footing.place,
        motors=_motors_that_hold(specification, resolved, choice),
        gears=choice.gears,
        materials=choice.materials,
        supply=choice.supply,
        incidence=angle,
        layout=layout,
        wheel_speed_max=choice.wheel_speed_max,
        web=specification.flywheel.web != NO_WEB,
        cuts=specified_cuts(specification.flywheel, resolved.envelope),
        web_material=material(WEB_MATERIAL)
        if specification.flywheel.web == ALUMINIUM_WEB
        else None,
        lightenings=specified_lightenings(specification.flywheel),
    )
    return on_bells(problem, choice) if specified.wheel == RING else problem


def specified_requirement(task: Task) -> Requirement:
    """Requirement of a task; turns are direct where the layout spans all three axes."""
    specified, layout = task.specification.ocs, specified_layout(task.specification)
    angle = layout.angle if specified.alpha is None else specified.alpha
    direct = angle is not None and bool(
        np.linalg.matrix_rank(layout.axes(angle), _SINGULAR_VALUE_MIN) == 3
    )
    return task.resolved.requirement.changed(lambda maneuver: maneuver.with_wheels(direct=direct))


def on_bells(problem: SelectionProblem, choice: MotorChoice) -> SelectionProblem:
    """The problem with rings around suitable motors' bells, on direct drive.

    Raises:
        UsageError: none has.
    """
    with_bells = tuple(motor for motor in choice.motors if bell_of(motor) is not None)
    if not with_bells:
        names = ", ".join(motor.name for motor in choice.motors[:_MOTORS_NAMED])
        more = " ..." if len(choice.motors) > _MOTORS_NAMED else ""
        raise UsageError(
            f"no ring fits around the bell of {names}{more}: it "
            "needs a back-mounted outrunner of known diameter and length whose bell is longer than "
            "its protruding shaft",
            hint="Name another motor with --motor, or leave out --wheel ring.",
        )
    return replace(
        problem,
        motors=with_bells,
        gears=(choice.direct,),
        web=False,
        on_bell=True,
        web_material=None,
        lightenings=(0,),
    )


def other_construction(task: Task, problem: SelectionProblem) -> SelectionProblem | None:
    """The problem with rings in place of discs, or discs in place of rings; None: there is none."""
    choice, flywheel = task.resolved.choice, task.specification.flywheel
    if choice is None or (flywheel.web == NO_WEB and not problem.on_bell):
        return None
    if problem.on_bell:
        return replace(
            problem,
            motors=_motors_that_hold(task.specification, task.resolved, choice),
            gears=choice.gears,
            web=True,
            on_bell=False,
            lightenings=specified_lightenings(flywheel),
        )
    try:
        return on_bells(problem, choice)
    except UsageError:
        return None


_MOTORS_NAMED = 3
"""Number of motors that a message names."""

_SINGULAR_VALUE_MIN = 1e-3
"""Least singular value of axes that span roll, pitch and yaw."""


def _motors_that_hold(
    specification: Specification, resolved: Resolved, choice: MotorChoice
) -> tuple[Motor, ...]:
    """Motors to choose from; unless named, only those that can be mounted and can hold a wheel.

    All of them where none can, whose open points then say why. Where a brake stops the wheels, each
    motor is limited to the speed that its joint withstands.
    """
    specified, motors = specification.motor, choice.motors
    if not (
        specified.any or specified.name not in {None, AUTO} or any(g.room for g in choice.gears)
    ):

        def holds_wheel(motor: Motor) -> bool:
            """Whether the joint of hub and motor carries its peak torque with margin."""
            torque = _joint_torque(motor, resolved.envelope)
            return torque is not None and torque >= SERVICE * (motor.peak_torque or 0.0)

        suitable = (motor for motor in motors if is_held(motor, None) and holds_wheel(motor))
        motors = tuple(suitable) or motors
    brake_time = min(
        (maneuver.braking_time for maneuver in resolved.requirement.maneuvers), default=inf
    )
    if not isfinite(brake_time):
        return motors
    limited = []
    for motor in motors:
        torque, speed, rotor = (
            _joint_torque(motor, resolved.envelope),
            speed_limit(motor),
            motor.rotor_inertia,
        )
        if torque is None or speed is None or not rotor:
            limited.append(motor)
        else:
            # The rotor's torque J W / t goes through the joint of hub and motor.
            fastest = min(speed, torque * brake_time / (SERVICE * rotor))
            limited.append(replace(motor, speed_max=fastest))
    return tuple(limited)


def _joint_torque(motor: Motor, room: Envelope) -> float | None:
    """Torque that the joint of hub and motor carries [N m]; None: no known joint does.

    A shaft is counted behind the highest rim that the selection may choose, in a hub with the
    largest chamfer, so that no device has less.
    """
    mounting, mount = motor.mounting or Mounting(), mount_of(motor, None)
    front = motor_front(mount, min(mount.rim_height_max, room.height_max))
    length = bond_length(mounting, hub_height(mounting), LARGEST_CHAMFER, front)
    return hub_joint(mounting, length)


def specified_lightenings(specified: FlywheelSection) -> tuple[int, ...]:
    """Numbers of lightening holes to choose from, 0 for a solid web, as under shrunk-on rims.

    A small wheel of a fast motor has no room for holes and may still be the lightest.
    """
    holes = LIGHTENING if specified.lightening is None else specified.lightening
    return (0, holes) if holes and specified.web not in {NO_WEB, ALUMINIUM_WEB} else (0,)


def specified_cuts(specified: FlywheelSection, room: Envelope) -> RimCuts:
    """Chamfers and balancing holes of wheels with a web.

    Raises:
        SpecificationError: no rim within the envelope is large enough for them.
    """
    if specified.web == NO_WEB:
        return NO_CUTS
    cuts = RimCuts(CHAMFER if specified.chamfer is None else specified.chamfer)
    if specified.balancing_holes:
        cuts = replace(
            cuts,
            holes=specified.balancing_holes,
            hole_radius=(specified.balancing_hole_diameter or BALANCING_DIAMETER) / 2.0,
            hole_depth=specified.balancing_hole_depth or BALANCING_DEPTH,
        )
    name, faults = "balancing_holes" if cuts.holes else "chamfer", []
    bore = max(room.inner_radius_min, cuts.inner_radius_min)
    wall = room.outer_radius_max - bore
    if cuts.wall_min > wall:
        faults.append(
            f"flywheel.{name}: the wall must be at least {format_quantity(cuts.wall_min, 'mm')}, "
            f"and {format_quantity(max(wall, 0.0), 'mm')} is left between r_max and the bore: "
            "allow a larger r_max, or fewer and smaller holes"
        )
    if cuts.height_min > room.height_max:
        faults.append(
            f"flywheel.{name}: the height must be at least "
            f"{format_quantity(cuts.height_min, 'mm')}, and h_max is "
            f"{format_quantity(room.height_max, 'mm')}: allow a larger h_max, or less depth"
        )
    if faults:
        raise SpecificationError(
            "the rim is too small for its chamfers and holes:", problems=faults
        )
    return cuts


def specified_layout(specification: Specification) -> Layout:
    """Layout of the wheels' axes; by default a pair."""
    specified = specification.ocs.layout
    if specified == ALL_LAYOUTS:
        raise UsageError(
            f"ocs.layout: {ALL_LAYOUTS!r} is not the layout of a single device",
            hint="`size --layout all` compares all layouts; name one of them here.",
        )
    if specification.ocs.axes is not None:
        axes = np.reshape(specification.ocs.axes, (-1, 3))
        axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
        return Layout(LayoutName.BY_HAND, tuple(vector(axis) for axis in axes))
    return PAIR if specified is None else Layout(LayoutName(specified))


def specified_criterion(specification: Specification) -> Criterion | None:
    """Criterion for a pair's incidence; None: whatever makes the device lightest."""
    specified = specification.ocs.alpha_criterion or EQUAL_RATE
    return None if specified == LIGHTEST else Criterion(specified)


class CannotSurvive(Infeasible):
    """The layout cannot do without every one of its wheels, whatever they weigh."""


def require_survival(problem: SelectionProblem) -> None:
    """Refuse a layout that cannot do a maneuver without a wheel, if it has to survive that.

    Raises:
        CannotSurvive: it cannot.
    """
    requirement, layout = problem.requirement, problem.layout
    lost: dict[str, list[str]] = {}
    if requirement.detection is None:
        return
    inertia = TiltInertia.uncoupled(np.diag(problem.robot.inertia)[:2])
    momenta: dict[str, tuple[float | None, FloatArray]] = {
        maneuver.name: (maneuver.incidence, np.abs(slew.swept) + np.abs(slew.momentum))
        for maneuver in requirement.maneuvers
        for slew in [maneuver.slew(inertia)]
    }
    if requirement.rate_change is not None:
        momenta["the rate change"] = None, np.ones(2)
    for name, (incidence, momentum) in momenta.items():
        angle = problem.incidence if incidence is None else incidence
        axes = layout.axes(_ANY_ANGLE if angle is None else angle)[:2]
        # Both signs, as roll and pitch momentum together may lie along an axis by chance.
        signed = momentum * np.array([[1.0, 1.0], [1.0, -1.0]])
        for wheel, remaining in zip(layout.names, without_each(axes), strict=True):
            if not np.isfinite(gauge(remaining, signed).busiest).all():
                lost.setdefault(wheel, []).append(name)
    if lost:
        wheel, names = next(iter(lost.items()))
        rest = "the others" if len(layout.names) > 1 else "it"
        raise CannotSurvive(
            f"{layout.text[0].upper()}{layout.text[1:]} cannot tolerate the failure of a drive: "
            f"without wheel {wheel!r} {rest} cannot absorb the momentum about roll and pitch that "
            f"{some_of(names)} require{'s' if len(names) == 1 else ''}.",
            binding=[Constraint.SURVIVES],
        )


_ANY_ANGLE = np.pi / 4.0
"""Angle used where a layout's is still to be chosen [rad]; the rank of its axes is the same."""
