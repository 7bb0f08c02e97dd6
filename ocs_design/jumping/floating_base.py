"""Symbolic model of the whole robot: a free trunk, its legs, and the ground reaction forces.

Recursive Newton-Euler, each body in its own frame (Featherstone, Rigid Body Dynamics Algorithms,
2008, section 5.3). Linear accelerations are relative to free fall, so that gravity needs no term of
its own. The trunk's coordinates are its position and its roll, pitch and yaw in the world; a jump
from a level stance never comes near their singularity.
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.jumping.legged_body import JumpingLeg, LeggedBody
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.tree import JointKind

POSE = 6
"""Number of trunk coordinates, which precede those of the joints."""

_SLOW = 0.1
"""Speed over which dry friction changes sign [rad/s or m/s], since a step has no derivative."""


@dataclass(frozen=True, eq=False)
class SymbolicBody:
    """Symbolic mass [kg], centre of mass [m] and inertia about it [kg m^2], in one frame."""

    mass: ca.SX
    com: ca.SX
    inertia: ca.SX


@dataclass(frozen=True, eq=False)
class Load:
    """Symbols for everything that differs between jumps of one robot.

    Attributes:
        gravity: [m/s^2]. trunk: with what it carries, in B.
    """

    gravity: ca.SX
    trunk: SymbolicBody

    @classmethod
    def symbols(cls) -> "Load":
        """Free symbols for gravity and trunk."""
        body = SymbolicBody(ca.SX.sym("mass"), ca.SX.sym("com", 3), ca.SX.sym("inertia", 3, 3))
        return cls(ca.SX.sym("gravity"), body)

    def packed(self) -> ca.SX:
        """Gravity and trunk as one column."""
        return ca.veccat(self.gravity, self.trunk.mass, self.trunk.com, self.trunk.inertia)

    @staticmethod
    def values(gravity: float, trunk: MassProperties) -> FloatArray:
        """Numbers in the order of `packed`."""
        return np.concatenate([[gravity, trunk.mass], trunk.com, trunk.inertia.ravel()])


@dataclass(frozen=True, eq=False)
class FloatingBase:
    """Symbolic robot, as functions of coordinates y, their derivatives v and a, and forces f.

    Attributes:
        y, v, a: pose and joints, shape (6 + n, 1). f: of the ground on each foot, in the world,
            shape (3 legs, 1).
        torque: of the joints [N m or N], shape (n, 1).
        imbalance: residual force and moment on the trunk about B's origin, in B, shape (6, 1).
        momentum: of the whole robot in the world [kg m/s], shape (3, 1).
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
        """Symbolic robot, by Newton-Euler over trunk and legs."""
        size = POSE + len(body.joints)
        y, v, a = (ca.SX.sym(name, size) for name in "yva")
        f, load = ca.SX.sym("f", 3 * len(body.legs)), Load.symbols()
        rotation, base = _base_motion(y, v, a, load.gravity)
        up = rotation.T @ ca.DM([0.0, 0.0, 1.0])
        states = []
        for i, (leg, where) in enumerate(body.joint_slices):
            joints = slice(POSE + where.start, POSE + where.stop)
            force = rotation.T @ f[3 * i : 3 * i + 3]
            states.append(_leg_state(leg, base, (y[joints], v[joints], a[joints]), force, up))
        trunk, com = load.trunk, load.trunk.com
        imbalance, momentum = _inertial_wrench(trunk, base), _momentum(trunk, base)
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


@dataclass(frozen=True, eq=False)
class _Motion:
    """Motion of a frame, in its own components, each of shape (3, 1).

    Attributes:
        rate, angular_acceleration: [rad/s], [rad/s^2].
        velocity: of the frame's origin [m/s].
        acceleration: of the frame's origin, minus that of gravity [m/s^2].
    """

    rate: ca.SX
    angular_acceleration: ca.SX
    velocity: ca.SX
    acceleration: ca.SX

    def carried(self, offset: ca.SX) -> "_Motion":
        """Motion of a frame that is fixed to this one at `offset`, axes parallel."""
        return _Motion(
            self.rate,
            self.angular_acceleration,
            self.velocity + ca.cross(self.rate, offset),
            self.acceleration
            + ca.cross(self.angular_acceleration, offset)
            + ca.cross(self.rate, ca.cross(self.rate, offset)),
        )

    def seen_from(self, rotation: ca.SX) -> "_Motion":
        """Motion in components along axes at `rotation` in this frame."""
        return _Motion(
            rotation.T @ self.rate,
            rotation.T @ self.angular_acceleration,
            rotation.T @ self.velocity,
            rotation.T @ self.acceleration,
        )

    def turned(self, axis: ca.SX, speed: ca.SX, acceleration: ca.SX) -> "_Motion":
        """Motion of a frame that a hinge turns against this one."""
        spin = axis * speed
        return _Motion(
            self.rate + spin,
            self.angular_acceleration + axis * acceleration + ca.cross(self.rate, spin),
            self.velocity,
            self.acceleration,
        )

    def slid(self, axis: ca.SX, speed: ca.SX, acceleration: ca.SX) -> "_Motion":
        """Motion of a frame that a slide moves against this one, at its present position."""
        along = axis * speed
        return _Motion(
            self.rate,
            self.angular_acceleration,
            self.velocity + along,
            self.acceleration + axis * acceleration + 2.0 * ca.cross(self.rate, along),
        )


@dataclass(frozen=True, eq=False)
class _Wrench:
    """A force, or a momentum, and its moment about a frame's origin, in that frame."""

    force: ca.SX
    moment: ca.SX

    def __add__(self, other: "_Wrench") -> "_Wrench":
        return _Wrench(self.force + other.force, self.moment + other.moment)

    def in_parent(self, rotation: ca.SX, offset: ca.SX) -> "_Wrench":
        """Wrench in a frame in which this one is at `rotation` and `offset`."""
        force = rotation @ self.force
        return _Wrench(force, rotation @ self.moment + ca.cross(offset, force))


@dataclass(frozen=True, eq=False)
class _LegState:
    """State of a leg on a moving trunk.

    Attributes:
        torque: of its joints, friction and armature included [N m or N], shape (n, 1).
        load: wrench from its inertia and the ground that the trunk must balance, in B [N, N m].
        momentum: in B [kg m/s, kg m^2/s]. mass_moment: mass times centre of mass in B [kg m].
        foot: centre of the foot's ball in B [m]. shank: rotation of the last body in B.
        reach: square of the distance from the hip's axis to the foot [m^2].
    """

    torque: ca.SX
    load: _Wrench
    momentum: _Wrench
    mass_moment: ca.SX
    foot: ca.SX
    shank: ca.SX
    reach: ca.SX


@dataclass(frozen=True, eq=False)
class _Link:
    """One body of a leg.

    Attributes:
        rotation, offset: of its frame in the parent's.
        placement, origin: rotation and position of its frame in B.
        motion: of its frame, in its own components.
    """

    rotation: ca.SX
    offset: ca.SX
    placement: ca.SX
    origin: ca.SX
    motion: _Motion


def _base_motion(y: ca.SX, v: ca.SX, a: ca.SX, gravity: ca.SX) -> tuple[ca.SX, _Motion]:
    """Rotation of B in the world, and B's motion."""
    roll, pitch, yaw = (y[i] for i in range(3, 6))
    about_x, about_y, about_z = np.eye(3)
    rotation = _turn(about_z, yaw) @ _turn(about_y, pitch) @ _turn(about_x, roll)
    # From the rates of the angles to the rate in B (Diebel, Representing Attitude, 2006, eq. 71).
    rates = ca.vertcat(
        ca.horzcat(1.0, 0.0, -ca.sin(pitch)),
        ca.horzcat(0.0, ca.cos(roll), ca.sin(roll) * ca.cos(pitch)),
        ca.horzcat(0.0, -ca.sin(roll), ca.cos(roll) * ca.cos(pitch)),
    )
    rate = rates @ v[3:6]
    angular = rates @ a[3:6] + ca.jtimes(rate, y[3:6], v[3:6])
    against_fall = a[:3] + ca.vertcat(0.0, 0.0, gravity)
    return rotation, _Motion(rate, angular, rotation.T @ v[:3], rotation.T @ against_fall)


def _leg_state(
    leg: JumpingLeg, base: _Motion, joints: tuple[ca.SX, ca.SX, ca.SX], force: ca.SX, up: ca.SX
) -> _LegState:
    """Inverse dynamics of one leg.

    Args:
        joints: positions, velocities and accelerations, shape (n, 1) each.
        force: of the ground on the foot, in B [N].
        up: the world's vertical in B.
    """
    links = _links(leg, base, joints)
    for link in links:
        force, up = link.rotation.T @ force, link.rotation.T @ up
    contact = _constant(leg.foot) - leg.foot_radius * up
    outboard = _Wrench(-force, -ca.cross(contact, force))
    momentum, mass_moment = _Wrench(ca.SX.zeros(3), ca.SX.zeros(3)), ca.SX.zeros(3)
    torques: list[ca.SX] = []
    # From the foot inwards: each joint carries everything beyond it.
    for link, mass, joint in reversed(list(zip(links, leg.bodies, leg.chain.joints, strict=True))):
        properties = SymbolicBody(ca.SX(mass.mass), _constant(mass.com), _constant(mass.inertia))
        outboard = outboard + _inertial_wrench(properties, link.motion)
        momentum = momentum + _momentum(properties, link.motion)
        mass_moment = mass_moment + properties.mass * (
            link.origin + link.placement @ properties.com
        )
        slides = joint.kind is JointKind.PRISMATIC
        carried_load = outboard.force if slides else outboard.moment
        torques.insert(0, ca.dot(_constant(joint.axis), carried_load))
        outboard = outboard.in_parent(link.rotation, link.offset)
        momentum = momentum.in_parent(link.rotation, link.offset)
    # Torque that the drives lose in the joints themselves.
    _, velocity, acceleration = joints
    resistance = [
        joint.armature * acceleration[i]
        + joint.damping * velocity[i]
        + joint.friction * ca.tanh(velocity[i] / _SLOW)
        for i, joint in enumerate(leg.chain.joints)
    ]
    last, hip = links[-1], links[leg.hip]
    foot = last.origin + last.placement @ _constant(leg.foot)
    span = foot - hip.origin
    axis = hip.placement @ _constant(leg.chain.joints[leg.hip].axis)
    return _LegState(
        torque=ca.vertcat(*torques) + ca.vertcat(*resistance),
        load=outboard,
        momentum=momentum,
        mass_moment=mass_moment,
        foot=foot,
        shank=last.placement,
        reach=ca.sumsqr(span - axis * ca.dot(axis, span)),
    )


def _links(leg: JumpingLeg, base: _Motion, joints: tuple[ca.SX, ca.SX, ca.SX]) -> list[_Link]:
    """Position and motion of a leg's bodies, from the trunk outwards."""
    position, velocity, acceleration = joints
    start = leg.chain.start
    rotation, offset = _constant(start.rotation), _constant(start.position)
    placement, origin, motion = ca.SX.eye(3), ca.SX.zeros(3), base
    links: list[_Link] = []
    for i, (body, joint) in enumerate(zip(leg.chain.bodies, leg.chain.joints, strict=True)):
        offset = offset + rotation @ _constant(body.placement.position)
        rotation = rotation @ _constant(body.placement.rotation)
        axis, slides = _constant(joint.axis), joint.kind is JointKind.PRISMATIC
        if slides:
            offset = offset + rotation @ axis * position[i]
        else:
            rotation = rotation @ _turn(joint.axis, position[i])
        carried = motion.carried(offset).seen_from(rotation)
        moved = carried.slid if slides else carried.turned
        motion = moved(axis, velocity[i], acceleration[i])
        origin, placement = origin + placement @ offset, placement @ rotation
        links.append(_Link(rotation, offset, placement, origin, motion))
        rotation, offset = ca.SX.eye(3), ca.SX.zeros(3)
    return links


def _inertial_wrench(body: SymbolicBody, motion: _Motion) -> _Wrench:
    """Wrench that accelerates a body, about the origin of its frame, which moves by `motion`."""
    force = body.mass * motion.carried(body.com).acceleration
    spin = body.inertia @ motion.rate
    moment = body.inertia @ motion.angular_acceleration + ca.cross(motion.rate, spin)
    return _Wrench(force, moment + ca.cross(body.com, force))


def _momentum(body: SymbolicBody, motion: _Motion) -> _Wrench:
    """Momentum of a body about the origin of its frame, which moves by `motion`."""
    linear = body.mass * motion.carried(body.com).velocity
    return _Wrench(linear, body.inertia @ motion.rate + ca.cross(body.com, linear))


def _constant(values: FloatArray) -> ca.SX:
    return ca.SX(ca.DM(np.array(values)))


def _turn(axis: FloatArray, angle: ca.SX) -> ca.SX:
    """Rotation about a fixed unit vector (Rodrigues), shape (3, 3).

    Sine and cosine multiply constant matrices, most of whose entries vanish for a coordinate axis.
    """
    along = np.outer(axis, axis)
    cross = ca.skew(_constant(axis))
    return _constant(along) + ca.cos(angle) * _constant(np.eye(3) - along) + ca.sin(angle) * cross
