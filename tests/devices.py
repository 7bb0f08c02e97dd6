"""Devices to export and simulate, made by hand: the paper's wheel on any robot."""

import numpy as np

from ocs_design.design import Device, Flywheel, Module, Motor
from ocs_design.sizing.incidence import module_axes

PAPER_WHEEL = Flywheel(
    inner_radius=0.022,
    outer_radius=0.03,
    height=0.01,
    material="steel",
    density=7860.0,
    mass=np.pi * 7860.0 * 0.01 * (0.03**2 - 0.022**2),
    spin_inertia=np.pi * 7860.0 * 0.01 * (0.03**4 - 0.022**4) / 2.0,
    transverse_inertia=np.pi
    * 7860.0
    * 0.01
    * (3.0 * (0.03**4 - 0.022**4) + 0.01**2 * (0.03**2 - 0.022**2))
    / 12.0,
    hoop_stress=None,
    stress_margin=None,
    stored_energy=20.2,
)
UNLIMITED = Motor("assumed", 0.0, None, 754.0, None, 0.0, "")
LIMITED = Motor("limited", 0.0, 1.4566, 650.4, 1.0, 0.0, "")


def paper_device(incidence=np.radians(40.0), motor=UNLIMITED):
    """Wheels at positions whose digits no rounding can hide."""
    left, right = module_axes(incidence).T
    return Device(
        incidence,
        (
            Module("left", left, np.array([0.01, 0.1, 0.07]) / 3.0),
            Module("right", right, np.array([0.01, -0.1, 0.07]) / 3.0),
        ),
        PAPER_WHEEL,
        motor,
    )
