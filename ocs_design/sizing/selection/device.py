"""A solved candidate as a whole device, and its figures."""

from dataclasses import replace

import numpy as np

from ocs_design.actuation.slew import slew_profile
from ocs_design.actuation.spin_root import capability
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import WheelTask, smallest_spin_inertia, spin_demand
from ocs_design.device.records.selection import TaskDemand
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.requirement import Requirement
from ocs_design.sizing.lightest_module import binding_limits
from ocs_design.sizing.selection.demand import rate_demands, roll_cancelling_momentum, wheel_task
from ocs_design.sizing.selection.fixed_point import Solved
from ocs_design.sizing.selection.problem import Candidate, SelectionProblem, inertia_at


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
        rim_mass=float(shape.rim_mass),
        overspeed=float(drives.overspeed[0]),
        limits=limits,
        robot=problem.robot,
        place=problem.place,
        binding=binding_limits(shape, limits, problem.envelope),
        residual=float(solved.point.residual[0]),
        iterations=int(solved.point.iterations[0]),
        guard_wall=problem.guard_wall,
        foot_plate=problem.foot_plate,
        layout=problem.layout,
        on_bell=problem.on_bell,
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


_ROUNDING = 1e-6
"""Relative shortfall that counts as rounding for a device sized exactly for the demand."""
