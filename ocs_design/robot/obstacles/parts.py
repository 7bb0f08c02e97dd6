"""The moving bodies of a robot as obstacles: their geoms, and the joints that bring them near."""

from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.robot.obstacles.solids import PROBES
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.bodies import body_names
from ocs_design.robot.tree import Tree

_UNBOUNDED = (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))


@dataclass(frozen=True, eq=False)
class Part:
    """One moving body.

    Attributes:
        name: of the body.
        limb: name of the first body on the way to it from the trunk; empty for the trunk itself.
        joints: driven ones that move it against the trunk, from the trunk outwards.
        geoms: that can be hit, in the model.
    """

    name: str
    limb: str
    joints: tuple[str, ...]
    geoms: NDArray[np.int64]


def parts_of(robot: Robot, model: mujoco.MjModel) -> tuple[Part, ...]:
    """Every body with a shape, in tree order.

    Args:
        robot: that the model was made from.
        model: of `solid_model`.
    """
    geoms = _geoms_by_body(robot, model)
    return tuple(_part(robot, body, geoms[body]) for body in sorted(geoms))


def _part(robot: Robot, body: int, geoms: list[int]) -> Part:
    tree = robot.tree
    path = path_between(tree, tree.body_of_link[robot.trunk], body)
    joints: dict[str, None] = {}
    for mover in path:
        joint = tree.bodies[mover].joint
        if joint is not None:
            joints[joint.name if joint.mimic is None else joint.mimic[0]] = None
    limb = tree.bodies[path[0]].name if path else ""
    return Part(tree.bodies[body].name, limb, tuple(joints), np.array(geoms))


def _geoms_by_body(robot: Robot, model: mujoco.MjModel) -> dict[int, list[int]]:
    """Geoms that can be hit, by the index of the tree's body that they move with."""
    index_of = {name: index for index, name in enumerate(body_names(robot.tree))}
    index_of |= robot.tree.body_of_link
    probes = {model.geom(name).id for name in PROBES}
    found: dict[int, list[int]] = {}
    for geom in range(model.ngeom):
        body = index_of.get(model.body(int(model.geom_bodyid[geom])).name)
        if body is not None and geom not in probes and model.geom_type[geom] not in _UNBOUNDED:
            found.setdefault(body, []).append(geom)
    touching = (model.geom_contype | model.geom_conaffinity) != 0
    # An MJCF model has geoms that only show beside those that touch.
    return {
        body: [geom for geom in geoms if touching[geom]] or geoms for body, geoms in found.items()
    }


def path_between(tree: Tree, trunk: int, body: int) -> list[int]:
    """Bodies whose joints move `body` against the trunk, from the trunk outwards."""
    up, down = list(_to_root(tree, trunk)), list(_to_root(tree, body))
    shared = set(up) & set(down)
    return [i for i in up if i not in shared] + [i for i in reversed(down) if i not in shared]


def _to_root(tree: Tree, body: int) -> Iterator[int]:
    while body > 0:
        yield body
        body = tree.bodies[body].parent
