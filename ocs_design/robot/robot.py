"""The robot as one frozen value for all later steps, and how trunk and legs were recognised."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.tree import Tree


class RobotFormat(StrEnum):
    """Format of the description from which a robot was read."""

    URDF = "urdf"
    MJCF = "mjcf"
    MANUAL = "manual"


@dataclass(frozen=True, eq=False)
class Leg:
    """A chain that ends in a foot.

    Attributes:
        name: of the foot's link.
        body: index of the foot's body in `Tree.bodies`.
        joints: moving joints from the trunk to the foot, mimics left out.
        foot: the point that touches the ground, in the foot body's frame [m], shape (3,).
        foot_radius: of the sphere around `foot` that touches the sole; 0 for a bare point [m].
        length: of the stretched leg within its limits, hip pitch axis to foot [m].
        base: index of the body that the leg branches from: the trunk, or the end of a spine.
        up: unit vector against gravity in the frame of `base`, the robot standing, shape (3,).
    """

    name: str
    body: int
    joints: tuple[str, ...]
    foot: FloatArray
    foot_radius: float
    length: float
    base: int
    up: FloatArray


@dataclass(frozen=True, eq=False)
class Mount:
    """Base frame B of a robot that has no link with x forward and z up.

    Attributes:
        link: of the file, to which B is fixed.
        placement: of B in that link's frame.
    """

    link: str
    placement: Placement


NO_LEGS = "none"
"""In place of the legs' names: the robot has no legs."""

SPINE = (
    "the legs branch from several bodies with joints between them (a spine), which are locked at "
    "zero"
)
CLOSED = (
    "limbs share a hip in pairs, as in five-bar legs whose loop is open in the file: one of each "
    "pair is the leg, and the other is locked at zero"
)
JOINED = (
    "limbs meet at their ends, as in a closed chain, which is cut open there: each moves as if it "
    "ended there"
)


@dataclass(frozen=True)
class Evidence:
    """A sign that a person would look at.

    Attributes:
        what: sentence if it holds. against: sentence if it does not.
        holds: whether it does; None if the file does not say.
        weight: relative to other signs.
    """

    what: str
    against: str
    holds: bool | None
    weight: float = 1.0


@dataclass(frozen=True)
class Doubt:
    """Something that speaks against a reading, however good its signs.

    Attributes:
        what: as a sentence.
        factor: by which it lowers the confidence.
    """

    what: str
    factor: float


@dataclass(frozen=True, eq=False)
class Reading:
    """One way to read a robot.

    Attributes:
        trunk: link that carries the device.
        legs: in file order; empty for a robot without.
        signs: by which it is judged.
        doubts: that lower its confidence.
    """

    trunk: str
    legs: tuple[Leg, ...]
    signs: tuple[Evidence, ...]
    doubts: tuple[Doubt, ...] = ()

    @cached_property
    def confidence(self) -> float:
        """Share of the known signs that hold, by weight, times the factors of the doubts."""
        known = [sign for sign in self.signs if sign.holds is not None]
        total = sum(sign.weight for sign in known)
        holding = sum(sign.weight for sign in known if sign.holds)
        share = holding / total if total else 0.5
        return share * float(np.prod([doubt.factor for doubt in self.doubts]))

    @property
    def simplifications(self) -> tuple[str, ...]:
        """Simplifications of the real robot, one sentence each."""
        return tuple(doubt.what for doubt in self.doubts if doubt.what in {SPINE, CLOSED, JOINED})

    @property
    def options(self) -> str:
        """The command-line options that specify it."""
        return f"--trunk {self.trunk} --legs {','.join(leg.name for leg in self.legs) or NO_LEGS}"


@dataclass(frozen=True, eq=False)
class Recognition:
    """What was recognised of a robot.

    Attributes:
        reading: with which the program continues.
        likely: readings to choose from if it is not sure, the likeliest first.
        specified: what the user named: nothing, `trunk`, `legs` or both.
    """

    reading: Reading
    likely: tuple[Reading, ...] = ()
    specified: frozenset[str] = field(default_factory=frozenset)

    @property
    def sure(self) -> bool:
        """Whether the user need not be asked."""
        return not self.likely


@dataclass(frozen=True, eq=False)
class Robot:
    """A robot at its nominal posture.

    Attributes:
        name: from the file, or given.
        source: path as the user wrote it, `-` for standard input, `by hand`.
        sha256: of the bytes that were read; empty by hand.
        format: see `RobotFormat`.
        content: the file's text as bytes, unzipped and expanded; empty by hand.
        tree: moving bodies; by hand, one body with the homogeneous box of the same inertia.
        trunk: link that carries the device; its frame is the base frame B; see also `mount`.
        floating_base: link of the tree's root.
        posture: value of every moving joint [rad or m].
        posture_name: `zero`, `stand`, the name of a keyframe or SRDF state, with ` + joints` if
            some were set one by one.
        mass_properties: of the whole robot with its joints held at `posture`, in B.
        legs: found legs, in file order; empty if none.
        standing_height: of the trunk frame's origin above the feet at `posture` [m]; None without
            legs.
        warnings: one sentence each, naming the link or joint.
        mount: how B is fixed to the file's own link; None if `trunk` is a link of the file.
        recognition: confidence in trunk and legs, and what else they may be; None by hand.
        mesh_cure: how to make the missing meshes found; empty: none is missing.
        worn_at: point in B around which modules sit on a person's back [m]; None: not a person.
    """

    name: str
    source: str
    sha256: str
    format: RobotFormat
    content: bytes
    tree: Tree
    trunk: str
    floating_base: str
    posture: Mapping[str, float]
    posture_name: str
    mass_properties: MassProperties
    legs: tuple[Leg, ...]
    standing_height: float | None
    warnings: tuple[str, ...]
    mount: Mount | None = None
    recognition: Recognition | None = None
    mesh_cure: str = ""
    worn_at: tuple[float, float, float] | None = None

    @property
    def mass(self) -> float:
        """Mass of the whole robot [kg]."""
        return self.mass_properties.mass

    @property
    def com(self) -> FloatArray:
        """Centre of mass in B [m], shape (3,)."""
        return self.mass_properties.com

    @property
    def inertia(self) -> FloatArray:
        """Locked inertia about the centre of mass in B [kg m^2], shape (3, 3)."""
        return self.mass_properties.inertia

    def __repr__(self) -> str:
        return (
            f"<Robot {self.name}: {self.mass:.4g} kg, {len(self.tree.joints)} joints, "
            f"{len(self.legs)} legs, trunk {self.trunk}, posture {self.posture_name}>"
        )
