"""The paper's device and variants of it."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ocs_design.actuation.drive import Drive
from ocs_design.common.arrays import FloatArray
from ocs_design.device.device import Device, Module
from ocs_design.device.layout import Layout, module_axes
from ocs_design.parts.solids import Carrier
from ocs_design.parts.wheel import Flywheel
from ocs_design.requirement.froude import FroudeScale, default_maneuvers
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.mass import MassProperties, combine
from ocs_design.robot.robot import Robot
from ocs_design.sizing.footing.standing import footing_under, standing_on

# Table 2 of the paper; its h of 10.2 mm contradicts its own mass and inertia.
PAPER_WHEEL = Flywheel(
    inner_radius=0.022,
    outer_radius=0.03,
    height=0.01,
    material="steel",
    density=7860.0,
    mass=7860.0 * np.pi * 0.01 * (0.03**2 - 0.022**2),
    spin_inertia=7860.0 * np.pi * 0.01 * (0.03**4 - 0.022**4) / 2.0,
    transverse_inertia=7860.0
    * np.pi
    * 0.01
    * (3.0 * (0.03**4 - 0.022**4) + 0.01**2 * (0.03**2 - 0.022**2))
    / 12.0,
    hoop_stress=None,
    stress_margin=None,
    stored_energy=0.0,
)


def stand_on_trunk(
    device: Device, robot: Robot, *, specified: bool, formed: bool = False
) -> Device:
    """The device on its footing; as it is where there is none."""
    footing = footing_under(device, robot, specified=specified, formed=formed)
    return device if footing is None else standing_on(device, footing)


def paper_maneuvers(robot: Robot) -> tuple[Maneuver, ...]:
    """The default maneuvers, the back-flip with both wheels turned to the pitch axis by hand."""
    jump, drop, flip = default_maneuvers(robot)
    return jump, drop, replace(flip, incidence=0.0)


def motor(
    no_load_speed: float = np.inf,
    stall_torque: float | None = None,
    torque_limit: float | None = None,
) -> Drive:
    return Drive(
        name="test",
        mass=0.0,
        stall_torque=stall_torque,
        no_load_speed=no_load_speed,
        torque_limit=torque_limit,
        rotor_inertia=0.0,
        source="made up",
    )


# docs/theory.md, What a motor can do: maxon's EC 45 flat 70 W at 24 V, its drive limited to 1 N m.
EC45 = replace(
    motor(650.4, 1.4566, 1.0), mass=0.141, rotor_inertia=1.81e-5, speed_max=1047.2, bus_voltage=24.0
)
EC45_BODY = Carrier(mass=0.15, axial_inertia=3.5e-5, transverse_inertia=2.5e-5)


def paper_device(incidence: float = np.radians(40.0), drive: Drive | None = None) -> Device:
    axes = module_axes(incidence)
    return Device(
        incidence,
        (
            Module("left", axes[:, 0], np.array([0.0, 0.04, 0.05])),
            Module("right", axes[:, 1], np.array([0.0, -0.04, 0.05])),
        ),
        PAPER_WHEEL,
        drive or motor(),
    )


def driven_device(
    incidence: float = np.radians(40.0), drive: Drive = EC45, carrier: Carrier = EC45_BODY
) -> Device:
    """The paper's device on a real motor."""
    spin_inertia = PAPER_WHEEL.spin_inertia + drive.rotor_inertia
    wheel = replace(PAPER_WHEEL, spin_inertia=spin_inertia)
    return replace(paper_device(incidence, drive), flywheel=wheel, carrier=carrier)


def layout_device(layout: Layout) -> Device:
    """The driven device with a module on each axis of a layout, on top of the trunk."""
    angle = layout.angle or 0.0
    centers = 0.08 * np.array(layout.ring) + [0.0, 0.0, 0.1]
    modules = map(Module, layout.names, layout.axes(angle).T, centers)
    return replace(driven_device(), incidence=angle, modules=tuple(modules), layout=layout)


def geared(ratio: float, *, reverses: bool = False, inertia: float = 2e-6) -> Drive:
    """The EC 45 behind a gear (docs/theory.md): s N J_r of its rotor adds to the momentum."""
    sense = -1.0 if reverses else 1.0
    rotor = EC45.rotor_inertia
    return replace(
        EC45,
        gear=f"{ratio} to 1",
        gear_ratio=ratio,
        rotor_inertia=sense * ratio * rotor,
        armature=ratio * (ratio - sense) * rotor + inertia,
        stall_torque=1.4566 * ratio,
        no_load_speed=650.4 / ratio,
        torque_limit=ratio,
    )


def braked_inertia(robot: Robot, device: Device) -> MassProperties:
    """Mass properties of robot, rims and carriers at rest, as a scale and a pendulum measure them.

    The carriers' inertia already includes the rotors.
    """
    rim, rotor = device.flywheel, device.motor.rotor_inertia
    bodies = [
        MassProperties(
            rim.mass,
            module.position,
            _body_of_revolution(rim.spin_inertia - rotor, rim.transverse_inertia, module.axis),
        )
        for module in device.modules
    ]
    return combine([robot.mass_properties, *bodies, *_carriers(device)])


def _carriers(device: Device) -> Iterator[MassProperties]:
    """Mass properties of each carrier, whose frame points away from the other module."""
    carrier = device.carrier
    up = np.array([0.0, 0.0, 1.0])
    for module in device.modules:
        outward = -module.axis if module.name == "right" else module.axis
        upward = up - outward[2] * outward
        upward = upward / np.linalg.norm(upward) if np.any(upward) else np.array([1.0, 0.0, 0.0])
        frame = np.column_stack([np.cross(outward, upward), outward, upward])
        place = module.position + carrier.along * outward + carrier.up * upward
        yield MassProperties(carrier.mass, place, frame @ carrier.inertia @ frame.T)


def _body_of_revolution(axial: float, transverse: float, axis: FloatArray) -> FloatArray:
    return transverse * np.eye(3) + (axial - transverse) * np.outer(axis, axis)


def scaled_device(robot: Robot) -> Device:
    """The paper's device scaled to a robot: lengths by Froude, inertia by that of the robot."""
    scale, device = FroudeScale.of(robot), paper_device()
    inertia = PAPER_WHEEL.spin_inertia * scale.pitch_inertia
    wheel = replace(
        PAPER_WHEEL,
        outer_radius=PAPER_WHEEL.outer_radius * scale.length,
        height=PAPER_WHEEL.height * scale.length,
        mass=PAPER_WHEEL.mass * scale.pitch_inertia / scale.length**2,
        spin_inertia=inertia,
        transverse_inertia=0.55 * inertia,
    )
    left, right = (
        replace(module, position=module.position * scale.length) for module in device.modules
    )
    return replace(device, modules=(left, right), flywheel=wheel)
