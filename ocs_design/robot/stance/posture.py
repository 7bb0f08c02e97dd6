"""Which posture the robot is measured in."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches

from ocs_design.exceptions import RobotError
from ocs_design.robot.remarks import listed
from ocs_design.robot.robot import Leg
from ocs_design.robot.stance.chain import neutral_posture
from ocs_design.robot.stance.leg_geometry import standing_height
from ocs_design.robot.stance.stand import stand
from ocs_design.robot.tree import LARGEST_NUMBER, Tree

ZERO = "zero"
STAND = "stand"
_LIMIT_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class Posture:
    """A posture and where it comes from.

    Attributes:
        values: of every moving joint [rad or m].
        name: `zero`, `stand` or the name in the file, with ` + joints` if some were set one by one.
        standing_height: of the trunk frame's origin over the lowest sole [m]; None without legs.
        warnings: what is odd about it, one sentence each.
    """

    values: Mapping[str, float]
    name: str
    standing_height: float | None
    warnings: tuple[str, ...]


def resolve_posture(
    tree: Tree,
    trunk: str,
    legs: Sequence[Leg],
    name: str | None,
    joints: Mapping[str, float],
) -> Posture:
    """The posture that the user asks for.

    Args:
        tree: of the robot.
        trunk: link whose frame is B.
        legs: of the robot; may be empty.
        name: `zero`, `stand`, or a posture named in the file, whose missing joints are at zero or
            at the limit nearest to it; None: `stand` for a robot with legs, else `zero`.
        joints: values that replace the posture's [rad or m].
    """
    chosen = _named(tree, trunk, legs, name or (STAND if legs else ZERO))
    _check_joints(tree, joints)
    values = tree.complete({**chosen.values, **joints})
    height = standing_height(tree, trunk, legs, values) if legs else None
    return replace(
        chosen,
        values=values,
        name=f"{chosen.name} + joints" if joints else chosen.name,
        standing_height=height,
        warnings=(*chosen.warnings, *_limit_warnings(tree, values)),
    )


def unknown_name(kind: str, name: str, known: Iterable[str]) -> RobotError:
    """The error for a name that the robot does not have, with what it has, closest first."""
    every = sorted(known)
    close = get_close_matches(name, every, n=len(every) or 1, cutoff=0.5)
    ordered = [*close, *(each for each in every if each not in close)]
    available = listed(ordered, most=12) if ordered else "none"
    return RobotError(f"the robot has no {kind} '{name}'", hint=f"available: {available}")


def _named(tree: Tree, trunk: str, legs: Sequence[Leg], name: str) -> Posture:
    """A posture by its name, without the checks."""
    if name == ZERO:
        return Posture(tree.complete({}), ZERO, None, _hidden(tree, ZERO))
    if name == STAND:
        found = stand(tree, trunk, legs)
        if found is None:
            raise RobotError(
                "no legs were found, so there is no posture 'stand'",
                hint="use --posture zero, a posture named in the file, or --joint NAME=VALUE",
            )
        return Posture(found.posture, STAND, None, (*found.warnings, *_hidden(tree, STAND)))
    if name not in tree.named_postures:
        raise unknown_name(
            "posture", name, [ZERO, *([STAND] if legs else []), *tree.named_postures]
        )
    values = tree.complete({**neutral_posture(tree), **tree.named_postures[name]})
    return Posture(values, name, None, ())


def _hidden(tree: Tree, name: str) -> tuple[str, ...]:
    if name not in tree.named_postures:
        return ()
    return (f"the file's own posture '{name}' is not used: the built-in one has the same name",)


def _check_joints(tree: Tree, joints: Mapping[str, float]) -> None:
    for name, value in joints.items():
        if name not in tree.joints:
            raise unknown_name("moving joint", name, tree.joints)
        if not abs(value) <= LARGEST_NUMBER:
            raise RobotError(f"joint '{name}' cannot be at {value}", hint="give a finite number")
        mimic = tree.joints[name].mimic
        if mimic is not None and mimic[0] in tree.joints:
            raise RobotError(
                f"joint '{name}' follows joint '{mimic[0]}'", hint=f"set '{mimic[0]}' instead"
            )


def _limit_warnings(tree: Tree, values: Mapping[str, float]) -> tuple[str, ...]:
    outside = [
        name
        for name, joint in tree.joints.items()
        if not joint.lower - _LIMIT_TOLERANCE <= values[name] <= joint.upper + _LIMIT_TOLERANCE
    ]
    return (f"the posture is outside the limits of: {listed(outside)}",) if outside else ()
