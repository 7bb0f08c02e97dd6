"""Margins of a device: the demands of its maneuvers, planned and flown, over its capacity."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.common.units import rpm
from ocs_design.device.joints import SHAFT_JOINT, joints_of, rim_fit
from ocs_design.device.records.flights import Margin
from ocs_design.parts.joints import SERVICE
from ocs_design.requirement.resolving import Resolved
from ocs_design.simulation.run import Run
from ocs_design.sizing.margins import (
    BRAKE_TORQUE,
    BRAKED_RIM,
    BRAKED_SHAFT,
    HOOP_STRESS,
    MOTOR_TORQUE,
    WHEEL_SPEED,
    SampledMotion,
    margins,
    worst,
)
from ocs_design.sizing.sized import Designed

if TYPE_CHECKING:
    from ocs_design.sizing.trajectory.plans import Reference


def record_margins(
    resolved: Resolved,
    designed: Designed,
    runs: Sequence[Run],
    plans: Mapping[str, "Reference"],
) -> tuple[Margin, ...]:
    """Worst of each margin over all maneuvers, as planned and as flown until the run ends.

    Args:
        resolved: what was specified. designed: the device.
        runs: flights; those without the device are ignored. A run begins at push-off.
        plans: references of the maneuvers, by name.
    """
    if designed.choice is None:
        device_margins = tuple(_margins_without_motor(resolved, designed, runs))
    else:
        wheel = designed.choice.chosen
        maneuvers = {maneuver.name: maneuver for maneuver in resolved.requirement.maneuvers}
        driven = (
            (name, margins(motion, designed.device.as_flown(maneuvers[name]).axes, wheel))
            for name, motion in _motions(plans, runs)
        )
        braked = _brake_margins(resolved, designed, plans)
        device_margins = (*worst((*driven, *braked)), *joints_of(designed.device))
    flywheel, envelope = designed.device.flywheel, resolved.envelope
    envelope_margins = (
        Margin("outer radius", flywheel.outer_radius, envelope.outer_radius_max, "m"),
        Margin("height", flywheel.height, envelope.height_max, "m"),
        Margin("rim mass", flywheel.rim_mass, envelope.mass_max, "kg"),
    )
    return (*device_margins, *envelope_margins)


def _motions(
    plans: Mapping[str, "Reference"], runs: Sequence[Run]
) -> Iterator[tuple[str, SampledMotion]]:
    """Each plan; then each run, once from its start to its end and once from lift-off to touchdown.

    The drive must also bear the landing, and the damping after it. Means over time are taken over
    the maneuver alone: on the ground a motor has time to cool.
    """
    for name, reference in plans.items():
        if reference.trajectory is None:
            continue
        motion = SampledMotion.along(reference.trajectory)
        yield name, motion
        if reference.braked_speed:
            # All wheels run at up to this speed before the brake stops them in an instant.
            wheels = np.full((2, motion.wheel_speed.shape[1]), reference.braked_speed)
            still = np.zeros((2, 3))
            yield name, SampledMotion(np.array([0.0, 1e-3]), wheels, 0.0 * wheels, still, still)
    for run in runs:
        if not run.ocs or run.metrics is None:
            continue
        series = run.series
        lift_off_time = run.metrics.lift_off_time
        touchdown_time = run.metrics.touchdown_time
        lift_off = np.inf if lift_off_time is None else lift_off_time
        touchdown = np.inf if touchdown_time is None else touchdown_time
        in_the_air = (series.time >= lift_off) & (series.time <= touchdown)
        for part in (np.full(series.time.shape, True), in_the_air):
            if np.count_nonzero(part) > 1:
                yield (
                    run.scenario,
                    SampledMotion.flown(
                        series.time[part],
                        series.wheel_speed[part],
                        series.wheel_torque[part],
                        series.rate[part],
                    ),
                )


def _brake_margins(
    resolved: Resolved, designed: Designed, plans: Mapping[str, "Reference"]
) -> Iterator[tuple[str, tuple[Margin, ...]]]:
    """Demands on the wheels and their joints of a brake that grips the wheels, as the Cubli's."""
    device, drive = designed.device, designed.device.motor
    shaft = next((joint for joint in joints_of(device) if joint.name == SHAFT_JOINT), None)
    fit = rim_fit(device)
    for maneuver in resolved.requirement.maneuvers:
        plan = plans.get(maneuver.name)
        if plan is None or not plan.braked_speed:
            continue
        deceleration = plan.braked_speed / maneuver.braking_time
        where = f"from {rpm(plan.braked_speed)} in {1e3 * maneuver.braking_time:.2g} ms"
        wheel = device.flywheel.spin_inertia * deceleration
        rotor = SERVICE * (abs(drive.rotor_inertia) + drive.armature) * deceleration
        rows = [
            Margin(
                BRAKE_TORQUE, wheel, None, "N m", note=f"on each wheel and what holds it, {where}"
            ),
        ]
        if shaft is not None:
            note = f"{SERVICE:g} x the torque that stops the rotor, {where}, braked at the wheel"
            rows.append(Margin(BRAKED_SHAFT, rotor, shaft.capacity, "N m", note=note))
        if fit is not None:
            note = f"{SERVICE:g} x the brake torque, if the brake does not grip the rim itself"
            rows.append(Margin(BRAKED_RIM, SERVICE * wheel, fit.torque, "N m", note=note))
        yield maneuver.name, tuple(rows)


def _margins_without_motor(
    resolved: Resolved, designed: Designed, runs: Sequence[Run]
) -> Iterator[Margin]:
    """Margins that are known without a motor's figures."""
    device, wheel = designed.device, designed.device.flywheel
    driven = [run for run in runs if run.ocs and run.metrics is not None]
    limit = device.motor.torque_limit
    least_torque = max((demand.torque for demand in designed.sized.demands), default=0.0)
    if driven:
        speeds, torques = (
            [float(np.abs(getattr(run.series, name)).max()) for run in driven]
            for name in ("wheel_speed", "wheel_torque")
        )
        speed, torque = int(np.argmax(speeds)), int(np.argmax(torques))
        capacity, at = resolved.requirement.wheel_speed_max, "at the wheel"
        names = [run.scenario for run in driven]
        yield Margin(WHEEL_SPEED, speeds[speed], capacity, "rad/s", scenario=names[speed])
        yield Margin(MOTOR_TORQUE, torques[torque], limit, "N m", note=at, scenario=names[torque])
    elif least_torque > 0.0:
        yield Margin(
            MOTOR_TORQUE,
            least_torque,
            limit,
            "N m",
            note="the least that completes the maneuvers in time",
        )
    if wheel.hoop_stress is not None:
        strength = resolved.material.yield_strength
        yield Margin(HOOP_STRESS, wheel.hoop_stress, strength, "Pa")
