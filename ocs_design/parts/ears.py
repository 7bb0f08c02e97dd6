"""Ears around a band, which screws stand in."""

from math import asin, pi, sqrt, tan

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.fasteners import Screw
from ocs_design.parts.outline import Outline, circle, ring_of_points
from ocs_design.robot.rotations import rotation_about
from ocs_design.sizing.housing import EAR_COUNT, WALL

AXIS = np.array([0.0, 0.0, 1.0])


def ear_radius(screw: Screw) -> float:
    """Of an ear's round end: a wall around the widest hole [m]."""
    return screw.clearance_hole / 2.0 + WALL


def ear_axis(radius: float, screw: Screw) -> float:
    """The hole stays outside a band of that radius [m]."""
    return radius + screw.clearance_hole / 2.0


def eared(radius: float, screw: Screw, first: float) -> Outline:
    """The circle of a band with its ears, which have straight sides and a round end.

    Args:
        radius: of the band, outside [m].
        screw: that its ears are made for.
        first: angle of the first ear [rad].
    """
    ear, side = _ear(radius, screw), ear_radius(screw)
    between = 2.0 * pi / EAR_COUNT - 2.0 * asin(side / radius)
    bulges = [0.0, 1.0, 0.0, tan(between / 4.0)]
    return Outline(
        np.concatenate([_turned(ear, angle) for angle in _angles(first)]),
        np.tile(bulges, EAR_COUNT),
    )


def posts(
    bore: float, radius: float, screw: Screw, half_angle: float, first: float
) -> list[Outline]:
    """Of each ear with the piece of the band that it stands on.

    Args:
        bore, radius: of the band, inside and outside [m].
        screw: that its ears are made for.
        half_angle: of each piece around the axis, more than the ear takes [rad].
        first: angle of the first ear [rad].
    """
    corners = np.array([[np.cos(half_angle), side * np.sin(half_angle)] for side in (-1, 1)])
    post = np.concatenate([radius * corners[:1], _ear(radius, screw), radius * corners[1:]])
    post = np.concatenate([post, bore * corners[::-1]])
    beside = tan((half_angle - asin(ear_radius(screw) / radius)) / 4.0)
    bulges = np.array([beside, 0.0, 1.0, 0.0, beside, 0.0, -tan(half_angle / 2.0), 0.0])
    return [Outline(_turned(post, angle), bulges) for angle in _angles(first)]


def ear_holes(radius: float, screw: Screw, diameter: float, first: float) -> list[Outline]:
    """In the ears of a band of that radius, outside [m]."""
    centres = ring_of_points(ear_axis(radius, screw), EAR_COUNT, first)
    return [circle(diameter / 2.0, centre) for centre in centres.tolist()]


def _ear(radius: float, screw: Screw) -> FloatArray:
    """Its corners on the x axis, from the band outwards and back."""
    end, side = ear_axis(radius, screw), ear_radius(screw)
    root = sqrt(radius**2 - side**2)
    return np.array([[root, -side], [end, -side], [end, side], [root, side]])


def _angles(first: float) -> FloatArray:
    return first + 2.0 * pi * np.arange(EAR_COUNT) / EAR_COUNT


def _turned(points: FloatArray, angle: float) -> FloatArray:
    turned: FloatArray = points @ rotation_about(AXIS, angle)[:2, :2].T
    return turned
