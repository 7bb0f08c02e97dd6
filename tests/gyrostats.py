"""The worked example of the theory's optimal control problems, and bodies like it."""

import numpy as np

from ocs_design.drive.line import DriveLine
from ocs_design.requirement.maneuver import Disturbance, Drop, Flip
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.incidence import module_axes
from ocs_design.sizing.optimal_control.boundary import boundary

DIAGONAL = np.diag([0.030, 0.0535, 0.068])
FULL = np.array([[0.030, 0.001, 0.003], [0.001, 0.0535, -0.002], [0.003, -0.002, 0.068]])
EC_45_FLAT = DriveLine(stall_torque=1.4566, no_load_speed=650.4, torque_limit=1.0, speed_max=np.inf)
"""70 W at 24 V, its drive limited to 1.0 N m."""

FALL = 0.385
"""[s]."""

STANDING = 0.3

PUSH = Disturbance(
    name="push", takeoff_velocity=(0.5, 2.4), torque=(0.2, 0.8, 0.0), onset=0.1, duration=0.05
)
BACK_FLIP = Flip(name="back-flip", gravity=1.62, jump_height=1.0, angle=-2.0 * np.pi, duration=2.0)


def body(incidence, spin_inertia=1.4e-4, inertia=FULL, armature=0.0):
    return Gyrostat(inertia, module_axes(incidence), spin_inertia, armature)


def drop(pitch, roll=0.0):
    height = STANDING + 0.5 * 9.81 * FALL**2
    return Drop(name="drop", height=height, pitch=np.radians(pitch), roll=np.radians(roll))


def asked(maneuver):
    return boundary(maneuver, STANDING)
