"""From a sizing or a selection to the device that is exported and simulated."""

import math
from dataclasses import replace

from ocs_design.arrays import FloatArray
from ocs_design.catalogue.materials import Material
from ocs_design.design import SIDES, Device, Flywheel, Module, Motor, Web
from ocs_design.drive.gear import DIRECT
from ocs_design.drive.line import DriveLine, armature, rotor_share
from ocs_design.requirement.resolving import Resolved
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.cylinder import hoop_stress, stored_energy
from ocs_design.sizing.device_sizing import DeviceSizing
from ocs_design.sizing.incidence import module_axes
from ocs_design.sizing.margins.driven_wheel import DrivenWheel
from ocs_design.sizing.rim_cuts import NO_CUTS, RimCuts
from ocs_design.sizing.selection.result import Candidate
from ocs_design.sizing.web import (
    WEB_DENSITY,
    WEB_MATERIAL,
    WEB_THICKNESS,
    Hub,
    web_mass,
    wheel_body,
)


def assemble(sizing: DeviceSizing, resolved: Resolved) -> Device:
    """Two modules at the sized places, each with the sized wheel and the assumed motor."""
    rim, speed = sizing.rim, resolved.requirement.wheel_speed_max
    cylinder = (rim.inner_radius, rim.outer_radius, rim.height)
    flywheel = _flywheel(cylinder, resolved.material, speed, rotor_share=0.0)
    return Device(
        sizing.incidence,
        _modules(sizing.incidence, sizing.centers),
        # To the last digit what was minimised.
        replace(flywheel, mass=rim.mass),
        _assumed_motor(resolved),
    )


def assemble_selected(candidate: Candidate, bus_voltage: float) -> Device:
    """Two modules as they were selected, fed at `bus_voltage` [V]."""
    wheel = DrivenWheel(
        candidate.inner_radius,
        candidate.outer_radius,
        candidate.height,
        candidate.material,
        candidate.motor,
        candidate.gear,
        bus_voltage,
        hub=candidate.hub,
        cuts=candidate.cuts,
    )
    return assemble_driven(
        wheel, candidate.carrier, candidate.incidence, candidate.centers, candidate.line
    )


def assemble_driven(
    wheel: DrivenWheel,
    carrier: Carrier,
    incidence: float,
    centers: FloatArray,
    line: DriveLine | None = None,
) -> Device:
    """Two modules with a motor of the catalogue each.

    Args:
        wheel: rim, motor, gear and supply of each.
        carrier: what of each stands still.
        incidence: of the wheel axes [rad].
        centers: of the left and the right wheel in B [m], shape (2, 3).
        line: what the drive may do at the wheel; None: all that motor and gear can.

    Raises:
        OcsError: the motor lacks a figure that every drive needs.
    """
    cylinder = (wheel.inner_radius, wheel.outer_radius, wheel.height)
    motor = _driven_motor(wheel, wheel.line if line is None else line)
    speed = min(motor.no_load_speed, motor.speed_max or math.inf)
    return Device(
        incidence,
        _modules(incidence, centers),
        _flywheel(cylinder, wheel.material, speed, motor.rotor_inertia, wheel.hub, cuts=wheel.cuts),
        motor,
        carrier,
    )


def _driven_motor(wheel: DrivenWheel, line: DriveLine) -> Motor:
    """What a motor of the catalogue does at its wheel behind its gear, at the bus voltage."""
    motor, gear = wheel.motor, wheel.gear
    rotor, gain = motor.rotor_inertia or 0.0, gear.ratio * gear.efficiency
    return Motor(
        name=motor.name,
        mass=motor.mass or 0.0,
        stall_torque=_finite(float(line.stall_torque)),
        no_load_speed=float(line.no_load_speed),
        torque_limit=_finite(float(line.torque_limit)),
        rotor_inertia=rotor_share(rotor, gear),
        source=motor.source,
        gear=gear.name,
        gear_ratio=gear.ratio,
        gear_efficiency=gear.efficiency,
        gear_mass=gear.mass,
        bus_voltage=wheel.bus_voltage,
        rated_voltage=motor.rated_voltage,
        diameter=motor.diameter,
        length=motor.length,
        speed_max=_finite(float(line.speed_max)),
        armature=armature(rotor, gear),
        torque_constant=motor.torque_constant,
        resistance=motor.resistance,
        continuous_torque=_geared(motor.continuous_torque, gain),
        mounting=motor.mounting if gear == DIRECT else None,
        no_load_current=motor.no_load_current,
        gear_room=gear.room,
        saturation_torque=_geared(motor.saturation_torque, gain),
    )


def _geared(torque: float | None, gain: float) -> float | None:
    """At the wheel; None if it is not known."""
    return None if torque is None else gain * torque


def _modules(incidence: float, centers: FloatArray) -> tuple[Module, Module]:
    left, right = (
        Module(name, axis, center)
        for name, axis, center in zip(SIDES, module_axes(incidence).T, centers, strict=True)
    )
    return left, right


def _flywheel(
    cylinder: tuple[float, float, float],
    material: Material,
    wheel_speed: float,
    rotor_share: float,
    hub: Hub | None = None,
    *,
    cuts: RimCuts = NO_CUTS,
) -> Flywheel:
    """Of the rim's inner and outer radius and height [m], with what the rotor adds [kg m^2]."""
    inner, outer, height = cylinder
    stress = _hoop_stress(inner, outer, material, wheel_speed)
    body = wheel_body(*cylinder, material.density, hub, cuts=cuts)
    spin_inertia = body.axial_inertia + rotor_share
    return Flywheel(
        inner_radius=inner,
        outer_radius=outer,
        height=height,
        material=material.name,
        density=material.density,
        mass=body.mass,
        spin_inertia=spin_inertia,
        transverse_inertia=body.transverse_inertia,
        hoop_stress=stress,
        stress_margin=_ratio(material.yield_strength, stress),
        stored_energy=float(stored_energy(spin_inertia, wheel_speed)),
        web=None if hub is None else _web(inner, hub),
        cuts=cuts,
    )


def _web(bore: float, hub: Hub) -> Web:
    mass = web_mass(bore) + hub.mass
    return Web(WEB_MATERIAL, WEB_DENSITY, WEB_THICKNESS, mass, hub)


def _assumed_motor(resolved: Resolved) -> Motor:
    """No motor is chosen yet: the speed limit, and a torque limit if one was given."""
    return Motor(
        name="assumed",
        mass=0.0,
        stall_torque=None,
        no_load_speed=resolved.requirement.wheel_speed_max,
        torque_limit=resolved.torque_max,
        rotor_inertia=0.0,
        source="no motor is chosen; highest speed and torque as assumed or stated",
    )


def _hoop_stress(
    inner_radius: float, outer_radius: float, material: Material, wheel_speed: float
) -> float | None:
    if material.poisson_ratio is None:
        return None
    return float(
        hoop_stress(
            inner_radius,
            outer_radius,
            density=material.density,
            poisson_ratio=material.poisson_ratio,
            wheel_speed=wheel_speed,
        )
    )


def _ratio(capacity: float | None, demand: float | None) -> float | None:
    return None if capacity is None or demand is None else capacity / demand


def _finite(limit: float) -> float | None:
    """None for what is not limited."""
    return limit if math.isfinite(limit) else None
