"""From live values to the records of `design.json`."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ocs_design import __version__
from ocs_design.arrays import matrix, vector
from ocs_design.design_file import (
    SCHEMA_VERSION,
    AxisInertia,
    ClearanceRecord,
    ControlRecord,
    DemandRecord,
    ManeuverRecord,
    ModuleRecord,
    MountingRecord,
    OcsDesign,
    OcsRecord,
    ReachRecord,
    RequirementRecord,
    SizingRecord,
    Tool,
)
from ocs_design.designing import Designed
from ocs_design.device_warnings import device_warnings
from ocs_design.export.fitting import fitting_remarks
from ocs_design.export.footing import footing_remarks
from ocs_design.mounting import Clearance, Mounting
from ocs_design.recording.margins import record_margins
from ocs_design.recording.runs import record_run
from ocs_design.recording.selection import record_selection
from ocs_design.requirement.bound import SpinDemand
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.maneuver_table import kind_of
from ocs_design.requirement.resolving import Resolved
from ocs_design.robot.robot import Robot
from ocs_design.robot_record import RobotRecord
from ocs_design.simulation.scenario import Run
from ocs_design.sizing.housing import CLEARANCE, WALL
from ocs_design.sizing.incidence import Criterion, heading_drift
from ocs_design.sizing.sized import Sized
from ocs_design.units import format_quantity

if TYPE_CHECKING:
    from ocs_design.sizing.optimal_control.reference import Reference

HOUSING_ASSUMED = (
    f"Housing: PETG, wall {format_quantity(WALL, 'mm')}, {format_quantity(CLEARANCE, 'mm')} clear: "
    f"r_max + {format_quantity(WALL + CLEARANCE, 'mm')}."
)


def record_design(
    robot: Robot,
    resolved: Resolved,
    designed: Designed,
    runs: Sequence[Run],
    *,
    plans: Mapping[str, "Reference"],
    control: ControlRecord | None = None,
    reality: Mapping[str, str] | None = None,
    mounting: Mounting | None,
    warnings: tuple[str, ...] = (),
    seed: int,
    files: Mapping[str, str],
    package_paths: Mapping[str, Path] | None = None,
) -> OcsDesign:
    """The whole artefact."""
    return OcsDesign(
        schema_version=SCHEMA_VERSION,
        tool=Tool(name="ocs-design", version=__version__),
        seed=seed,
        robot=RobotRecord.of(robot, package_paths),
        requirement=_requirement(resolved, designed.sized),
        ocs=_ocs(robot, designed, mounting, warnings),
        sizing=_sizing(designed.sized),
        selection=None if designed.choice is None else record_selection(designed.choice),
        margins=record_margins(resolved, designed, runs, plans),
        validation=tuple(map(record_run, runs)),
        control=control,
        reality=reality or {},
        files=files,
    )


def _requirement(resolved: Resolved, sized: Sized) -> RequirementRecord:
    requirement, speed = resolved.requirement, sized.wheel_speed_max
    roll, pitch = np.max([demand.momentum for demand in sized.demands], axis=0, initial=0.0) / speed
    housing = () if resolved.choice is None else (HOUSING_ASSUMED,)
    return RequirementRecord(
        maneuvers=tuple(_maneuver(maneuver) for maneuver in requirement.maneuvers),
        rate_change=requirement.rate_change,
        wheel_speed_max=speed,
        required_inertia=AxisInertia(pitch=float(pitch), roll=float(roll)),
        spin_inertia_by_hand=requirement.spin_inertia,
        demands=tuple(_demand(demand) for demand in sized.demands),
        assumptions=(*resolved.assumptions, *housing),
    )


def _maneuver(maneuver: Maneuver) -> ManeuverRecord:
    common = {field.name for field in fields(Maneuver)}
    own = {name: value for name, value in asdict(maneuver).items() if name not in common}
    return ManeuverRecord(
        kind=kind_of(maneuver)[0],
        name=maneuver.name,
        gravity=maneuver.gravity,
        incidence=maneuver.incidence,
        parameters=own,
    )


def _demand(demand: SpinDemand) -> DemandRecord:
    roll, pitch = (float(value) for value in demand.momentum)
    return DemandRecord(
        source=demand.source,
        incidence=demand.incidence,
        roll_momentum=roll,
        pitch_momentum=pitch,
        spin_inertia=demand.spin_inertia,
        torque=demand.torque,
    )


def _ocs(
    robot: Robot, designed: Designed, mounting: Mounting | None, warnings: tuple[str, ...]
) -> OcsRecord:
    device, sized = designed.device, designed.sized
    drift = heading_drift(sized.total.inertia)
    left, right = device.modules
    return OcsRecord(
        incidence=device.incidence,
        incidence_criterion=designed.criterion,
        incidence_by_criterion=_by_name(sized.incidence_by_criterion),
        incidence_by_criterion_robot_alone=_by_name(sized.incidence_by_criterion_robot),
        heading_drift=(float(drift[0]), float(drift[1])),
        spin_inertia=device.flywheel.spin_inertia,
        mass_total=device.mass,
        total_mass=sized.total.mass,
        total_inertia=matrix(sized.total.inertia),
        total_com=vector(sized.total.com),
        modules=(
            ModuleRecord(name="left", axis=vector(left.axis), position=vector(left.position)),
            ModuleRecord(name="right", axis=vector(right.axis), position=vector(right.position)),
        ),
        clearance=None if mounting is None else _clearance(mounting.nearest),
        flywheel=device.flywheel,
        motor=device.motor,
        carrier=device.carrier,
        warnings=(*device_warnings(device, robot.mass_properties), *warnings),
        fitting=(*fitting_remarks(device), *footing_remarks(robot, device)),
        mounting=None if mounting is None else _mounting(mounting),
    )


def _mounting(mounting: Mounting) -> MountingRecord:
    return MountingRecord(
        landing=_clearance(mounting.landing),
        reachable=tuple(
            ReachRecord(part=reach.part, joints=dict(reach.joints)) for reach in mounting.reachable
        ),
        com_shift=vector(mounting.com_shift),
        inertia_change=vector(mounting.inertia_change),
    )


def _clearance(clearance: Clearance | None) -> ClearanceRecord | None:
    return None if clearance is None else ClearanceRecord(**asdict(clearance))


def _by_name(angles: Mapping[Criterion, float]) -> Mapping[str, float]:
    return {str(name): float(angle) for name, angle in angles.items()}


def _sizing(sized: Sized) -> SizingRecord:
    return SizingRecord(
        status=sized.status,
        method=sized.method,
        objective=sized.objective,
        binding=sized.binding,
        shadow_prices=dict(sized.shadow_prices),
        gap=sized.gap,
        residual=sized.residual,
        iterations=sized.iterations,
    )
