"""The nominal posture of a robot, and its inertia in other postures."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.common.errors import RobotError, closest
from ocs_design.common.wording import some_of
from ocs_design.robot.chain import neutral_posture
from ocs_design.robot.leg_geometry import leg_geometries, sole_depths
from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Leg, Robot
from ocs_design.robot.stance import SHARE_OF_LEG, stand
from ocs_design.robot.tree import LARGEST_NUMBER, Tree

ZERO = "zero"
STAND = "stand"
OUTSIDE = "the posture is outside the limits of:"
"""Start of a warning about joints beyond their limits."""

_LIMIT_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Posture:
    """Posture of a robot, with the name by which it was requested.

    Attributes:
        values: of every moving joint [rad or m].
        name: `zero`, `stand` or the name in the file, with ` + joints` if some were set one by one.
        standing_height: of the trunk frame's origin above the lowest sole [m]; None without legs.
        warnings: oddities, one sentence each.
    """

    values: Mapping[str, float]
    name: str
    standing_height: float | None
    warnings: tuple[str, ...]


def resolve_posture(
    tree: Tree, trunk: str, legs: Sequence[Leg], name: str | None, joints: Mapping[str, float]
) -> Posture:
    """The posture that the user requests.

    Args:
        tree: of the robot.
        trunk: link whose frame is B.
        legs: of the robot; may be empty.
        name: `zero`, `stand`, or a posture named in the file, whose missing joints are at zero or
            at the limit nearest to it; None: `stand` for a robot with legs, else `zero`.
        joints: values that replace the posture's [rad or m].
    """
    name = name or (STAND if legs else ZERO)
    warnings: tuple[str, ...] = ()
    chosen: Mapping[str, float] = {}
    if name == STAND:
        if not legs:
            raise RobotError(
                "no legs were found, so there is no posture 'stand'",
                hint="use --posture zero, a posture named in the file, or --joint NAME=VALUE",
            )
        standing = stand(tree, trunk, legs)
        chosen, warnings = standing.posture, standing.warnings
    elif name != ZERO:
        if name not in tree.named_postures:
            known = [ZERO, *([STAND] if legs else []), *tree.named_postures]
            raise unknown_name("posture", name, known)
        chosen = {**neutral_posture(tree), **tree.named_postures[name]}
    if name in {ZERO, STAND} and name in tree.named_postures:
        why = "the built-in one has the same name"
        warnings += (f"the file's own posture '{name}' is not used: {why}",)
    for joint, value in joints.items():
        if joint not in tree.joints:
            raise unknown_name("moving joint", joint, tree.joints)
        if not abs(value) <= LARGEST_NUMBER:
            raise RobotError(f"joint '{joint}' cannot be at {value}", hint="give a finite number")
        mimic = tree.joints[joint].mimic
        if mimic is not None and mimic[0] in tree.joints:
            raise RobotError(
                f"joint '{joint}' follows joint '{mimic[0]}'", hint=f"set '{mimic[0]}' instead"
            )
    values = tree.complete({**tree.complete(chosen), **joints})
    outside = [
        joint
        for joint, limits in tree.joints.items()
        if not limits.lower - _LIMIT_TOLERANCE <= values[joint] <= limits.upper + _LIMIT_TOLERANCE
    ]
    if outside:
        warnings += (f"{OUTSIDE} {some_of(outside)}",)
    height = max(sole_depths(tree, trunk, legs, values)) if legs else None
    return Posture(values, f"{name} + joints" if joints else name, height, warnings)


def unknown_name(kind: str, name: str, known: Iterable[str]) -> RobotError:
    """Error for a name that the robot does not have, listing its names, the closest first."""
    ordered = sorted(known)
    close = closest(name, ordered, most=max(len(ordered), 1), cutoff=0.5)
    ordered = list(dict.fromkeys([*close, *ordered]))
    available = f"available: {some_of(ordered, most=12) if ordered else 'none'}"
    likely = f"did you mean '{ordered[0]}'? " if close else ""
    return RobotError(f"the robot has no {kind} '{name}'", hint=likely + available)


_SHARES = (0.6, 0.7, SHARE_OF_LEG, 0.9)
_ABDUCTIONS = (0.25, 0.5, 0.75, 1.0)


def posture_sensitivity(robot: Robot) -> Mapping[str, MassProperties]:
    """Locked mass properties of the robot in B, for each plausible posture by its description.

    The postures are the nominal one, all joints at zero, standing at 60 to 90 % of the stretched
    legs, standing with the legs spread sideways by 0.25 to 1 rad, and those named in the file, as
    `resolve_posture` reads them. Postures that joint limits forbid are left out.
    """
    tree, legs = robot.tree, robot.legs
    postures = [(f"nominal ({robot.posture_name})", robot.posture), (ZERO, {})]
    stands = {share: stand(tree, robot.trunk, legs, share) for share in _SHARES if legs}
    for share, standing in stands.items():
        if standing.share == share and not standing.warnings:
            postures.append((f"{STAND} at {share:.0%} of the leg", standing.posture))
    outwards, joints = _outward_joints(robot) if legs else {}, tree.joints
    for angle in _ABDUCTIONS if outwards else ():
        usual = stands[SHARE_OF_LEG].posture
        turned = {name: usual[name] + sign * angle for name, sign in outwards.items()}
        if all(joints[name].lower <= value <= joints[name].upper for name, value in turned.items()):
            postures.append((f"legs spread by {angle:g} rad", {**usual, **turned}))
    # As in `resolve_posture`: the names of the built-in postures are reserved.
    filled = neutral_posture(tree)
    postures += (
        (name, {**filled, **values})
        for name, values in tree.named_postures.items()
        if name not in {ZERO, STAND}
    )
    return {label: tree.locked_mass_properties(values, robot.trunk) for label, values in postures}


def _outward_joints(robot: Robot) -> Mapping[str, float]:
    """Abduction joint of each leg and the sign of outward rotation; empty if a leg has none."""
    geometries = leg_geometries(robot.tree, robot.trunk, robot.legs)
    middle = np.mean([geometry.plane.hip for geometry in geometries], axis=0)
    signs = {}
    for geometry in geometries:
        plane, chain = geometry.plane, geometry.chain
        level = chain.pose(plane.level)
        knee = plane.pitch[min(1, len(plane.pitch) - 1)]
        outwards = plane.axis * (plane.axis @ (plane.hip - middle))
        # The first joint above the knee whose axis points forward.
        axes = ((column, level.axes[chain.driven[column]]) for column in plane.columns[:knee])
        first = next((pair for pair in axes if abs(pair[1] @ plane.forward) > 0.9), None)
        if first is None:
            return {}
        column, axis = first
        signs[chain.names[column]] = float(np.sign(np.cross(axis, -geometry.up) @ outwards))
    return signs
