"""The worked example of the theory's optimal control problems, and similar bodies."""

from dataclasses import dataclass, replace

import casadi as ca
import numpy as np
from driven_wheels import EC45_LINE
from scipy.spatial.transform import Rotation

from ocs_design.device.layout import module_axes
from ocs_design.requirement.boundary import End
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.turns import Drop, Flip
from ocs_design.sizing.trajectory.flight import Flight, fly
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.program import Dimensions, Solution, solve
from ocs_design.sizing.trajectory.transcription import Phase, Plant

DIAGONAL = np.diag([0.030, 0.0535, 0.068])
FULL = np.array([[0.030, 0.001, 0.003], [0.001, 0.0535, -0.002], [0.003, -0.002, 0.068]])
FALL = 0.385
"""Time of the fall [s]."""

STANDING = 0.3

PUSH = Disturbance(
    name="push", takeoff_velocity=(0.5, 2.4), torque=(0.2, 0.8, 0.0), onset=0.1, duration=0.05
)
BACK_FLIP = Flip(name="back-flip", gravity=1.62, jump_height=1.0, angle=-2.0 * np.pi, duration=2.0)


def body(incidence, spin_inertia=1.4e-4, inertia=FULL, armature=0.0):
    return Gyrostat(inertia, module_axes(incidence), spin_inertia, armature)


def drop(pitch, roll=0.0):
    height = STANDING + 0.5 * 9.81 * FALL**2
    return Drop(
        name="drop",
        standing_height=STANDING,
        height=height,
        pitch=np.radians(pitch),
        roll=np.radians(roll),
    )


def boundary_of(maneuver):
    return maneuver.boundary()


def attitude_error(boundary, path):
    """Angle from the final attitude to that of the boundary [rad], computed with SciPy.

    If the heading is free, the angle between the verticals.
    """
    final, wanted = Rotation.from_quat(
        [path.attitude[-1], boundary.final_attitude], scalar_first=True
    )
    if boundary.end == End.ATTITUDE:
        return (wanted.inv() * final).magnitude()
    up, level = (each.inv().apply([0.0, 0.0, 1.0]) for each in (final, wanted))
    return np.arctan2(np.linalg.norm(np.cross(up, level)), up @ level)


def end_rate(gyrostat, path):
    """Final rate about the axes that the wheels control [rad/s]."""
    return np.linalg.norm(gyrostat.controlled_axes @ path.rate[-1])


@dataclass(frozen=True, eq=False)
class SmallestWheels(Flight):
    """The solution of the program, and the flight of the gyrostat with the wheels found."""

    gyrostat: Gyrostat
    incidence: float
    solution: Solution


def smallest_wheels(guess, boundary, *, free_incidence=False, start=None, passes=(16, 48)):
    """Minimize the spin inertia, and optionally the incidence of a pair; all else as in `guess`.

    The total inertia with braked wheels stays constant.
    """
    incidence = float(np.arctan2(guess.axes[0, 0], guess.axes[1, 0]))
    low, high = (1e-3, np.pi / 2.0 - 1e-3) if free_incidence else (incidence, incidence)

    def plant(dimensions):
        factor, angle = dimensions[0], dimensions[1]
        base = Plant.of(guess)
        axes = base.axes
        if free_incidence:
            sine, cosine = ca.sin(angle), ca.cos(angle)
            axes = ca.vertcat(ca.horzcat(sine, -sine), ca.horzcat(cosine, cosine), ca.MX(1, 2))
        return base._replace(spin_inertia=factor * guess.spin_inertia, axes=axes)

    turn = Phase(boundary, guess, plant, start)
    lower, upper = np.array([1e-2, low]), np.array([1e2, high])
    variables = Dimensions(
        np.array([1.0, incidence]), lower, upper, lambda dimensions: dimensions[0]
    )
    solution = solve([turn], EC45_LINE, passes, variables)
    factor, incidence = solution.dimensions
    axes = module_axes(incidence) if free_incidence else guess.axes
    gyrostat = replace(guess, spin_inertia=guess.spin_inertia * factor, axes=axes)
    flight = fly(replace(turn, gyrostat=gyrostat), EC45_LINE, solution.motions[0])
    return SmallestWheels(**vars(flight), gyrostat=gyrostat, incidence=incidence, solution=solution)
