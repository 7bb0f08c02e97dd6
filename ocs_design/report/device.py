"""The device in the terminal: what is to be built, where it sits, what drives it."""

from collections.abc import Iterator

import numpy as np
from rich.console import Console

from ocs_design.design import Motor
from ocs_design.design_file import OcsDesign, OcsRecord
from ocs_design.drive.gear import DIRECT
from ocs_design.report.layout import columns, facts, heading, items, print_warnings, show
from ocs_design.report.motor_notes import motor_notes
from ocs_design.report.mounting import could_hit, mounted
from ocs_design.report.quantities import (
    degrees,
    grams,
    inertia,
    rpm,
    signed,
    tenths,
)

_OVERRATED = (
    "{motor.name} is rated for {motor.rated_voltage:g} V and fed with {motor.bus_voltage:g} V: its "
    "speed is limited, whether winding and controller bear it is for their makers to say"
)


def print_device(console: Console, design: OcsDesign) -> None:
    """Rim, masses, place, motor and incidences."""
    ocs = design.ocs
    heading(console, "Device: two flywheels" + ("" if ocs.motor.bus_voltage else ", no motors yet"))
    facts(console, device_facts(design))
    print_warnings(console, ocs.warnings)
    items(console, (*cautions(ocs), *motor_notes(design)), style="yellow")
    table = columns("incidence by criterion", "deg", "robot alone")
    for name, angle in ocs.incidence_by_criterion.items():
        before = ocs.incidence_by_criterion_robot_alone.get(name)
        table.add_row(
            name, f"{np.degrees(angle):.2f}", "" if before is None else f"{np.degrees(before):.2f}"
        )
    show(console, table)


def device_facts(design: OcsDesign) -> list[tuple[str, str]]:
    """Names and values: the wheel, the masses, the drive and the place."""
    ocs = design.ocs
    return [*_wheel(design), *_masses(design), *_drive(ocs.motor), *_stand(ocs)]


def _wheel(design: OcsDesign) -> Iterator[tuple[str, str]]:
    ocs, wheel = design.ocs, design.ocs.flywheel
    chosen = ocs.incidence_criterion
    alone = ocs.incidence_by_criterion_robot_alone.get(chosen)
    if alone is not None:
        chosen += f"; {degrees(alone)} for the robot alone"
    outer, inner, height = (
        f"{1e3 * length:.2f}" for length in (wheel.outer_radius, wheel.inner_radius, wheel.height)
    )
    rotor = "" if ocs.motor.rotor_inertia == 0.0 else f", {ocs.motor.rotor_inertia:.2e} its rotor's"
    yield "incidence alpha*", f"{degrees(ocs.incidence, 2)} ({chosen})"
    yield "rim", f"R {outer}  r {inner}  h {height} mm, {wheel.material}"
    if wheel.web is not None:
        web, hub = wheel.web, wheel.web.hub
        sizes = f"{tenths(web.thickness)} mm, hub R {tenths(hub.radius)}  h {tenths(hub.height)} mm"
        yield "web", f"{sizes}, {web.material}"
    yield "spin inertia", f"{inertia(ocs.spin_inertia)} each{rotor}"
    yield "transverse inertia", f"{inertia(wheel.transverse_inertia)} each"


def _masses(design: OcsDesign) -> Iterator[tuple[str, str]]:
    ocs = design.ocs
    share = f"{ocs.mass_total / design.robot.mass:.1%} of the robot"
    parts = {
        "rim": ocs.flywheel.rim_mass,
        "web": 0.0 if ocs.flywheel.web is None else ocs.flywheel.web.mass,
        "motor": ocs.motor.mass,
        "gear": ocs.motor.gear_mass,
        "housing": ocs.carrier.mass - ocs.motor.mass - ocs.motor.gear_mass,
    }
    named = " + ".join(f"{name} {grams(mass)}" for name, mass in parts.items() if mass > 1e-9)
    yield "mass of a module", named
    yield "mass of both", f"{grams(ocs.mass_total)} ({share})"


def _drive(motor: Motor) -> Iterator[tuple[str, str]]:
    yield "motor", f"{motor.name}: {motor.source}"
    if motor.bus_voltage is None:
        return
    if motor.gear != DIRECT.name:
        loss = f"efficiency {motor.gear_efficiency:.0%}"
        yield "gear", f"{motor.gear}, ratio {motor.gear_ratio:.3g}, {loss}"
    limits = [f"{rpm(motor.no_load_speed)} without load at {motor.bus_voltage:g} V"]
    if motor.torque_limit is not None:
        limits.append(f"{motor.torque_limit:.3g} N m at the current limit")
    if motor.speed_max is not None:
        limits.append(f"driven to {rpm(motor.speed_max)} at most")
    yield "drive at the wheel", ", ".join(limits)


def cautions(ocs: OcsRecord) -> tuple[str, ...]:
    """What limbs could hit, what does not fit, and a motor at more volts than it is made for."""
    return (*could_hit(ocs), *ocs.fitting, *overrated(ocs.motor))


def overrated(motor: Motor) -> Iterator[str]:
    """What is to be said of a motor at more volts than it is made for."""
    if motor.bus_voltage is None or motor.rated_voltage is None:
        return
    if motor.bus_voltage > motor.rated_voltage:
        yield _OVERRATED.format(motor=motor)


def _stand(ocs: OcsRecord) -> Iterator[tuple[str, str]]:
    position = ", ".join(map(tenths, ocs.modules[0].position))
    yield "left wheel at", f"{position} mm; the right one mirrored in y"
    yield from mounted(ocs)
    roll, pitch = ocs.heading_drift
    yield (
        "heading drift",
        f"{signed(roll)} rad of yaw per rad of roll, {signed(pitch)} per rad of pitch "
        "(cannot be commanded)",
    )
