"""Kinematic tree: moving bodies with their joints, placements and mass properties.

A reader merges everything that is rigidly joined into one `Body`; only moving joints remain, each
with one degree of freedom. Mass properties are the file's raw numbers.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from itertools import takewhile
from pathlib import Path

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement, rotation_about
from ocs_design.robot.mass import MassProperties, combine

LARGEST_NUMBER = 1e75
"""Largest number in a robot (SI): the fourth power of a larger one would overflow."""


class JointKind(StrEnum):
    """Motion of a body relative to its parent."""

    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"


class ShapeKind(StrEnum):
    """Shapes of links; `size` has the parameters of MuJoCo's geom of that name, in metres.

    box: half extents (3); sphere: radius; cylinder and capsule: radius, half length along z;
    mesh: scale factors (3).
    """

    BOX = "box"
    SPHERE = "sphere"
    CYLINDER = "cylinder"
    CAPSULE = "capsule"
    MESH = "mesh"


@dataclass(frozen=True, eq=False)
class Shape:
    """One collision or visual shape, placed in its body's frame.

    Attributes:
        kind: see `ShapeKind`.
        size: see `ShapeKind` [m].
        position: of the shape's frame [m], shape (3,).
        rotation: of the shape's frame, shape (3, 3).
        link: to which it belongs.
        collides: whether it is collision geometry (else visual).
        mesh: the mesh file if `kind` is MESH and the file was found, else None.
        color: red, green, blue and opacity, 0..1; None if not specified.
    """

    kind: ShapeKind
    size: tuple[float, ...]
    position: FloatArray
    rotation: FloatArray
    link: str
    collides: bool
    mesh: Path | None = None
    color: tuple[float, float, float, float] | None = None


@dataclass(frozen=True, eq=False)
class Joint:
    """A moving joint.

    Attributes:
        name: as in the file.
        kind: revolute (also "continuous" and "hinge") or prismatic (also "slide").
        axis: unit vector in the body's frame, shape (3,).
        lower, upper: limits [rad or m]; -inf and inf if the file has none, or invalid ones.
        effort: largest torque or force of the drive [N m or N]; inf if not specified.
        velocity: largest speed [rad/s or m/s]; inf if not specified.
        damping: [N m s/rad or N s/m]. friction: [N m or N]. armature: [kg m^2 or kg].
        mimic: (joint, multiplier, offset) if this joint follows another, which itself follows none.
    """

    name: str
    kind: JointKind
    axis: FloatArray
    lower: float = -np.inf
    upper: float = np.inf
    effort: float = np.inf
    velocity: float = np.inf
    damping: float = 0.0
    friction: float = 0.0
    armature: float = 0.0
    mimic: tuple[str, float, float] | None = None


@dataclass(frozen=True, eq=False)
class Body:
    """A moving body: one or more links of the file, rigidly joined.

    Attributes:
        name: of the link that the joint moves; its frame is the body's frame, except where a MJCF
            joint is anchored elsewhere (see `links`). MJCF bodies with several joints are split
            into massless bodies named `<body>:<joint>` in front of the last.
        parent: index of the parent body in `Tree.bodies`; -1 for the root. Parents come first.
        placement: of the body's frame in its parent's frame when the joint is at zero.
        joint: by which it moves relative to its parent; None for the root.
        mass_properties: raw, in the body's frame.
        links: each link of the file that is part of the body, with its frame in the body's frame.
        link_masses: [kg] of each link in `links`.
        shapes: in the body's frame.
    """

    name: str
    parent: int
    placement: Placement
    joint: Joint | None
    mass_properties: MassProperties
    links: Mapping[str, Placement]
    link_masses: Mapping[str, float]
    shapes: tuple[Shape, ...] = ()


@dataclass(frozen=True, eq=False)
class Tree:
    """A robot as a tree of moving bodies with a free root.

    Attributes:
        name: of the robot.
        bodies: parents before children; `bodies[0]` is the floating base.
        named_postures: joint values [rad or m] by posture name, from MJCF keyframes or an SRDF.
        warnings: oddities in the file and how they were read, one sentence each.
        floats: whether the root moves freely in the world; None if the file does not say.
        loops: pairs of links that the file ties together, closing a chain.
    """

    name: str
    bodies: tuple[Body, ...]
    named_postures: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    floats: bool | None = None
    loops: tuple[tuple[str, str], ...] = ()

    @cached_property
    def joints(self) -> Mapping[str, Joint]:
        """Moving joints by name, in tree order."""
        return {body.joint.name: body.joint for body in self.bodies if body.joint is not None}

    @cached_property
    def body_of_link(self) -> Mapping[str, int]:
        """Index of the body that each link of the file belongs to."""
        return {link: index for index, body in enumerate(self.bodies) for link in body.links}

    def ancestors(self, body: int) -> Iterator[int]:
        """Index of the body itself, of its parent and so on to the root."""
        while body >= 0:
            yield body
            body = self.bodies[body].parent

    def path(self, base: int, last: int) -> list[int]:
        """Indices of the bodies from the first below `base` to `last`, its descendant."""
        return list(takewhile(lambda body: body != base, self.ancestors(last)))[::-1]

    def placements(self, posture: Mapping[str, float]) -> tuple[Placement, ...]:
        """Frame of each body in the root's frame; joints missing in `posture` are at zero."""
        values = self.complete(posture)
        placed: list[Placement] = []
        for body in self.bodies:
            if body.joint is None:
                placed.append(Placement.identity())
                continue
            motion = joint_motion(body.joint, values[body.joint.name])
            placed.append(placed[body.parent] @ body.placement @ motion)
        return tuple(placed)

    def placements_from(self, link: str, posture: Mapping[str, float]) -> tuple[Placement, ...]:
        """Frame of each body in the frame of `link`; joints missing in `posture` are at zero."""
        placements = self.placements(posture)
        index = self.body_of_link[link]
        to_link = (placements[index] @ self.bodies[index].links[link]).inverse()
        return tuple(to_link @ placement for placement in placements)

    def complete(self, posture: Mapping[str, float]) -> dict[str, float]:
        """Every joint's value: as given, or zero; joints that mimic another follow it."""
        values = {name: float(posture.get(name, 0.0)) for name in self.joints}
        for name, joint in self.joints.items():
            if joint.mimic is not None and joint.mimic[0] in values:
                leader, multiplier, offset = joint.mimic
                values[name] = multiplier * values[leader] + offset
        return values

    def locked_mass_properties(self, posture: Mapping[str, float], link: str) -> MassProperties:
        """Mass properties of the robot with its joints held at `posture`, in the frame of `link`.

        The composite rigid body of Featherstone (2008), section 6.2; Pinocchio calls its inertia
        `data.Ig` after `ccrba`.
        """
        return combine(self.mass_properties_at(self.placements_from(link, posture)))

    def mass_properties_at(self, placements: Sequence[Placement]) -> list[MassProperties]:
        """Mass properties of each body in the frame of the placements."""
        return [
            body.mass_properties.moved(place.rotation, place.position)
            for body, place in zip(self.bodies, placements, strict=True)
        ]


def joint_motion(joint: Joint, value: float) -> Placement:
    """Displacement of a joint's body at `value` [rad or m], in the body's own frame at zero."""
    if joint.kind is JointKind.PRISMATIC:
        return Placement(np.eye(3), value * joint.axis)
    return Placement(rotation_about(joint.axis, value), np.zeros(3))
