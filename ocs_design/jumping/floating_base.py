"""The whole robot in symbols: a free trunk, its legs, and the forces of the ground.

The trunk's pose is its position and roll, pitch and yaw in the world, as coordinates; a jump from
a level stance never comes near their singularity.
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.jumping.leg_dynamics import (
    JointMotion,
    Motion,
    SymbolicBody,
    inertial_wrench,
    leg_dynamics,
    momentum_of,
)
from ocs_design.jumping.legged_body import LeggedBody
from ocs_design.robot.mass_properties import MassProperties

POSE = 6
"""Coordinates of the trunk, in front of those of the joints."""


@dataclass(frozen=True, eq=False)
class Load:
    """What differs from one jump of a robot to the next, in symbols.

    Attributes:
        gravity: [m/s^2]. trunk: with what it carries, in B.
    """

    gravity: ca.SX
    trunk: SymbolicBody

    @classmethod
    def symbols(cls) -> "Load":
        """Free ones."""
        body = SymbolicBody(ca.SX.sym("mass"), ca.SX.sym("com", 3), ca.SX.sym("inertia", 3, 3))
        return cls(ca.SX.sym("gravity"), body)

    def packed(self) -> ca.SX:
        """As one column."""
        return ca.veccat(self.gravity, self.trunk.mass, self.trunk.com, self.trunk.inertia)

    @staticmethod
    def values(gravity: float, trunk: MassProperties) -> FloatArray:
        """Numbers in the same order."""
        return np.concatenate([[gravity, trunk.mass], trunk.com, trunk.inertia.ravel()])


@dataclass(frozen=True, eq=False)
class FloatingBase:
    """Robot in symbols; what depends on the coordinates y, their rates v and a, and the forces f.

    Attributes:
        y, v, a: pose and joints, shape (6 + n, 1). f: of the ground on each foot, in the world,
            shape (3 legs, 1). load: see `Load`.
        torque: of the joints [N m or N], shape (n, 1).
        imbalance: force and moment about B's origin that the trunk lacks, in B, shape (6, 1).
        momentum: of the whole in the world [kg m/s], shape (3, 1).
        spin: angular momentum about the centre of mass, in B [kg m^2/s], shape (3, 1).
        feet: centres of the feet's balls in the world [m], each (3, 1).
        shanks: rotations of the legs' last bodies in the world, each (3, 3).
        reach: square of each leg's length [m^2], shape (legs, 1).
    """

    y: ca.SX
    v: ca.SX
    a: ca.SX
    f: ca.SX
    load: Load
    torque: ca.SX
    imbalance: ca.SX
    momentum: ca.SX
    spin: ca.SX
    feet: tuple[ca.SX, ...]
    shanks: tuple[ca.SX, ...]
    reach: ca.SX

    @classmethod
    def of(cls, body: LeggedBody) -> "FloatingBase":
        """Newton-Euler over trunk and legs."""
        size = POSE + len(body.joints)
        y, v, a = (ca.SX.sym(name, size) for name in "yva")
        f, load = ca.SX.sym("f", 3 * len(body.legs)), Load.symbols()
        rotation, base = _base_motion(y, v, a, load.gravity)
        up = rotation.T @ ca.DM([0.0, 0.0, 1.0])
        joints = JointMotion(y[POSE:], v[POSE:], a[POSE:])
        states = [
            leg_dynamics(
                leg, base, joints.of(where), force=rotation.T @ f[3 * i : 3 * i + 3], up=up
            )
            for i, (leg, where) in enumerate(body.joint_slices)
        ]
        trunk, com = load.trunk, load.trunk.com
        imbalance = inertial_wrench(trunk, base.carried(com), com)
        momentum = momentum_of(trunk, base.carried(com), com)
        mass_moment = trunk.mass * com
        for state in states:
            imbalance, momentum = imbalance + state.load, momentum + state.momentum
            mass_moment = mass_moment + state.mass_moment
        center = mass_moment / (trunk.mass + body.leg_mass)
        return cls(
            y,
            v,
            a,
            f,
            load,
            torque=ca.vertcat(*(state.torque for state in states)),
            imbalance=ca.vertcat(imbalance.force, imbalance.moment),
            momentum=rotation @ momentum.force,
            spin=momentum.moment - ca.cross(center, momentum.force),
            feet=tuple(y[:3] + rotation @ state.foot for state in states),
            shanks=tuple(rotation @ state.shank for state in states),
            reach=ca.vertcat(*(state.reach for state in states)),
        )


def _base_motion(y: ca.SX, v: ca.SX, a: ca.SX, gravity: ca.SX) -> tuple[ca.SX, Motion]:
    """Rotation of B in the world, and B's motion."""
    roll, pitch, yaw = (y[i] for i in range(3, 6))
    rotation = _about(2, yaw) @ _about(1, pitch) @ _about(0, roll)
    # From the rates of the angles to the rate in B (Diebel, Representing Attitude, 2006, eq. 71).
    rates = ca.vertcat(
        ca.horzcat(1.0, 0.0, -ca.sin(pitch)),
        ca.horzcat(0.0, ca.cos(roll), ca.sin(roll) * ca.cos(pitch)),
        ca.horzcat(0.0, -ca.sin(roll), ca.cos(roll) * ca.cos(pitch)),
    )
    rate = rates @ v[3:6]
    angular = rates @ a[3:6] + ca.jtimes(rate, y[3:6], v[3:6])
    against_fall = a[:3] + ca.vertcat(0.0, 0.0, gravity)
    return rotation, Motion(rate, angular, rotation.T @ v[:3], rotation.T @ against_fall)


def _about(axis: int, angle: ca.SX) -> ca.SX:
    cross = ca.SX(ca.skew(ca.DM(np.eye(3)[axis])))
    return ca.SX.eye(3) + ca.sin(angle) * cross + (1.0 - ca.cos(angle)) * (cross @ cross)
