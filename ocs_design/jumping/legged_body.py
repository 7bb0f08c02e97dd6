"""A robot as a trunk with legs: all bodies outside the legs are locked to the trunk."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.robot.chain import Chain
from ocs_design.robot.leg_geometry import leg_geometries, up_axis
from ocs_design.robot.legs import is_wheel
from ocs_design.robot.mass import MassProperties, combine
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Joint

_FEWEST_JOINTS = 3
"""Fewest joints with which a leg keeps its foot in place while the trunk moves in all six
directions."""


@dataclass(frozen=True, eq=False)
class JumpingLeg:
    """One leg, with its chain relative to the base frame B.

    Attributes:
        chain: from the trunk to the foot.
        bodies: mass properties of each body of the chain in its own frame, including everything
            attached to it that is not part of the chain.
        foot: centre of the foot's ball in the last body's frame [m], shape (3,).
        foot_radius: of that ball [m].
        hip: index in the chain of the hip pitch joint.
        length: of the stretched leg [m].
    """

    chain: Chain
    bodies: tuple[MassProperties, ...]
    foot: FloatArray
    foot_radius: float
    hip: int
    length: float


@dataclass(frozen=True, eq=False)
class LeggedBody:
    """Model of a robot for push-offs.

    Attributes:
        trunk: mass properties of everything outside the legs, in B.
        joints: of all legs, in their order.
        posture: of those joints in the nominal stance [rad or m], shape (n,).
        height: of B's origin over the ground in the nominal stance [m].
    """

    trunk: MassProperties
    legs: tuple[JumpingLeg, ...]
    joints: tuple[Joint, ...]
    posture: FloatArray
    height: float

    @classmethod
    def of(cls, robot: Robot) -> "LeggedBody":
        """Trunk and legs of a robot for which `obstacle_to_jumping` is empty."""
        geometries = leg_geometries(robot.tree, robot.trunk, robot.legs)
        tree = robot.tree
        index = {body.name: i for i, body in enumerate(tree.bodies)}
        # Mass properties by index of the body that carries them; -1 is the trunk, in B.
        in_chain = {index[body.name] for geometry in geometries for body in geometry.chain.bodies}
        placements = tree.placements_from(robot.trunk, robot.posture)
        carried: dict[int, list[MassProperties]] = {-1: []}
        for i, body in enumerate(tree.bodies):
            carrier = i
            while carrier >= 0 and carrier not in in_chain:
                carrier = tree.bodies[carrier].parent
            place = placements[i] if carrier < 0 else placements[carrier].inverse() @ placements[i]
            part = body.mass_properties.moved(place.rotation, place.position)
            carried.setdefault(carrier, []).append(part)
        masses = {carrier: combine(parts) for carrier, parts in carried.items()}
        legs = tuple(
            JumpingLeg(
                chain=geometry.chain,
                bodies=tuple(masses[index[body.name]] for body in geometry.chain.bodies),
                foot=geometry.leg.foot,
                foot_radius=geometry.leg.foot_radius,
                hip=geometry.chain.driven[geometry.plane.pitch[0]],
                length=geometry.leg.length,
            )
            for geometry in geometries
        )
        joints = tuple(joint for leg in legs for joint in leg.chain.joints)
        assert robot.standing_height is not None
        return cls(
            trunk=masses[-1],
            legs=legs,
            joints=joints,
            posture=np.array([robot.posture[joint.name] for joint in joints]),
            height=robot.standing_height,
        )

    @property
    def length(self) -> float:
        """Mean length of the stretched legs [m]."""
        return float(np.mean([leg.length for leg in self.legs]))

    @property
    def leg_mass(self) -> float:
        """Mass of all legs [kg]."""
        return float(sum(body.mass for leg in self.legs for body in leg.bodies))

    @property
    def joint_slices(self) -> Iterator[tuple[JumpingLeg, slice]]:
        """Each leg with the slice of its joints among all joints."""
        first = 0
        for leg in self.legs:
            last = first + len(leg.chain.joints)
            yield leg, slice(first, last)
            first = last


def obstacle_to_jumping(robot: Robot) -> str:
    """Reason why no push-off can be planned for a robot, as a clause; empty if one can."""
    if not robot.legs:
        return "the robot has no legs"
    if up_axis(robot.tree, robot.trunk, robot.legs)[2] != 1.0:
        return "the legs do not hang along -z of the trunk frame"
    for geometry in leg_geometries(robot.tree, robot.trunk, robot.legs):
        leg, joints, obstacle = f"the leg '{geometry.leg.name}'", geometry.chain.joints, ""
        if is_wheel(geometry.chain.bodies[-1]):
            obstacle = f"{leg} ends in a wheel"
        elif geometry.plane.flat:
            obstacle = f"{leg} stands on a sole, not on a point"
        elif any(joint.mimic is not None for joint in joints):
            obstacle = f"{leg} has coupled joints"
        elif len(joints) < _FEWEST_JOINTS:
            obstacle = f"{leg} has fewer than {_FEWEST_JOINTS} joints"
        if obstacle:
            return obstacle
    return ""
