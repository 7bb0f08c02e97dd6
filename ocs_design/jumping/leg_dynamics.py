"""One leg on a moving trunk: recursive Newton-Euler in symbols.

Featherstone, Rigid Body Dynamics Algorithms (2008), section 5.3, in vectors of the base frame B in
place of each body's own: what is common to all legs stays common. A linear acceleration is taken
against free fall, so that gravity needs no term of its own.
"""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.jumping.legged_body import JumpingLeg
from ocs_design.robot.tree import JointKind


@dataclass(frozen=True, eq=False)
class Motion:
    """Of a frame, in components of B, each of shape (3, 1).

    Attributes:
        rate, angular_acceleration: [rad/s], [rad/s^2].
        velocity: of the frame's origin [m/s].
        acceleration: of the frame's origin, less gravity's [m/s^2].
    """

    rate: ca.SX
    angular_acceleration: ca.SX
    velocity: ca.SX
    acceleration: ca.SX

    def carried(self, offset: ca.SX) -> "Motion":
        """Of a frame that is fixed to this one at `offset`."""
        return Motion(
            self.rate,
            self.angular_acceleration,
            self.velocity + ca.cross(self.rate, offset),
            self.acceleration
            + ca.cross(self.angular_acceleration, offset)
            + ca.cross(self.rate, ca.cross(self.rate, offset)),
        )

    def turned(self, axis: ca.SX, speed: ca.SX, acceleration: ca.SX) -> "Motion":
        """Of a frame that a hinge turns against this one."""
        spin = axis * speed
        return Motion(
            self.rate + spin,
            self.angular_acceleration + axis * acceleration + ca.cross(self.rate, spin),
            self.velocity,
            self.acceleration,
        )

    def slid(self, axis: ca.SX, speed: ca.SX, acceleration: ca.SX) -> "Motion":
        """Of a frame that a slide moves against this one, already at its place."""
        along = axis * speed
        return Motion(
            self.rate,
            self.angular_acceleration,
            self.velocity + along,
            self.acceleration + axis * acceleration + 2.0 * ca.cross(self.rate, along),
        )


@dataclass(frozen=True, eq=False)
class JointMotion:
    """Of joints, each of shape (n, 1) [rad or m, and per s, and per s^2]."""

    position: ca.SX
    velocity: ca.SX
    acceleration: ca.SX

    def of(self, which: slice) -> "JointMotion":
        """Of some of them."""
        return JointMotion(self.position[which], self.velocity[which], self.acceleration[which])


@dataclass(frozen=True, eq=False)
class Wrench:
    """A force and its moment about B's origin, in B; or a momentum and its moment."""

    force: ca.SX
    moment: ca.SX

    def __add__(self, other: "Wrench") -> "Wrench":
        return Wrench(self.force + other.force, self.moment + other.moment)

    def __sub__(self, other: "Wrench") -> "Wrench":
        return Wrench(self.force - other.force, self.moment - other.moment)

    @classmethod
    def zero(cls) -> "Wrench":
        """None at all."""
        return cls(ca.SX.zeros(3), ca.SX.zeros(3))

    @classmethod
    def at(cls, force: ca.SX, point: ca.SX) -> "Wrench":
        """A force that acts at a point."""
        return cls(force, ca.cross(point, force))


@dataclass(frozen=True, eq=False)
class LegState:
    """What a leg does under a trunk that moves.

    Attributes:
        torque: of its joints, friction and armature included [N m or N], shape (n, 1).
        load: what its inertia and the ground leave for the trunk to balance [N, N m].
        momentum: [kg m/s, kg m^2/s]. mass_moment: mass times centre of mass in B [kg m].
        foot: centre of the foot's ball in B [m]. shank: rotation of the last body in B.
        reach: square of the distance from the hip's axis to the foot [m^2].
    """

    torque: ca.SX
    load: Wrench
    momentum: Wrench
    mass_moment: ca.SX
    foot: ca.SX
    shank: ca.SX
    reach: ca.SX


@dataclass(frozen=True, eq=False)
class SymbolicBody:
    """Mass [kg], centre of mass [m] and inertia about it [kg m^2] in symbols, in B's axes."""

    mass: ca.SX
    com: ca.SX
    inertia: ca.SX


def inertial_wrench(body: SymbolicBody, motion: Motion, center: ca.SX) -> Wrench:
    """What it takes to accelerate a body, about B's origin.

    Args:
        body: its inertia in B's axes.
        motion: of its centre of mass.
        center: of mass, from B's origin [m].
    """
    force = body.mass * motion.acceleration
    inertia = body.inertia
    spin = inertia @ motion.rate
    moment = inertia @ motion.angular_acceleration + ca.cross(motion.rate, spin)
    return Wrench(force, moment + ca.cross(center, force))


def momentum_of(body: SymbolicBody, motion: Motion, center: ca.SX) -> Wrench:
    """Linear and angular momentum about B's origin; arguments as for `inertial_wrench`."""
    linear = body.mass * motion.velocity
    return Wrench(linear, body.inertia @ motion.rate + ca.cross(center, linear))


def leg_dynamics(
    leg: JumpingLeg, base: Motion, joints: JointMotion, *, force: ca.SX, up: ca.SX
) -> LegState:
    """Inverse dynamics of one leg.

    Args:
        leg: its parameters.
        base: motion of B.
        joints: of the leg.
        force: of the ground on the foot, in B [N].
        up: the world's vertical in B.
    """
    links = _outwards(leg, base, joints)
    last, hip = links[-1], links[leg.hip]
    foot = last.origin + last.rotation @ _constant(leg.foot)
    beyond = Wrench.zero() - Wrench.at(force, foot - leg.foot_radius * up)
    torques: list[ca.SX] = []
    momentum, mass_moment = Wrench.zero(), ca.SX.zeros(3)
    # From the foot inwards: each joint bears all that is beyond it.
    for link in reversed(links):
        beyond = beyond + inertial_wrench(link.body, link.motion, link.center)
        momentum = momentum + momentum_of(link.body, link.motion, link.center)
        mass_moment = mass_moment + link.body.mass * link.center
        torques.insert(0, link.borne(beyond))
    span = foot - hip.origin
    across = span - hip.axis * ca.dot(hip.axis, span)
    return LegState(
        torque=ca.vertcat(*torques) + _resistance(leg, joints),
        load=beyond,
        momentum=momentum,
        mass_moment=mass_moment,
        foot=foot,
        shank=last.rotation,
        reach=ca.sumsqr(across),
    )


@dataclass(frozen=True, eq=False)
class _Link:
    """One body of a leg in B.

    Attributes:
        axis, origin: of its joint. slides: whether that is prismatic.
        rotation: of the body's frame.
        body: its inertia. motion: of its centre of mass. center: where that is.
    """

    axis: ca.SX
    origin: ca.SX
    slides: bool
    rotation: ca.SX
    body: SymbolicBody
    motion: Motion
    center: ca.SX

    def borne(self, beyond: Wrench) -> ca.SX:
        """Share of a wrench that the joint's drive must give."""
        if self.slides:
            return ca.dot(self.axis, beyond.force)
        return ca.dot(self.axis, beyond.moment - ca.cross(self.origin, beyond.force))


def _outwards(leg: JumpingLeg, base: Motion, joints: JointMotion) -> list[_Link]:
    """Where the leg's bodies are and how they move."""
    rotation, origin = _constant(leg.chain.start.rotation), _constant(leg.chain.start.position)
    motion, links = base.carried(origin), []
    for i, (body, mass) in enumerate(zip(leg.chain.bodies, leg.bodies, strict=True)):
        joint, speed, push = leg.chain.joints[i], joints.velocity[i], joints.acceleration[i]
        offset = rotation @ _constant(body.placement.position)
        rotation = rotation @ _constant(body.placement.rotation)
        axis = rotation @ _constant(joint.axis)
        slides = joint.kind is JointKind.PRISMATIC
        if slides:
            offset = offset + axis * joints.position[i]
            motion = motion.carried(offset).slid(axis, speed, push)
        else:
            motion = motion.carried(offset).turned(axis, speed, push)
            rotation = rotation @ _turn(joint.axis, joints.position[i])
        origin = origin + offset
        lever = rotation @ _constant(mass.com)
        inertia = rotation @ _constant(mass.inertia) @ rotation.T
        own = SymbolicBody(ca.SX(mass.mass), lever, inertia)
        at_com = motion.carried(lever)
        links.append(_Link(axis, origin, slides, rotation, own, at_com, origin + lever))
    return links


_SLOW = 0.1
"""Speed over which dry friction changes sign [rad/s or m/s]: a step has no derivative."""


def _resistance(leg: JumpingLeg, joints: JointMotion) -> ca.SX:
    """What the joints themselves take of their drives."""
    return ca.vertcat(
        *(
            joint.armature * joints.acceleration[i]
            + joint.damping * joints.velocity[i]
            + joint.friction * ca.tanh(joints.velocity[i] / _SLOW)
            for i, joint in enumerate(leg.chain.joints)
        )
    )


def _constant(values: FloatArray) -> ca.SX:
    return ca.SX(ca.DM(np.array(values)))


def _turn(axis: FloatArray, angle: ca.SX) -> ca.SX:
    """Rotation about a fixed unit vector (Rodrigues), shape (3, 3)."""
    cross = ca.skew(_constant(axis))
    return ca.SX.eye(3) + ca.sin(angle) * cross + (1.0 - ca.cos(angle)) * (cross @ cross)
