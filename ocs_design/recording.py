"""From live values to the records of `design.json`."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields

import numpy as np

from ocs_design import __version__
from ocs_design.design import Device
from ocs_design.design_file import (
    SCHEMA_VERSION,
    AxisInertia,
    ClearanceRecord,
    DemandRecord,
    ManeuverRecord,
    MarginRecord,
    ModuleRecord,
    OcsDesign,
    OcsRecord,
    RequirementRecord,
    RobotRecord,
    SizingRecord,
    Tool,
    ValidationRecord,
    matrix,
    vector,
)
from ocs_design.requirement.bound import SpinDemand
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.resolving import Resolved
from ocs_design.robot.robot import Robot
from ocs_design.simulation.clearance import Clearance
from ocs_design.simulation.scenario import Run
from ocs_design.sizing.device_sizing import DeviceSizing
from ocs_design.sizing.incidence import Criterion, heading_drift

BY_HAND = "by hand"
"""Criterion of an incidence, or source of a spin inertia, that the user gave."""


def record_design(
    robot: Robot,
    resolved: Resolved,
    sizing: DeviceSizing,
    device: Device,
    runs: Sequence[Run],
    *,
    clearance: Clearance | None,
    criterion: str,
    seed: int,
    files: Mapping[str, str],
) -> OcsDesign:
    """The whole artefact."""
    return OcsDesign(
        schema_version=SCHEMA_VERSION,
        tool=Tool(name="ocs-design", version=__version__),
        seed=seed,
        robot=RobotRecord.of(robot),
        requirement=_requirement(resolved, sizing),
        ocs=_ocs(sizing, device, clearance, criterion),
        sizing=_sizing(sizing),
        margins=tuple(_margins(resolved, sizing, device, runs)),
        validation=tuple(_validation(run) for run in runs),
        files=files,
    )


def _requirement(resolved: Resolved, sizing: DeviceSizing) -> RequirementRecord:
    requirement = resolved.requirement
    speed = requirement.wheel_speed_max
    roll, pitch = (
        np.max([demand.momentum for demand in sizing.demands], axis=0, initial=0.0) / speed
    )
    return RequirementRecord(
        maneuvers=tuple(_maneuver(maneuver) for maneuver in requirement.maneuvers),
        rate_change=requirement.rate_change,
        wheel_speed_max=requirement.wheel_speed_max,
        required_inertia=AxisInertia(pitch=float(pitch), roll=float(roll)),
        spin_inertia_by_hand=requirement.spin_inertia,
        demands=tuple(_demand(demand) for demand in sizing.demands),
        assumptions=resolved.assumptions,
    )


def _maneuver(maneuver: Maneuver) -> ManeuverRecord:
    common = {field.name for field in fields(Maneuver)}
    own = {name: value for name, value in asdict(maneuver).items() if name not in common}
    return ManeuverRecord(
        kind=type(maneuver).__name__.lower(),
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
    sizing: DeviceSizing, device: Device, clearance: Clearance | None, criterion: str
) -> OcsRecord:
    drift = heading_drift(sizing.total.inertia)
    left, right = device.modules
    return OcsRecord(
        incidence=device.incidence,
        incidence_criterion=criterion,
        incidence_by_criterion=_by_name(sizing.incidence_by_criterion),
        incidence_by_criterion_robot_alone=_by_name(sizing.incidence_by_criterion_robot),
        heading_drift=(float(drift[0]), float(drift[1])),
        spin_inertia=device.flywheel.spin_inertia,
        mass_total=2.0 * (device.flywheel.mass + device.motor.mass),
        total_mass=sizing.total.mass,
        total_inertia=matrix(sizing.total.inertia),
        total_com=vector(sizing.total.com),
        modules=(
            ModuleRecord(name="left", axis=vector(left.axis), position=vector(left.position)),
            ModuleRecord(name="right", axis=vector(right.axis), position=vector(right.position)),
        ),
        clearance=None if clearance is None else ClearanceRecord(**asdict(clearance)),
        flywheel=device.flywheel,
        motor=device.motor,
    )


def _by_name(angles: Mapping[Criterion, float]) -> Mapping[str, float]:
    return {str(name): float(angle) for name, angle in angles.items()}


def _sizing(sizing: DeviceSizing) -> SizingRecord:
    rim = sizing.rim
    return SizingRecord(
        status=rim.status,
        method=rim.method,
        objective=rim.mass,
        binding=rim.binding,
        shadow_prices=dict(rim.shadow_prices),
        gap=rim.gap,
        residual=sizing.residual,
        iterations=sizing.iterations,
    )


def _margins(
    resolved: Resolved, sizing: DeviceSizing, device: Device, runs: Sequence[Run]
) -> list[MarginRecord]:
    wheel, requirement, envelope = device.flywheel, resolved.requirement, resolved.envelope
    driven = [run.metrics for run in runs if run.ocs and run.metrics is not None]
    found = []
    if driven:
        speed = max(metrics.peak_wheel_speed for metrics in driven)
        torque = max(metrics.peak_wheel_torque for metrics in driven)
        found.append(_margin("wheel speed in flight", speed, requirement.wheel_speed_max, "rad/s"))
        found.append(_margin("wheel torque in flight", torque, device.motor.torque_limit, "N m"))
    least = max((demand.torque for demand in sizing.demands), default=0.0)
    if least > 0.0:
        found.append(_margin("wheel torque, least", least, device.motor.torque_limit, "N m"))
    if wheel.hoop_stress is not None:
        strength = resolved.material.yield_strength
        found.append(_margin("hoop stress, to yield", wheel.hoop_stress, strength, "Pa"))
    found.append(_margin("outer radius", wheel.outer_radius, envelope.outer_radius_max, "m"))
    found.append(_margin("height", wheel.height, envelope.height_max, "m"))
    found.append(_margin("rim mass", wheel.mass, envelope.mass_max, "kg"))
    return found


def _margin(name: str, demand: float, capacity: float | None, unit: str) -> MarginRecord:
    factor = None if capacity is None or demand == 0.0 else capacity / demand
    return MarginRecord(name=name, demand=demand, capacity=capacity, unit=unit, margin=factor)


def _validation(run: Run) -> ValidationRecord:
    return ValidationRecord(
        scenario=run.scenario,
        ocs=run.ocs,
        passed=run.passed,
        reason=run.reason,
        note=run.note,
        metrics={} if run.metrics is None else asdict(run.metrics),
    )
