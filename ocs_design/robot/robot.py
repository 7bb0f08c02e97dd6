"""The robot as every later step sees it: one frozen value."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.tree import Placement, Tree

if TYPE_CHECKING:
    # It holds legs of this module.
    from ocs_design.robot.recognition import Recognition


class Format(StrEnum):
    """Kind of description that a robot was read from."""

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
        foot_radius: of a sphere around `foot` that reaches the sole; 0 for a bare point [m].
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
    """Base frame B of a robot of which no link has x forward and z up.

    Attributes:
        link: of the file that B is fixed to.
        placement: of B in that link's frame.
    """

    link: str
    placement: Placement


@dataclass(frozen=True, eq=False)
class Robot:
    """A robot at its nominal posture.

    Attributes:
        name: from the file, or given.
        source: path as the user wrote it, `-` for standard input, `by hand`.
        sha256: of the bytes that were read; empty by hand.
        format: see `Format`.
        content: the file's text as bytes, unzipped and expanded; empty by hand.
        tree: moving bodies; by hand, one body with the homogeneous box of the same inertia.
        trunk: link that carries the device; its frame is the base frame B; see also `mount`.
        floating_base: link of the tree's root.
        posture: value of every moving joint [rad or m].
        posture_name: `zero`, `stand`, the name of a keyframe or SRDF state, with ` + joints` if
            some were set one by one.
        mass_properties: of the whole robot with its joints held at `posture`, in B.
        legs: found legs, in file order; empty if none.
        standing_height: of the trunk frame's origin over the feet at `posture` [m]; None without
            legs.
        warnings: one sentence each, naming the link or joint.
        mount: how B is fixed to the file's own link; None if `trunk` is a link of the file.
        recognition: how sure trunk and legs are, and what else they may be; None by hand.
        mesh_cure: how the meshes that were not found would be; empty: none is missing.
    """

    name: str
    source: str
    sha256: str
    format: Format
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
    recognition: "Recognition | None" = None
    mesh_cure: str = ""

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

    @property
    def gyration_radius(self) -> float:
        """Radius of gyration sqrt(trace(I) / m) [m]: a length that needs no geometry."""
        return float(np.sqrt(np.trace(self.inertia) / self.mass))

    def __repr__(self) -> str:
        return (
            f"<Robot {self.name}: {self.mass:.4g} kg, {len(self.tree.joints)} joints, "
            f"{len(self.legs)} legs, trunk {self.trunk}, posture {self.posture_name}>"
        )
