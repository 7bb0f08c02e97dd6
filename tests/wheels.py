"""The paper's device, and variants of it, for tests."""

from dataclasses import replace

import numpy as np

from ocs_design.design import Device, Flywheel, Module, Motor
from ocs_design.requirement.froude import Scale
from ocs_design.robot.robot import Robot
from ocs_design.sizing.incidence import module_axes

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


def motor(
    no_load_speed: float = np.inf,
    stall_torque: float | None = None,
    torque_limit: float | None = None,
) -> Motor:
    return Motor("test", 0.0, stall_torque, no_load_speed, torque_limit, 0.0, "made up")


def paper_device(incidence: float = np.radians(40.0), drive: Motor | None = None) -> Device:
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


def scaled_device(robot: Robot) -> Device:
    """The paper's wheel for another robot: lengths by its Froude scale, inertia by its own."""
    scale, device = Scale.of(robot), paper_device()
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
