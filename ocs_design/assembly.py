"""From a sizing to the device that is exported and simulated."""

from ocs_design.catalogue.materials import Material
from ocs_design.design import Device, Flywheel, Module, Motor
from ocs_design.requirement.resolving import Resolved
from ocs_design.sizing.cylinder import hoop_stress, stored_energy
from ocs_design.sizing.device_sizing import DeviceSizing
from ocs_design.sizing.incidence import module_axes


def assemble(sizing: DeviceSizing, resolved: Resolved) -> Device:
    """Two modules at the sized places, each with the sized wheel and the assumed motor."""
    axes = module_axes(sizing.incidence)
    left, right = (
        Module(name, axis, center)
        for name, axis, center in zip(("left", "right"), axes.T, sizing.centers, strict=True)
    )
    flywheel = _flywheel(sizing, resolved.material, resolved.requirement.wheel_speed_max)
    return Device(sizing.incidence, (left, right), flywheel, _assumed_motor(resolved))


def _flywheel(sizing: DeviceSizing, material: Material, wheel_speed: float) -> Flywheel:
    rim = sizing.rim
    stress = _hoop_stress(sizing, material, wheel_speed)
    return Flywheel(
        inner_radius=rim.inner_radius,
        outer_radius=rim.outer_radius,
        height=rim.height,
        material=material.name,
        density=material.density,
        mass=rim.mass,
        spin_inertia=rim.spin_inertia,
        transverse_inertia=rim.transverse_inertia,
        hoop_stress=stress,
        stress_margin=_ratio(material.yield_strength, stress),
        stored_energy=float(stored_energy(rim.spin_inertia, wheel_speed)),
    )


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


def _hoop_stress(sizing: DeviceSizing, material: Material, wheel_speed: float) -> float | None:
    if material.poisson_ratio is None:
        return None
    return float(
        hoop_stress(
            sizing.rim.inner_radius,
            sizing.rim.outer_radius,
            density=material.density,
            poisson_ratio=material.poisson_ratio,
            wheel_speed=wheel_speed,
        )
    )


def _ratio(capacity: float | None, demand: float | None) -> float | None:
    return None if capacity is None or demand is None else capacity / demand
