"""Assembly of a sizing's or selection's result into the device that is exported and simulated."""

from dataclasses import replace

from ocs_design.actuation.drive import Drive
from ocs_design.catalogue.materials import Material
from ocs_design.common.arrays import FloatArray
from ocs_design.device.device import Device, Module
from ocs_design.device.layout import PAIR, Layout
from ocs_design.parts.rim import NO_CUTS, Hub, RimCuts, hoop_stress, stored_energy, wheel_body
from ocs_design.parts.wheel import Flywheel, Web
from ocs_design.requirement.resolving import Resolved
from ocs_design.sizing.bound.device_sizing import DeviceSizing
from ocs_design.sizing.driven_wheel import DrivenWheel
from ocs_design.sizing.selection.problem import Candidate


def assemble(sizing: DeviceSizing, resolved: Resolved) -> Device:
    """Two modules at the sized places, each with the sized wheel and the assumed motor."""
    rim, speed = sizing.rim, resolved.requirement.wheel_speed_max
    cylinder = (rim.inner_radius, rim.outer_radius, rim.height)
    flywheel = _flywheel(cylinder, resolved.material, speed, rotor_share=0.0)
    return Device(
        sizing.incidence,
        modules_at(sizing.centers, sizing.incidence),
        # Exactly the mass that was minimised.
        replace(flywheel, mass=rim.mass),
        Drive(
            name="assumed",
            mass=0.0,
            stall_torque=None,
            no_load_speed=speed,
            torque_limit=resolved.torque_max,
            rotor_inertia=0.0,
            source="no motor is chosen; highest speed and torque as assumed or specified",
        ),
    )


def assemble_selected(candidate: Candidate) -> Device:
    """Modules as they were selected, each with a motor of the catalogue."""
    return Device(
        candidate.incidence,
        modules_at(candidate.centers, candidate.incidence, candidate.layout),
        flywheel_of(candidate),
        candidate.drive,
        candidate.carrier,
        layout=candidate.layout,
        supply=candidate.supply.explicit,
        guard_wall=candidate.guard_wall,
        foot_plate=candidate.foot_plate,
        on_bell=candidate.on_bell,
    )


def modules_at(centers: FloatArray, incidence: float, layout: Layout = PAIR) -> tuple[Module, ...]:
    """Modules with the centres of their wheels in B [m], shape (n, 3), at an incidence [rad]."""
    placed = zip(layout.names, layout.axes(incidence).T, centers, strict=True)
    return tuple(Module(name, axis, center) for name, axis, center in placed)


def flywheel_of(wheel: DrivenWheel) -> Flywheel:
    """The wheel that a motor of the catalogue drives, with the rotor's share."""
    return _flywheel(
        (wheel.inner_radius, wheel.outer_radius, wheel.height),
        wheel.material,
        wheel.drive.top_speed,
        wheel.drive.rotor_inertia,
        wheel.hub,
        cuts=wheel.cuts,
        web_material=wheel.web_material,
    )


def _flywheel(
    cylinder: tuple[float, float, float],
    material: Material,
    wheel_speed: float,
    rotor_share: float,
    hub: Hub | None = None,
    *,
    cuts: RimCuts = NO_CUTS,
    web_material: Material | None = None,
) -> Flywheel:
    """Wheel from a rim's inner and outer radius and height [m], and a rotor's share [kg m^2]."""
    inner, outer, height = cylinder
    strength, stress, web = material.yield_strength, None, None
    if material.poisson_ratio is not None:
        stress = float(
            hoop_stress(
                inner,
                outer,
                density=material.density,
                poisson_ratio=material.poisson_ratio,
                wheel_speed=wheel_speed,
            )
        )
    if hub is not None:
        of = material if web_material is None else web_material
        mass = hub.mass_with_web(inner, of.density)
        web = Web(of.name, of.density, hub.web_thickness, mass, hub, hub.holes(inner))
    body = wheel_body(
        *cylinder,
        material.density,
        hub,
        cuts=cuts,
        web_density=None if web is None else web.density,
    )
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
        stress_margin=None if strength is None or stress is None else strength / stress,
        stored_energy=float(stored_energy(spin_inertia, wheel_speed)),
        web=web,
        cuts=cuts,
    )
