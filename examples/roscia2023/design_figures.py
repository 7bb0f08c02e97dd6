"""What the paper says of the robot, the bound, the angle and the wheel (sections 2 and 3)."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import cos, degrees, pi, radians, sin

import numpy as np
from scipy.optimize import brentq
from statements import Statement, number, taken

from ocs_design.device.layout import Criterion, incidence_by_criterion
from ocs_design.parts.rim import (
    cylinder_mass,
    cylinder_spin_inertia,
    cylinder_transverse_inertia,
)
from ocs_design.requirement.bound import corrected_bound, elroy_beanie_bound
from ocs_design.requirement.specification import Specification
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.reader import read_robot
from ocs_design.robot.robot import Robot

INNER_RADIUS, OUTER_RADIUS, DENSITY = 0.022, 0.030, 7860.0
PRINTED_HEIGHT, HEIGHT = 0.0102, 0.0100
SPIN_INERTIA = 7.11e-5
INCIDENCE = radians(40.0)
MOTOR_SPEED = 7200.0 * pi / 30.0
"""[rad/s] of Solo12's own motors at 24 V (300 rpm/V)."""

OUTWARDS = {"FL": 1.0, "FR": -1.0, "HL": 1.0, "HR": -1.0}
"""Sign with which each leg's HAA swings it outwards."""


def robot_statements(robot: Robot) -> Iterator[Statement]:
    """Section 1 and 2: masses."""
    masses = {body.name: body.mass_properties.mass for body in robot.tree.bodies}
    limb = sum(mass for name, mass in masses.items() if name.startswith("FL_"))
    swinging = limb - masses["FL_SHOULDER"]
    yield number("mass of Solo12 (figure 1)", "2.5", robot.mass, "kg")
    yield number("mass of a limb, of the whole", "13.4", 100.0 * limb / robot.mass, "%")
    yield number(
        "the part of it that changes the inertia, thigh and calf",
        "7.5",
        100.0 * swinging / robot.mass,
        "%",
    )
    mass = cylinder_mass(INNER_RADIUS, OUTER_RADIUS, HEIGHT, DENSITY)
    yield number("mass of a flywheel (figure 1)", "0.1", mass, "kg", "rounded; see its Table 2")


def bound_statements(robot: Robot) -> Iterator[Statement]:
    """Section 3.1: the bound, at a change of rate that the paper does not state."""
    inertia, change = float(robot.inertia[1, 1]), 2.0
    printed = elroy_beanie_bound(inertia, change, MOTOR_SPEED)
    derived = corrected_bound(inertia, change, MOTOR_SPEED)
    yield Statement(
        "bound on I_f; with d = 2 rad/s, 7,200 rpm, and the standing robot's pitch inertia "
        f"{inertia:.4f} kg m²",
        f"I_r d / (d + γ) = {printed:.4e} kg m²",
        f"I_r d / (γ − d) = {derived:.4e} kg m²",
        f"{derived / printed - 1.0:+.1%}",
        "the sign in the printed bound does not follow from the printed momentum: trunk and wheel "
        "turn against each other",
    )
    wheels = 2.0 * cos(INCIDENCE) * SPIN_INERTIA
    yield Statement(
        "I_f of the two wheels of Table 2 at 40°, 2 cos α I_f,zz",
        "not stated",
        f"{wheels:.3e} kg m²",
        why="the rate and the speed that it was chosen for are not stated",
    )
    reached = wheels * MOTOR_SPEED / (inertia + wheels)
    yield Statement(
        "largest change of pitch rate with Solo12's own motors, 7,200 rpm",
        "not stated",
        f"{reached:.2f} rad/s",
        why="the drop needs more: see below",
    )


def angle_statements(robot: Robot) -> Iterator[Statement]:
    """Section 3.2: the incidence."""
    zero = read_robot(robot.source, posture="zero")
    why = "its own formula, tan⁻¹(I_xx / I_yy); the posture is not stated"
    yield number("α* of Solo12, standing", "40", equal_rate(robot.mass_properties), "°", why)
    yield number("the same with all joints at zero", "40", equal_rate(zero.mass_properties), "°")
    abduction = brentq(lambda haa: equal_rate(abducted(robot, haa)) - 40.0, 0.0, 1.4)
    yield Statement(
        "posture in which the formula gives 40°",
        "not stated",
        f"hips abducted by {degrees(abduction):.0f}°",
        why="while standing on legs bent as here; no posture for a jump",
    )
    yield Statement("roll at α = 0", "uncontrollable", f"2 sin α = {2.0 * sin(0.0):.0f}")
    yield Statement("pitch at α = 90°", "uncontrollable", f"2 cos α = {2.0 * cos(pi / 2.0):.0f}")
    yield Statement(
        "what turns the pitch (text below the momentum)",
        "“their difference”, as for roll",
        "the sum of both speeds",
        why="a slip: equation and figure 6 have the sum",
    )
    yield Statement(
        "u = Cᵀ τ gives the torque τ on the trunk",
        "C Cᵀ = 1 is implied",
        f"C Cᵀ = diag({2.0 * sin(INCIDENCE) ** 2:.2f}, {2.0 * cos(INCIDENCE) ** 2:.2f}, 0)",
        why="the gains act scaled; here the pseudo-inverse, and the transpose on request",
    )


def wheel_statements() -> Iterator[Statement]:
    """Section 3.3, Table 2."""
    printed, found = wheel_figures(PRINTED_HEIGHT), wheel_figures(HEIGHT)
    yield taken("r", f"{INNER_RADIUS:.2e} m")
    yield taken("R", f"{OUTER_RADIUS:.2e} m")
    yield number(
        "h", f"{PRINTED_HEIGHT:.2e}", HEIGHT, "m", "10.0 mm gives the table's own m and inertias"
    )
    carbon = "called stainless steel, has the density of carbon steel; stainless 304: 7,900 kg/m³"
    yield taken("ρ", f"{DENSITY:.2e} kg/m³", carbon)
    for name, stated, unit in (
        ("m", "1.02e-01", "kg"),
        ("I_xx, I_yy", "3.64e-05", "kg m²"),
        ("I_zz", "7.11e-05", "kg m²"),
    ):
        contrast = f"with h = 10.2 mm it would be {printed[name]:.4g} {unit}"
        yield number(f"{name}, from r, R, h and ρ", stated, found[name], unit, contrast)


def wheel_figures(height: float) -> Mapping[str, float]:
    """Mass [kg] and inertias [kg m^2] of the paper's rim at this height [m]."""
    rim = (INNER_RADIUS, OUTER_RADIUS, height, DENSITY)
    return {
        "m": cylinder_mass(*rim),
        "I_xx, I_yy": cylinder_transverse_inertia(*rim),
        "I_zz": cylinder_spin_inertia(*rim),
    }


def equal_rate(weighed: MassProperties) -> float:
    """The paper's angle [deg]."""
    return degrees(incidence_by_criterion(np.asarray(weighed.inertia))[Criterion.EQUAL_RATE])


def abducted(robot: Robot, angle: float) -> MassProperties:
    """Of the robot with each hip swung outwards by `angle` [rad]."""
    hips = {f"{leg}_HAA": sign * angle for leg, sign in OUTWARDS.items()}
    return robot.tree.locked_mass_properties({**robot.posture, **hips}, robot.trunk)


def paper_wheels(specification: Specification) -> Specification:
    """The same with spokes that weigh nothing, as in the paper."""
    return replace(specification, flywheel=replace(specification.flywheel, web="none"))
