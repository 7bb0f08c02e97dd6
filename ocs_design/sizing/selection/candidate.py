"""A settled candidate in full."""

from collections.abc import Iterator

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.line import DriveLine
from ocs_design.drive.slew_profile import slew_profile
from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.drive.wheel_pair import WheelPairTask, smallest_spin_inertia
from ocs_design.requirement.bound import AXES
from ocs_design.robot.mass_properties import MassProperties, combine
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.incidence import module_frames
from ocs_design.sizing.placement import motor_size
from ocs_design.sizing.selection.binding import binding_limits
from ocs_design.sizing.selection.demand import held_by_rate, pair_task, shares_of
from ocs_design.sizing.selection.drive_table import DriveTable
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.result import Candidate, TaskDemand
from ocs_design.sizing.selection.settling import Settled
from ocs_design.sizing.standing import standing
from ocs_design.sizing.web import wheel_body


def candidate(problem: SelectionProblem, settled: Settled, row: int) -> Candidate:
    """The device of one row of what is settled."""
    drives = settled.lot.drives
    motor, gear = problem.motors[drives.motor[row]], problem.gears[drives.gear[row]]
    material = problem.materials[settled.lot.material[row]]
    inner, outer, height, rim_mass = (float(value[row]) for value in settled.point.shapes[:4])
    hub = problem.hub(motor, gear)
    cuts = settled.lot.limits.cuts
    carrier = standing(motor, gear, outer, height)
    centers = problem.place.centers(motor_size(motor, gear.room, outer, height))
    wheel = wheel_body(inner, outer, height, material.density, hub, cuts=cuts)
    modules = (wheel, carrier)
    incidence, spin = float(settled.point.angle[row]), float(settled.point.spin_inertia[row])
    return Candidate(
        motor=motor,
        gear=gear,
        material=material,
        incidence=incidence,
        spin_inertia=spin,
        rotor_share=float(drives.rotor_share[row]),
        armature=float(drives.armature[row]),
        inner_radius=inner,
        outer_radius=outer,
        height=height,
        hub=hub,
        cuts=cuts,
        rim_mass=rim_mass,
        web_mass=wheel.mass - rim_mass,
        carrier=carrier,
        line=_line(drives, row),
        overspeed=float(drives.overspeed[row]),
        total=braked(problem.robot, modules, centers, incidence),
        centers=centers,
        demands=tuple(
            _demands(
                problem,
                drives,
                row,
                bodies=modules,
                centers=centers,
                incidence=incidence,
                spin_inertia=spin,
            )
        ),
        binding=binding_limits(settled.point.shapes, settled.lot.limits, problem.envelope, row),
        residual=float(settled.point.residual[row]),
        iterations=settled.iterations,
    )


def braked(
    robot: MassProperties, bodies: tuple[Carrier, ...], centers: FloatArray, incidence: float
) -> MassProperties:
    """Robot and both modules as one rigid body in B.

    Args:
        robot: without the modules.
        bodies: of one module, in its own frame (`incidence.module_frames`).
        centers: of the wheels in B [m], shape (2, 3).
        incidence: of their axes [rad].
    """
    parts = [robot]
    for center, attitude in zip(centers, module_frames(incidence), strict=True):
        parts += [body.mass_properties().moved(attitude, center) for body in bodies]
    return combine(parts)


def _line(drives: DriveTable, row: int) -> DriveLine:
    return DriveLine(
        *(
            float(values[row])
            for values in (
                drives.stall_torque,
                drives.no_load_speed,
                drives.torque_limit,
                drives.speed_max,
            )
        )
    )


def _demands(
    problem: SelectionProblem,
    drives: DriveTable,
    row: int,
    *,
    bodies: tuple[Carrier, ...],
    centers: FloatArray,
    incidence: float,
    spin_inertia: float,
) -> Iterator[TaskDemand]:
    """Of each part of the requirement, with the inertia at its own incidence."""
    requirement, line = problem.requirement, _line(drives, row).reserved()
    armature = float(drives.armature[row])
    for maneuver in requirement.maneuvers:
        at = incidence if maneuver.incidence is None else maneuver.incidence
        inertia = TiltInertia.of(braked(problem.robot, bodies, centers, at).inertia)
        shares = shares_of(np.array([[at]]))
        task = pair_task([maneuver], requirement.standing_height, inertia, shares)
        yield _of_maneuver(
            maneuver.name, at, task, line, armature=armature, spin_inertia=spin_inertia
        )
    if requirement.rate_change is not None:
        inertia = TiltInertia.of(braked(problem.robot, bodies, centers, incidence).inertia)
        shares = shares_of(np.asarray(incidence))
        momenta = held_by_rate(requirement.rate_change, inertia, shares)
        for axis, momentum in zip(AXES, momenta.tolist(), strict=True):
            least = momentum / float(drives.top_speed[row])
            peak = momentum / spin_inertia
            yield TaskDemand(f"rate change, {axis}", incidence, least, None, None, peak, None)


def _of_maneuver(
    name: str,
    incidence: float,
    task: WheelPairTask,
    line: DriveLine,
    *,
    armature: float,
    spin_inertia: float,
) -> TaskDemand:
    load = task.load()
    profile = slew_profile(
        load.angle(spin_inertia),
        load.reduced_inertia(spin_inertia, armature),
        line,
        load.final_speed(spin_inertia),
    )
    # The torque of a phase falls with the speed while it pushes and rises with it while it brakes.
    torque = np.abs(profile.torque(np.array([0.0, profile.brake_from.item()])))
    return TaskDemand(
        source=name,
        incidence=incidence,
        spin_inertia=smallest_spin_inertia(task, line, armature).item(),
        time_needed=profile.end.item(),
        time_given=np.asarray(task.duration).item(),
        peak_speed=profile.peak_speed.item(),
        peak_torque=float(torque.max()),
    )
