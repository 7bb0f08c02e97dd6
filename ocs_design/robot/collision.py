"""Distances between solids on a robot's trunk and its links, for any joint values.

MuJoCo measures them (`mj_geomDistance`), with everything placed in the trunk's frame B.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import product
from types import MappingProxyType
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.robot.links import Warnings
from ocs_design.robot.meshes import solid_shapes
from ocs_design.robot.mjcf import UNBOUNDED
from ocs_design.robot.mujoco_bodies import body_names, quaternion
from ocs_design.robot.mujoco_model import compile_spec, plain_spec, posture_qpos, trunk_body
from ocs_design.robot.probe import Ball, Drum, Probe
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import Tree

BASE = "ocs_probe_base"
"""Site at the frame B."""

BALL = "ocs_probe_ball"
DRUMS = ("ocs_probe_left", "ocs_probe_right")
PROBES = (BALL, *DRUMS)
"""Geoms on the trunk that represent solids."""


def solid_model(robot: Robot) -> mujoco.MjModel:
    """Compiled model of the robot with the probes on its trunk.

    A body is represented by its collision shapes or, if it has none, by its visual ones; meshes by
    their convex hulls.
    """
    # Exporting the robot already warns of meshes that cannot be read.
    warnings, bodies = Warnings(), []
    for body in robot.tree.bodies:
        shapes = tuple(replace(shape, collides=True) for shape in solid_shapes(body))
        bodies.append(replace(body, shapes=shapes))
    solid = replace(robot, tree=replace(robot.tree, bodies=tuple(bodies)))
    spec = plain_spec(solid, warnings, visuals=False)
    # An MJCF model may have visual geoms beside the colliding ones, or alone. MuJoCo makes no hull
    # for a mesh that does not collide; a distance to it then takes a search over all its vertices.
    index_of = _bodies_by_name(solid.tree)
    bounded_geoms: dict[int | None, list[Any]] = defaultdict(list)
    for link in spec.bodies:
        bounded = [geom for geom in link.geoms if geom.type not in UNBOUNDED]
        bounded_geoms[index_of.get(link.name)] += bounded
    for geoms in bounded_geoms.values():
        if not any(geom.contype or geom.conaffinity for geom in geoms):
            for geom in geoms:
                geom.contype = 1
    trunk, base = trunk_body(spec, solid)
    trunk.add_site(name=BASE, pos=base.position, quat=quaternion(base.rotation))
    for name in PROBES:
        kind = mujoco.mjtGeom.mjGEOM_SPHERE if name == BALL else mujoco.mjtGeom.mjGEOM_CYLINDER
        trunk.add_geom(name=name, type=kind, size=(1, 1, 1), mass=0, contype=0, conaffinity=0)
    return compile_spec(spec, robot, warnings)


@dataclass(frozen=True, eq=False)
class CollisionBody:
    """Moving body with a shape.

    Attributes:
        name: of the body.
        limb: name of the first body on the way to it from the trunk; empty for the trunk itself.
        joints: driven joints that move it relative to the trunk, from the trunk outwards.
        geoms: indices of those that can be hit, in the model.
    """

    name: str
    limb: str
    joints: tuple[str, ...]
    geoms: NDArray[np.int64]


def parts_of(robot: Robot, model: mujoco.MjModel) -> tuple[CollisionBody, ...]:
    """Every body with a shape, in tree order.

    Args:
        robot: that the model was made from.
        model: of `solid_model`.
    """
    tree = robot.tree
    index_of = _bodies_by_name(tree)
    probes = {model.geom(name).id for name in PROBES}
    geoms_of: dict[int, list[int]] = {}
    for geom in range(model.ngeom):
        body = index_of.get(model.body(int(model.geom_bodyid[geom])).name)
        if body is not None and geom not in probes and model.geom_type[geom] not in UNBOUNDED:
            geoms_of.setdefault(body, []).append(geom)
    touching = (model.geom_contype | model.geom_conaffinity) != 0
    parts = []
    for body, geoms in sorted(geoms_of.items()):
        path = path_between(tree, tree.body_of_link[robot.trunk], body)
        joints: dict[str, None] = {}
        for mover in path:
            joint = tree.bodies[mover].joint
            if joint is not None:
                joints[joint.name if joint.mimic is None else joint.mimic[0]] = None
        limb = tree.bodies[path[0]].name if path else ""
        solid = [geom for geom in geoms if touching[geom]]
        parts.append(CollisionBody(tree.bodies[body].name, limb, tuple(joints), np.array(solid)))
    return tuple(parts)


def _bodies_by_name(tree: Tree) -> dict[str, int]:
    """Index in the tree of each body of a model; fixed links are merged."""
    indices = {name: index for index, name in enumerate(body_names(tree))}
    return {**indices, **tree.body_of_link}


def path_between(tree: Tree, trunk: int, body: int) -> list[int]:
    """Bodies whose joints move `body` relative to the trunk, from the trunk outwards."""
    up, down = ([i for i in tree.ancestors(end) if i > 0] for end in (trunk, body))
    shared = set(up) & set(down)
    return [i for i in up if i not in shared] + [i for i in reversed(down) if i not in shared]


_UPRIGHT = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)

FARTHEST = 10.0
"""Largest distance searched for [m]."""

_SLACK = 1e-9
"""Tolerance for rounding when pairs are ruled out [m]."""

_FEW_PAIRS = 16
"""Number of pairs of geom and posture up to which measuring is faster than comparing boxes."""

Posture = Mapping[str, float]
"""Values of driven joints [rad or m]; all others are at the nominal posture."""


@dataclass(frozen=True, eq=False)
class GeomPoses:
    """Poses of all geoms in several postures, in B.

    Attributes:
        postures: n of them.
        positions: [m], shape (n, ngeom, 3). axes: rotations row by row, shape (n, ngeom, 9).
    """

    postures: Sequence[Posture]
    positions: FloatArray
    axes: FloatArray

    @cached_property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Least and largest coordinates of each geom's centre [m], each of shape (ngeom, 3)."""
        return self.positions.min(axis=0), self.positions.max(axis=0)

    def take(self, which: NDArray[np.bool_]) -> "GeomPoses":
        """The postures selected by a mask."""
        postures = [self.postures[row] for row in np.flatnonzero(which).tolist()]
        return GeomPoses(postures, self.positions[which], self.axes[which])

    def __getitem__(self, index: int) -> "GeomPoses":
        """The posture at this index alone."""
        row = slice(index, index + 1)
        return GeomPoses(self.postures[row], self.positions[row], self.axes[row])


@dataclass(frozen=True, eq=False)
class Nearest:
    """Part that comes nearest to a solid, and its distance.

    Attributes:
        part: see `CollisionBody`.
        distance: between the surfaces, negative where they overlap [m].
        posture: in which it does.
    """

    part: CollisionBody
    distance: float
    posture: Posture


class CollisionModel:
    """A robot's parts, and their distances from solids on its trunk.

    Attributes:
        robot: see `Robot`.
        parts: bodies with shapes; empty for a robot without. limbs: all of them but the trunk.
        nominal: the nominal posture alone.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self._model = solid_model(robot)
        self._data = mujoco.MjData(self._model)
        self.parts = parts_of(robot, self._model)
        self.limbs = tuple(part for part in self.parts if part.limb)
        self._part_of = {int(geom): part for part in self.parts for geom in part.geoms}
        self._geoms_of: dict[tuple[CollisionBody, ...], NDArray[np.int64]] = {}
        self._fromto = np.zeros(6)
        # Probes, whose radii change, are not geoms of parts.
        self._radii = np.array(self._model.geom_rbound)
        self._base = self._model.site(BASE).id
        self._probes = {name: int(self._model.geom(name).id) for name in PROBES}
        self._nominal = posture_qpos(self._model, robot)
        # Coordinates that follow each driven joint: address, factor and offset.
        self._moved_by: dict[str, list[tuple[int, float, float]]] = {}
        for name, joint in robot.tree.joints.items():
            leader, factor, offset = joint.mimic or (name, 1.0, 0.0)
            address = int(self._model.joint(name).qposadr[0])
            self._moved_by.setdefault(leader, []).append((address, factor, offset))
        self.nominal = self.poses([{}])

    def poses(
        self,
        postures: Sequence[Posture],
        parts: Sequence[CollisionBody] | None = None,
        *,
        start: Posture = MappingProxyType({}),
    ) -> GeomPoses:
        """Poses of all geoms in these postures; joints that mimic others follow them.

        Args:
            postures: of the robot, as far as they differ from `start`.
            parts: whose geoms are needed, the others are not placed; None: all.
            start: values of other joints, the same in all postures.
        """
        model, data, count = self._model, self._data, len(postures)
        geoms = np.arange(model.ngeom) if parts is None else self._geoms(tuple(parts))
        origin, base = np.empty((count, 1, 3)), np.empty((count, 9))
        positions, axes = np.empty((count, model.ngeom, 3)), np.empty((count, model.ngeom, 9))
        qpos, common = data.qpos, self._nominal.copy()
        self._move(common, start)
        for index, posture in enumerate(postures):
            qpos[:] = common
            self._move(qpos, posture)
            mujoco.mj_kinematics(model, data)
            origin[index], positions[index] = data.site_xpos[self._base], data.geom_xpos
            base[index], axes[index] = data.site_xmat[self._base], data.geom_xmat
        to_base = base.reshape(count, 1, 3, 3).swapaxes(2, 3)
        rotated = axes[:, geoms].reshape(count, len(geoms), 3, 3)
        positions[:, geoms] = (to_base @ (positions[:, geoms] - origin)[..., None])[..., 0]
        axes[:, geoms] = (to_base @ rotated).reshape(count, len(geoms), 9)
        complete = [{**start, **posture} for posture in postures] if start else postures
        return GeomPoses(complete, positions, axes)

    def lowest(self, poses: GeomPoses, part: CollisionBody) -> FloatArray:
        """Lowest corner of the boxes around a part's shapes in each posture, in B, shape (n, 3)."""
        box = self._model.geom_aabb[part.geoms]
        signs = np.array(list(product((-1.0, 1.0), repeat=3)))
        local = box[:, None, :3] + signs * box[:, None, 3:]
        axes = poses.axes[:, part.geoms].reshape(-1, len(part.geoms), 3, 3)
        corners = np.einsum("ngij,gcj->ngci", axes, local) + poses.positions[:, part.geoms, None]
        corners = corners.reshape(len(corners), -1, 3)
        least = corners[:, :, 2].argmin(axis=1)
        return np.asarray(corners[np.arange(len(corners)), least])

    def _move(self, qpos: FloatArray, posture: Posture) -> None:
        """Write a posture's joints, and those that mimic them, into MuJoCo's coordinates."""
        for name, value in posture.items():
            for address, factor, offset in self._moved_by.get(name, ()):
                qpos[address] = factor * value + offset

    def nearest(
        self,
        probe: Probe,
        poses: GeomPoses,
        parts: Sequence[CollisionBody],
        *,
        within: float = FARTHEST,
        enough: float = -np.inf,
    ) -> Nearest | None:
        """Part that comes nearest to a solid in any of the postures; None beyond `within`.

        Bounding spheres and boxes rule out most pairs. Any part nearer than `enough` [m] may be
        returned.
        """
        geoms = self._geoms(tuple(parts))
        if len(poses.postures) > 1:
            # Most limbs are not near in any posture.
            low, high = poses.bounds
            gaps = np.maximum(np.maximum(low - probe.center, probe.center - high), 0.0)[geoms]
            limits = within + probe.reach + self._radii[geoms] + _SLACK
            geoms = geoms[(gaps * gaps).sum(axis=1) < np.maximum(limits, 0.0) ** 2]
        if not len(geoms):
            return None
        rows, geoms, bounds = self._candidates(probe, poses, geoms, within)
        if not len(rows):
            return None
        order = np.argsort(bounds, kind="stable")
        best, least = None, within
        placed, xpos, xmat = self._put(probe, 0), self._data.geom_xpos, self._data.geom_xmat
        near = rows[order].tolist(), geoms[order].tolist(), bounds[order].tolist()
        for row, geom, bound in zip(*near, strict=True):
            if bound >= least or least < enough:
                break
            xpos[geom], xmat[geom] = poses.positions[row, geom], poses.axes[row, geom]
            distance = self._distance(placed, geom, least)
            if distance < least:
                best, least = (row, geom), distance
        if best is None:
            return None
        return Nearest(self._part_of[best[1]], least, poses.postures[best[0]])

    def near(
        self,
        probes: Sequence[Probe],
        pose: GeomPoses,
        parts: Sequence[CollisionBody],
        within: float,
    ) -> list[Probe]:
        """Solids that may be within this distance of parts in a single posture, for `nearest`."""
        geoms = self._geoms(tuple(parts))
        centers = np.array([probe.center for probe in probes]).reshape(-1, 1, 3)
        reach = np.array([probe.reach for probe in probes]).reshape(-1, 1)
        distances = np.linalg.norm(pose.positions[0, geoms] - centers, axis=2)
        near = (distances - self._radii[geoms] - reach < within + _SLACK).any(axis=1)
        return [probe for probe, is_near in zip(probes, near.tolist(), strict=True) if is_near]

    def _candidates(
        self, probe: Probe, poses: GeomPoses, geoms: NDArray[np.int64], within: float
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
        """Indices of postures and geoms that may be near a solid; lower bounds of their distances.

        A geom lies within its bounding sphere, and within a box along its own axes.
        """
        offsets = probe.center - poses.positions[:, geoms]
        lower = np.sqrt((offsets * offsets).sum(axis=2)) - self._radii[geoms] - probe.reach
        rows, columns = np.nonzero(lower < within)
        bounds, geoms = lower[rows, columns], geoms[columns]
        if len(rows) <= _FEW_PAIRS:
            return rows, geoms, bounds
        axes, box = poses.axes[rows, geoms].reshape(-1, 3, 3), self._model.geom_aabb[geoms]
        local = np.einsum("nji,nj->ni", axes, offsets[rows, columns]) - box[:, :3]
        gaps = np.maximum(np.abs(local) - box[:, 3:], 0.0)
        distances = np.sqrt((gaps * gaps).sum(axis=1))
        # Inside the box, the penetration may be deeper than the solid is large.
        box_bounds = np.where(distances > 0.0, distances - probe.reach - _SLACK, -np.inf)
        bounds = np.maximum(bounds, box_bounds)
        near = bounds < within
        return rows[near], geoms[near], bounds[near]

    def _geoms(self, parts: tuple[CollisionBody, ...]) -> NDArray[np.int64]:
        """Indices of the geoms of parts, the same array for the same parts."""
        if parts not in self._geoms_of:
            geoms = [geom for part in parts for geom in part.geoms]
            self._geoms_of[parts] = np.array(geoms, dtype=np.int64)
        return self._geoms_of[parts]

    def between(self, left: Drum, right: Drum) -> float:
        """Distance between two solids on the trunk [m]."""
        return self._distance(self._put(left, 0), self._put(right, 1), FARTHEST)

    def _distance(self, first: int, second: int, within: float) -> float:
        return float(
            mujoco.mj_geomDistance(self._model, self._data, first, second, within, self._fromto)
        )

    def _put(self, probe: Probe, which: int) -> int:
        """Place the geom that represents `probe`; returns its index."""
        axes = np.array(_UPRIGHT)
        match probe:
            case Ball():
                name, size = BALL, (probe.radius, 0.0, 0.0)
            case Drum():
                name, size = DRUMS[which], (probe.radius, 0.5 * probe.height, 0.0)
                # Any rotation that takes z to the axis will do.
                quaternion = np.empty(4)
                mujoco.mju_quatZ2Vec(quaternion, probe.axis)
                mujoco.mju_quat2Mat(axes, quaternion)
        geom = self._probes[name]
        self._model.geom_size[geom] = size
        self._model.geom_rbound[geom] = probe.reach
        self._data.geom_xpos[geom] = probe.center
        self._data.geom_xmat[geom] = axes
        return geom


@lru_cache(maxsize=1)
def collision_model(robot: Robot) -> CollisionModel:
    """Collision model of a robot, cached: the hulls of its meshes take most of the time."""
    return CollisionModel(robot)


def forget_collision_model() -> None:
    """Free the memory of the last robot's model: large meshes take hundreds of megabytes."""
    collision_model.cache_clear()
