"""Masses and lengths in other units, as the density betrays them."""

from collections.abc import Iterator

import numpy as np

from ocs_design.robot.doubts.box import Box
from ocs_design.robot.mass_properties import MassProperties

STEEL = 7850.0
"""A link as heavy as a block of steel that fills its box [kg/m^3]; public robots reach 7430."""

AIR = 1.2
"""A link as light as the air in its box [kg/m^3]; public robots begin at 6.8."""

DENSEST_ROBOT, LIGHTEST_ROBOT = 2700.0, 1.2
"""Of a robot's mass over the ball with its radius of gyration: solid aluminium, and air [kg/m^3].

Public robots lie between 5 and 484; in grams or millimetres they are off by a thousand or more.
"""


def link_density_doubts(mass: float, box: Box) -> Iterator[tuple[str, str]]:
    """What is wrong between a body's mass [kg] and its box, and by how much."""
    density = mass / box.volume
    if density > STEEL:
        yield (
            "links heavier than solid steel in their shapes: masses in grams, or too small shapes?",
            f"{density:.2g} kg/m3",
        )
    elif density < AIR:
        yield (
            "links lighter than the air in their shapes: a mesh in millimetres without its scale, "
            "or masses in tonnes?",
            f"{density:.2g} kg/m3",
        )


def robot_density(weighed: MassProperties) -> float:
    """Mass over the volume of the homogeneous ball with the same radius of gyration [kg/m^3].

    A ball of radius R has trace(I) / m = 6 R^2 / 5.
    """
    radius = np.sqrt(5.0 / 6.0 * np.trace(weighed.inertia) / weighed.mass)
    return float(weighed.mass / (4.0 / 3.0 * np.pi * radius**3))


def robot_density_doubts(weighed: MassProperties) -> Iterator[str]:
    """What is wrong between the mass of a robot and the length that its inertia tells."""
    density = robot_density(weighed)
    radius = float(np.sqrt(np.trace(weighed.inertia) / weighed.mass))
    said = f"the robot weighs {weighed.mass:.3g} kg with a radius of gyration of {radius:.3g} m"
    if density > DENSEST_ROBOT:
        yield f"{said}, as dense as solid metal: masses in grams, or lengths too small?"
    elif density < LIGHTEST_ROBOT:
        yield f"{said}, as light as air: lengths in millimetres, or masses in tonnes?"
