"""Check that the figures of a design agree with each other.

`size` computes masses from dimensions and writes both. Files made from a `design.json` use one or
the other: after an edit of a single key, a wheel would have different masses on its drawing and in
the bill of materials. So all masses, inertias and limits of a design are computed again, by the
functions with which it was sized.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ocs_design import __version__
from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.materials import recorded_material
from ocs_design.common.errors import OcsError
from ocs_design.common.units import format_quantity
from ocs_design.device.device import Device
from ocs_design.device.records.design import OcsDesign
from ocs_design.parts.module import carrier_of
from ocs_design.parts.motor_mount import hub_of
from ocs_design.parts.rim import HoleRing, hoop_stress, stored_energy, wheel_body
from ocs_design.robot.mass import MassProperties

ROUNDING = 1e-8
"""Difference, relative to the largest of the figures compared, that counts as rounding; files have
full precision."""

_LEAST_SIZE = {"m": 1e-2}
"""Smallest magnitude, by unit, relative to which rounding is measured [m]."""

_MOST_LISTED = 2
"""Largest number of contradictions in a message."""


class _Figure(NamedTuple):
    """A figure of a design, and the value that follows from others of the same design.

    Attributes:
        key: in `design.json`. recorded: value there. computed: value from the others.
        unit: of both; empty: words or plain numbers.
        basis: text on the figures from which `computed` follows.
    """

    key: str
    recorded: object
    computed: object
    unit: str
    basis: str

    @property
    def agrees(self) -> bool:
        """Whether both are equal except for rounding."""
        if isinstance(self.computed, str) or self.recorded is None:
            return self.recorded == self.computed
        recorded, computed = (
            np.ravel(np.asarray(value, float)) for value in (self.recorded, self.computed)
        )
        if recorded.shape != computed.shape:
            return False
        size = max(np.abs(computed).max(initial=0.0), _LEAST_SIZE.get(self.unit, 0.0))
        return bool((np.abs(recorded - computed) <= ROUNDING * size).all())

    def __str__(self) -> str:
        """Text on the recorded value and the one that it should be."""
        recorded, computed = (_text(value, self.unit) for value in (self.recorded, self.computed))
        return f"{self.key} is {recorded}, but {self.basis} {computed}"


def _text(value: object, unit: str) -> str:
    """A figure as text; the rows of a matrix one after the other."""
    if value is None:
        return "null"
    if isinstance(value, str):
        return repr(value)
    figures = np.ravel(np.asarray(value, float)).tolist()
    if unit == "kg":
        return format_quantity(figures[0], "g")
    text = ", ".join(f"{figure:.4g}" for figure in figures)
    return f"{text if len(figures) == 1 else f'({text})'} {unit}".rstrip()


def check_agreement(design: OcsDesign, device: Device) -> None:
    """Refuse a design whose figures contradict each other.

    Args:
        design: as written. device: device that it describes, already checked (`check_device`).

    Raises:
        OcsError: names the first contradictions, each with its key.
    """
    faults: list[str] = []
    try:
        with np.errstate(all="ignore"):
            faults.extend(str(figure) for figure in _figures(design, device) if not figure.agrees)
    except (ArithmeticError, ValueError):
        faults.append("with these dimensions the rest cannot be computed")
    if faults:
        rest = len(faults) - _MOST_LISTED
        more = f"; and {rest} more" if rest > 0 else ""
        raise OcsError(
            f"the design contradicts itself: {'; '.join(faults[:_MOST_LISTED])}{more}",
            hint="design.json is an output of `ocs-design size`, not an input: change the "
            "specification, and run `ocs-design size` again",
        )


def _figures(design: OcsDesign, device: Device) -> Iterator[_Figure]:
    """Figures that follow from others of the design, the smallest part first."""
    yield from _selection_figures(design)
    yield from _drive_figures(device)
    yield from _limit_figures(design, device)
    yield from _wheel_figures(design, device)
    # Another version may build the stationary parts differently; the bill of materials reports the
    # difference.
    if design.tool.version == __version__ and design.ocs.center_of_mass is not None:
        yield from _carrier_figures(device)
    ocs, angle = design.ocs, "ocs.incidence gives"
    for module, axis in zip(device.modules, device.layout.axes(device.incidence).T, strict=True):
        yield _Figure(f"the axis of module {module.name}", module.axis, axis, "", angle)
    parts = "its parts weigh"
    yield _Figure("ocs.spin_inertia", ocs.spin_inertia, device.flywheel.spin_inertia, "kg m^2",
                  "ocs.flywheel's is")  # fmt: skip
    yield _Figure("ocs.mass_total", ocs.mass_total, device.mass, "kg", parts)
    robot = design.robot
    bare_robot = MassProperties(robot.mass, np.array(robot.com), np.array(robot.inertia))
    total = device.on(bare_robot)
    places = "positions and masses of ocs.modules and their supports give"
    if ocs.center_of_mass is not None:
        com = (total.mass * total.com - bare_robot.mass * bare_robot.com) / device.mass
        yield _Figure("ocs.center_of_mass", ocs.center_of_mass, com, "m", places)
    yield _Figure("ocs.total_mass", ocs.total_mass, total.mass, "kg", "robot and device weigh")
    yield _Figure("ocs.total_com", ocs.total_com, total.com, "m", places)
    yield _Figure("ocs.total_inertia", ocs.total_inertia, total.inertia, "kg m^2", places)


def _selection_figures(design: OcsDesign) -> Iterator[_Figure]:
    """Names and voltage, which the record of the selection repeats."""
    motor, selection = design.ocs.motor, design.selection
    if selection is None:
        return
    best, first = selection.ranking[0], "the first entry of selection.ranking has"
    yield _Figure("ocs.motor.name", motor.name, best.motor, "", first)
    yield _Figure("ocs.motor.gear", motor.gear, best.gear, "", first)
    yield _Figure("ocs.motor.gear_ratio", motor.gear_ratio, best.gear_ratio, "", first)
    yield _Figure("ocs.flywheel.material", design.ocs.flywheel.material, best.material, "", first)
    voltage = "selection.bus_voltage is"
    bus_voltage = motor.bus_voltage or 0.0
    yield _Figure("ocs.motor.bus_voltage", bus_voltage, selection.bus_voltage, "V", voltage)
    if design.supply is not None:
        yield _Figure("supply.voltage", design.supply.voltage, selection.bus_voltage, "V", voltage)


def _drive_figures(device: Device) -> Iterator[_Figure]:
    """Figures of the voltage line (`actuation.drive`)."""
    motor = device.motor
    voltage, k_t, resistance = motor.bus_voltage, motor.torque_constant, motor.resistance
    if voltage is None or k_t is None:
        return
    speed, line = voltage / (k_t * motor.gear_ratio), "voltage, winding and gear give"
    yield _Figure("ocs.motor.no_load_speed", motor.no_load_speed, speed, "rad/s", line)
    stall, gain = motor.stall_torque, motor.gear_ratio * motor.gear_efficiency * voltage * k_t
    if resistance is not None:
        yield _Figure("ocs.motor.stall_torque", stall, gain / resistance, "N m", line)
    elif stall is not None:
        drop = "voltage, stall torque and gear give"
        yield _Figure("ocs.motor.resistance", resistance, gain / stall, "ohm", drop)
    # The rotor's share is s N J_r; of the armature, N (N - s) J_r + J_gear, the file lacks J_gear.
    ratio, sense = motor.gear_ratio, -1.0 if motor.rotor_inertia < 0.0 else 1.0
    least = (sense * ratio - 1.0) * motor.rotor_inertia
    own = least if motor.gear == DIRECT.name else max(motor.armature, least)
    at_least = "rotor and gear give at least"
    yield _Figure("ocs.motor.armature", motor.armature, own, "kg m^2", at_least)


def _limit_figures(design: OcsDesign, device: Device) -> Iterator[_Figure]:
    """Limits of drive and supply, which are also the capacities of margins, where there are any.

    Flights obey the former, and are judged by the latter.
    """
    motor, supply = device.motor, design.supply
    capacities = {margin.name: margin.capacity for margin in design.margins}
    limits = {
        "ocs.motor.torque_limit": ("motor torque", motor.torque_limit, motor.friction, "N m"),
        "ocs.motor.speed_max": ("wheel speed", motor.speed_max, 0.0, "rad/s"),
    }
    limits |= {
        f"supply.{key}": (f"bus {name}", getattr(supply, key, None), 0.0, unit)
        for key, name, unit in (("current_max", "current", "A"), ("power_max", "power", "W"))
    }
    for key, (name, limit, friction, unit) in limits.items():
        capacity = capacities.get(name)
        if capacity is not None and motor.bus_voltage is not None:
            basis = f"the capacity of {name} in margins gives"
            yield _Figure(key, limit, capacity - friction, unit, basis)


def _wheel_figures(design: OcsDesign, device: Device) -> Iterator[_Figure]:
    """Masses, inertias, energy and stress of the wheel."""
    wheel, motor, sizes = device.flywheel, device.motor, "its dimensions give"
    web, hub, web_density = wheel.web, None, wheel.density
    if web is not None:
        # Version 1 stored the thickness only beside the hub.
        hub, web_density = replace(web.hub, web_thickness=web.thickness), web.density
        mass = hub.mass_with_web(wheel.inner_radius, web_density)
        yield _Figure("ocs.flywheel.web.mass", web.mass, mass, "kg", sizes)
        holes = _hole_sizes(web.holes), _hole_sizes(hub.holes(wheel.inner_radius))
        yield _Figure("ocs.flywheel.web.holes", *holes, "", sizes)
    rim = wheel.inner_radius, wheel.outer_radius, wheel.height, wheel.density
    body = wheel_body(*rim, hub, cuts=wheel.cuts, web_density=web_density)
    spin, unit = body.axial_inertia + motor.rotor_inertia, "kg m^2"
    stated, transverse = wheel.transverse_inertia, body.transverse_inertia
    yield _Figure("ocs.flywheel.mass", wheel.mass, body.mass, "kg", sizes)
    yield _Figure("ocs.flywheel.spin_inertia", wheel.spin_inertia, spin, unit, sizes)
    yield _Figure("ocs.flywheel.transverse_inertia", stated, transverse, unit, sizes)
    energy, speed = stored_energy(spin, motor.top_speed), "inertia and top speed give"
    yield _Figure("ocs.flywheel.stored_energy", wheel.stored_energy, energy, "J", speed)
    material = recorded_material(wheel.material)
    if wheel.hoop_stress is None or material is None or material.poisson_ratio is None:
        return
    stress = hoop_stress(
        wheel.inner_radius,
        wheel.outer_radius,
        density=wheel.density,
        poisson_ratio=material.poisson_ratio,
        wheel_speed=motor.top_speed,
    )
    basis = "dimensions, material and top speed give"
    yield _Figure("ocs.flywheel.hoop_stress", wheel.hoop_stress, stress, "Pa", basis)
    # The strength that its margins state: the catalogue's may have been corrected since.
    strength = material.yield_strength
    for limit in design.margins:
        if limit.name.startswith("hoop stress"):
            strength = limit.capacity
    if wheel.stress_margin is not None and strength is not None:
        margin = strength / stress
        yield _Figure("ocs.flywheel.stress_margin", wheel.stress_margin, margin, "", basis)


def _hole_sizes(holes: HoleRing | None) -> tuple[float, ...]:
    """Number and radii of holes [m]; empty without any."""
    return () if holes is None else (holes.count, holes.circle_radius, holes.hole_radius)


def _carrier_figures(device: Device) -> Iterator[_Figure]:
    """Figures of the stationary parts around each wheel, and of the hub on the motor."""
    motor, wheel, recorded = device.motor, device.flywheel, device.carrier
    web = wheel.web
    if web is not None:
        hub = hub_of(
            motor.mounting,
            motor.diameter,
            chamfer=wheel.cuts.chamfer,
            web_thickness=web.thickness,
            lightening=web.hub.lightening,
        )
        for name, value in vars(hub).items():
            key = f"ocs.flywheel.web.hub.{name}"
            yield _Figure(key, getattr(web.hub, name), value, "", "the motor's mounting gives")
    if recorded.mass == 0.0:
        return
    gear = replace(DIRECT, mass=motor.gear_mass, room=motor.gear_room)
    computed = carrier_of(
        motor,
        gear,
        wheel.outer_radius,
        wheel.height,
        device.guard_wall,
        foot_plate=device.foot_plate,
        on_bell=device.on_bell,
    )
    parts = "motor, gear, housing and foot give"
    yield _Figure("ocs.carrier.mass", recorded.mass, computed.mass, "kg", parts)
    foot = device.foot
    for pedestal in device.pedestals:
        sizes = pedestal.base_radius, pedestal.slot_radius, pedestal.wheel_height
        foot_sizes = foot.base_radius, foot.slot_radius, foot.wheel_height
        key = f"base_radius, slot_radius and wheel_height of ocs.pedestals {pedestal.module}"
        yield _Figure(key, sizes, foot_sizes, "m", "the foot on it gives")
    places = (recorded.along, recorded.up), (computed.along, computed.up)
    yield _Figure("ocs.carrier.along and up", *places, "m", parts)
    yield _Figure("the inertia of ocs.carrier", recorded.inertia, computed.inertia, "kg m^2", parts)
