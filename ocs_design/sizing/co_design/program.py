"""The device's figures and its maneuvers as one nonlinear program."""

from collections.abc import Sequence
from dataclasses import astuple

import casadi as ca
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.tilt_inertia import TiltInertia
from ocs_design.sizing.co_design.free_device import FreeDevice
from ocs_design.sizing.co_design.problem import CoDesignProblem, DeviceShape
from ocs_design.sizing.optimal_control.joint_program import Figures, FreeTask
from ocs_design.sizing.optimal_control.task import Task

_NEAREST = np.radians(1.0)
"""Of a free incidence to 0 and to a right angle, where an axis gets out of reach [rad]."""


def build_program(
    problem: CoDesignProblem, tasks: Sequence[Task]
) -> tuple[Figures, Sequence[FreeTask]]:
    """Radii and height over their largest, and the incidence, with all maneuvers."""
    symbols = ca.SX.sym("figures", 4)
    scale = _scale(problem)
    inner, outer, height = (symbols[i] * scale[i] for i in range(3))
    device, incidence = FreeDevice(problem, inner, outer, height), symbols[3]
    maneuvers = problem.selection.requirement.maneuvers
    free = [
        FreeTask(task, device.plant(incidence if own is None else ca.SX(own)))
        for task, own in zip(tasks, [each.incidence for each in maneuvers], strict=True)
    ]
    lower, upper = _bounds(problem)
    figures = Figures(
        symbols=symbols,
        start=np.array(astuple(problem.shape)) / scale,
        lower=lower / scale,
        upper=upper / scale,
        objective=device.module_mass / (problem.selected.mass / 2.0),
        excess=ca.vertcat(device.excess(), _rate_excess(problem, device, incidence)),
    )
    return figures, free


def shape_of(problem: CoDesignProblem, figures: FloatArray) -> DeviceShape:
    """The device of the symbols' values, shape (4,)."""
    return DeviceShape(*(float(figure) for figure in figures * _scale(problem)))


def _scale(problem: CoDesignProblem) -> FloatArray:
    """Of the figures' symbols, shape (4,)."""
    radius, height = float(problem.limits.outer_radius_max), float(problem.limits.height_max)
    return np.array([radius, radius, height, 1.0])


def _bounds(problem: CoDesignProblem) -> tuple[FloatArray, FloatArray]:
    """Of inner and outer radius [m], height [m] and incidence [rad]."""
    limits, incidence = problem.limits, problem.selected.incidence
    nearest, farthest = _NEAREST, np.pi / 2.0 - _NEAREST
    # A device for one axis alone stays one: elsewhere the other axis would ask for being stopped.
    if problem.selection.incidence is not None or not nearest < incidence < farthest:
        nearest = farthest = incidence
    least = max(float(limits.inner_radius_min), float(limits.outer_radius_min))
    lower = (limits.inner_radius_min, least, limits.height_min, nearest)
    upper = (limits.outer_radius_max, limits.outer_radius_max, limits.height_max, farthest)
    return np.array(lower, dtype=np.float64), np.array(upper, dtype=np.float64)


def _rate_excess(problem: CoDesignProblem, device: FreeDevice, incidence: ca.SX) -> ca.SX:
    """What the wheels lack for the change of rate, over what the robot alone asks, (2, 1)."""
    change, line = problem.selection.requirement.rate_change, problem.line
    if change is None:
        return ca.SX(0, 1)
    top = min(line.no_load_speed, line.speed_max)
    held = 2.0 * top * device.spin_inertia * ca.vertcat(ca.sin(incidence), ca.cos(incidence))
    whole = device.inertia(incidence)
    # Either wheel is the busier one; which of them does not change with the device.
    product = whole[3] - whole[4] * whole[5] / whole[2]
    sense = np.sign(TiltInertia.of(problem.selected.total.inertia).product)
    across = sense * product * ca.vertcat(ca.tan(incidence), 1.0 / ca.tan(incidence))
    asked = (whole[:2] + across) * change
    return (asked - held) / (np.diag(problem.selection.robot.inertia)[:2] * change)
