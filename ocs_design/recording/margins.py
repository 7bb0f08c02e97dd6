"""Demand against capacity of everything that a design rests on."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.design import Device
from ocs_design.design_file import MarginRecord
from ocs_design.designing import Choice, Designed
from ocs_design.requirement.resolving import Resolved
from ocs_design.simulation.scenario import Run
from ocs_design.sizing.margins.driven_wheel import DrivenWheel
from ocs_design.sizing.margins.margin import Margin, worst
from ocs_design.sizing.margins.margins import HOOP_STRESS, margins
from ocs_design.sizing.margins.motion import Motion

if TYPE_CHECKING:
    from ocs_design.sizing.optimal_control.reference import Reference


def record_margins(
    resolved: Resolved,
    designed: Designed,
    runs: Sequence[Run],
    plans: Mapping[str, "Reference"],
) -> tuple[MarginRecord, ...]:
    """The worst over all maneuvers, as flown, or as planned where nothing was flown."""
    if designed.choice is None:
        found = tuple(_without_motor(resolved, designed, runs))
    else:
        motions = _flown(runs) or _planned(plans)
        found = _of_drive(designed.choice, designed.device, resolved, motions)
    return (*map(_record, found), *map(_record, _room(resolved, designed.device)))


def _flown(runs: Sequence[Run]) -> dict[str, Motion]:
    """From lift-off to touchdown; push-off and landing are no part of a maneuver."""
    motions = {}
    for run in runs:
        if not run.ocs or run.metrics is None:
            continue
        series, left, landed = run.series, run.metrics.lift_off_time, run.metrics.touchdown_time
        begun = np.inf if left is None else left
        ended = np.inf if landed is None else landed
        flight = (series.time >= begun) & (series.time <= ended)
        if series.time[flight].size > 1:
            motions[run.scenario] = Motion.flown(
                series.time[flight],
                series.wheel_speed[flight],
                series.wheel_torque[flight],
                series.rate[flight],
            )
    return motions


def _planned(plans: Mapping[str, "Reference"]) -> dict[str, Motion]:
    return {
        name: Motion.along(plan.trajectory)
        for name, plan in plans.items()
        if plan.trajectory is not None
    }


def _of_drive(
    choice: Choice, device: Device, resolved: Resolved, motions: Mapping[str, Motion]
) -> tuple[Margin, ...]:
    chosen, stated = choice.chosen, choice.problem.wheel_speed_max
    wheel = DrivenWheel(
        chosen.inner_radius,
        chosen.outer_radius,
        chosen.height,
        chosen.material,
        chosen.motor,
        chosen.gear,
        choice.problem.bus_voltage,
        float("inf") if stated is None else stated,
        chosen.hub,
        chosen.cuts,
    )
    maneuvers = {maneuver.name: maneuver for maneuver in resolved.requirement.maneuvers}
    return worst(
        {
            name: margins(motion, device.as_flown(maneuvers[name]).axes, wheel)
            for name, motion in motions.items()
        }
    )


def _without_motor(resolved: Resolved, designed: Designed, runs: Sequence[Run]) -> Iterator[Margin]:
    """What can be said without a motor's figures."""
    device, wheel = designed.device, designed.device.flywheel
    driven = [run.metrics for run in runs if run.ocs and run.metrics is not None]
    limit = device.motor.torque_limit
    if driven:
        speed = max(metrics.peak_wheel_speed for metrics in driven)
        torque = max(metrics.peak_wheel_torque for metrics in driven)
        capacity = resolved.requirement.wheel_speed_max
        yield Margin("wheel speed in flight", speed, capacity, "rad/s")
        yield Margin("wheel torque in flight", torque, limit, "N m")
    least = max((demand.torque for demand in designed.sized.demands), default=0.0)
    if least > 0.0:
        yield Margin("wheel torque, least", least, limit, "N m")
    if wheel.hoop_stress is not None:
        strength = resolved.material.yield_strength
        yield Margin(HOOP_STRESS, wheel.hoop_stress, strength, "Pa")


def _room(resolved: Resolved, device: Device) -> Iterator[Margin]:
    wheel, envelope = device.flywheel, resolved.envelope
    yield Margin("outer radius", wheel.outer_radius, envelope.outer_radius_max, "m")
    yield Margin("height", wheel.height, envelope.height_max, "m")
    yield Margin("rim mass", wheel.rim_mass, envelope.mass_max, "kg")


def _record(margin: Margin) -> MarginRecord:
    return MarginRecord(
        name=margin.name,
        demand=margin.demand,
        capacity=margin.capacity,
        unit=margin.unit,
        margin=margin.factor,
        maneuver=margin.maneuver,
        note=margin.note,
    )
