"""How the robot's inertia moves with its posture."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance.leg_geometry import LegGeometry, leg_geometries, up_axis
from ocs_design.robot.stance.posture import STAND, ZERO
from ocs_design.robot.stance.stand import SHARE_OF_LEG, stand

_SHARES = (0.6, 0.7, 0.8, 0.9)
_ABDUCTIONS = (0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True, eq=False)
class PostureRow:
    """The robot in one posture.

    Attributes:
        label: what the posture is.
        mass_properties: of the whole robot with its joints held, in B.
    """

    label: str
    mass_properties: MassProperties


def posture_sensitivity(robot: Robot) -> tuple[PostureRow, ...]:
    """The locked inertia over plausible postures.

    They are the nominal one, all joints at zero, standing at 60 to 90 % of the stretched legs,
    standing with the legs spread sideways by 0.25 to 1 rad, and what the file names. Postures that
    joint limits forbid are left out.
    """
    return tuple(
        PostureRow(label, robot.tree.locked_mass_properties(values, robot.trunk))
        for label, values in _postures(robot)
    )


def _postures(robot: Robot) -> Iterator[tuple[str, Mapping[str, float]]]:
    yield f"nominal ({robot.posture_name})", robot.posture
    yield ZERO, {}
    for share in _SHARES if robot.legs else ():
        found = stand(robot.tree, robot.trunk, robot.legs, share)
        if found is not None and found.share == share and not found.warnings:
            yield f"{STAND} at {share:.0%} of the leg", found.posture
    yield from _spread(robot)
    yield from robot.tree.named_postures.items()


def _spread(robot: Robot) -> Iterator[tuple[str, Mapping[str, float]]]:
    """Standing, with every leg turned outwards about its abduction joint."""
    found = stand(robot.tree, robot.trunk, robot.legs, SHARE_OF_LEG)
    if found is None:
        return
    outwards = _outward_joints(robot)
    for angle in _ABDUCTIONS if outwards else ():
        turned = {name: found.posture[name] + sign * angle for name, sign in outwards.items()}
        joints = robot.tree.joints
        if all(joints[name].lower <= value <= joints[name].upper for name, value in turned.items()):
            yield f"legs spread by {angle:g} rad", {**found.posture, **turned}


def _outward_joints(robot: Robot) -> Mapping[str, float]:
    """Abduction joint of each leg and the sign that turns it outwards; empty if a leg has none."""
    up = up_axis(robot.tree, robot.trunk, robot.legs)
    geometries = leg_geometries(robot.tree, robot.trunk, robot.legs)
    middle = np.mean([each.plane.hip for each in geometries], axis=0)
    found = [_outward_joint(each, up, middle) for each in geometries]
    return {} if None in found else dict(pair for pair in found if pair is not None)


def _outward_joint(
    each: LegGeometry, up: FloatArray, middle: FloatArray
) -> tuple[str, float] | None:
    """The first joint of a leg above its knee whose axis points forward."""
    plane, chain = each.plane, each.chain
    zero = chain.pose(np.zeros(len(chain.driven)))
    knee = plane.pitch[min(1, len(plane.pitch) - 1)]
    outwards = plane.axis * (plane.axis @ (plane.hip - middle))
    for column in plane.columns[:knee]:
        axis = zero.axes[chain.driven[column]]
        if abs(axis @ plane.forward) > 0.9:
            return chain.names[column], float(np.sign(np.cross(axis, -up) @ outwards))
    return None
