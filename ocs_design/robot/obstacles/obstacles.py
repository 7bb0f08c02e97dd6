"""Distances between a robot's links, at any values of its joints, and solids on its trunk.

MuJoCo measures them (`mj_geomDistance`), with everything placed in the trunk's frame B.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import mujoco
import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.obstacles.parts import Part, parts_of
from ocs_design.robot.obstacles.probes import Ball, Drum, Probe
from ocs_design.robot.obstacles.solids import BALL, BASE, DRUMS, solid_model
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.robot import Robot
from ocs_design.robot.spec.contacts import posture_qpos

_FARTHEST = 10.0
"""Distances are looked for up to this [m]."""

Posture = Mapping[str, float]
"""Values of driven joints [rad or m]; all others are at the nominal posture."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Where all geoms are in some postures, in B.

    Attributes:
        postures: n of them.
        positions: [m], shape (n, ngeom, 3). axes: rotations row by row, shape (n, ngeom, 9).
    """

    postures: Sequence[Posture]
    positions: FloatArray
    axes: FloatArray

    def __getitem__(self, index: int) -> "Poses":
        """One of them."""
        one = slice(index, index + 1)
        return Poses(self.postures[one], self.positions[one], self.axes[one])


@dataclass(frozen=True, eq=False)
class Nearest:
    """What comes nearest to a solid.

    Attributes:
        part: see `Part`.
        distance: between the surfaces, negative where they overlap [m].
        posture: in which it does.
    """

    part: Part
    distance: float
    posture: Posture


class Obstacles:
    """A robot's solid parts.

    Attributes:
        robot: see `Robot`.
        parts: see `Part`; empty for a robot without any shape.
        nominal: the nominal posture alone.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        # Meshes that cannot be read are told of where the robot is exported.
        self._model = solid_model(robot, Remarks())
        self._data = mujoco.MjData(self._model)
        self.parts = parts_of(robot, self._model)
        self._part_of = {int(geom): part for part in self.parts for geom in part.geoms}
        self._fromto = np.zeros(6)
        self._base = self._model.site(BASE).id
        self._nominal = posture_qpos(self._model, robot)
        self._moved_by = _moved_by(robot, self._model)
        self.nominal = self.poses([{}])

    def poses(self, postures: Sequence[Posture]) -> Poses:
        """Where everything is in these postures; joints that mimic others follow them."""
        model, data, count = self._model, self._data, len(postures)
        origin, base = np.empty((count, 1, 3)), np.empty((count, 1, 3, 3))
        positions = np.empty((count, model.ngeom, 3))
        axes = np.empty((count, model.ngeom, 3, 3))
        for index, posture in enumerate(postures):
            data.qpos[:] = self._nominal
            for name, value in posture.items():
                for address, factor, offset in self._moved_by[name]:
                    data.qpos[address] = factor * value + offset
            mujoco.mj_kinematics(model, data)
            origin[index], positions[index] = data.site_xpos[self._base], data.geom_xpos
            base[index].flat, axes[index].flat = data.site_xmat[self._base], data.geom_xmat
        return Poses(
            postures,
            (base.swapaxes(2, 3) @ (positions - origin)[..., None])[..., 0],
            (base.swapaxes(2, 3) @ axes).reshape(count, model.ngeom, 9),
        )

    def nearest(
        self, probe: Probe, poses: Poses, parts: Sequence[Part], *, within: float = _FARTHEST
    ) -> Nearest | None:
        """What comes nearest to a solid in any of the postures; None: nothing nearer than `within`.

        Balls around both tell which of them need to be looked at.
        """
        geoms = np.array([geom for part in parts for geom in part.geoms], dtype=np.int64)
        if not len(geoms):
            return None
        apart = np.linalg.norm(poses.positions[:, geoms] - probe.center, axis=2)
        at_least = apart - self._model.geom_rbound[geoms] - probe.reach
        rows, columns = np.nonzero(at_least < within)
        order = np.argsort(at_least[rows, columns], kind="stable")
        best, least = None, within
        where = self._put(probe, 0)
        for row, column in zip(rows[order], columns[order], strict=True):
            if at_least[row, column] >= least:
                break
            distance = self._from(where, poses, int(row), int(geoms[column]), least)
            if distance < least:
                best, least = (int(row), int(geoms[column])), distance
        if best is None:
            return None
        return Nearest(self._part_of[best[1]], least, poses.postures[best[0]])

    def between(self, left: Drum, right: Drum) -> float:
        """Distance of two solids on the trunk [m]."""
        return self._distance(self._put(left, 0), self._put(right, 1), _FARTHEST)

    def _from(self, probe: int, poses: Poses, row: int, geom: int, within: float) -> float:
        self._data.geom_xpos[geom] = poses.positions[row, geom]
        self._data.geom_xmat[geom] = poses.axes[row, geom]
        return self._distance(probe, geom, within)

    def _distance(self, first: int, second: int, within: float) -> float:
        return float(
            mujoco.mj_geomDistance(self._model, self._data, first, second, within, self._fromto)
        )

    def _put(self, probe: Probe, which: int) -> int:
        """Put the geom that stands in for `probe` where that is; its number."""
        axes = np.eye(3).ravel()
        match probe:
            case Ball():
                name, size = BALL, (probe.radius, 0.0, 0.0)
            case Drum():
                name, size = DRUMS[which], (probe.radius, 0.5 * probe.height, 0.0)
                axes = _frame_about(probe.axis)
        geom = int(self._model.geom(name).id)
        self._model.geom_size[geom] = size
        self._model.geom_rbound[geom] = probe.reach
        self._data.geom_xpos[geom] = probe.center
        self._data.geom_xmat[geom] = axes
        return geom


def _moved_by(robot: Robot, model: mujoco.MjModel) -> Mapping[str, list[tuple[int, float, float]]]:
    """For each driven joint the coordinates that go with it: address, factor and offset."""
    moved: dict[str, list[tuple[int, float, float]]] = {name: [] for name in robot.tree.joints}
    for name, joint in robot.tree.joints.items():
        leader, factor, offset = joint.mimic or (name, 1.0, 0.0)
        moved.setdefault(leader, []).append((int(model.joint(name).qposadr[0]), factor, offset))
    return moved


def _frame_about(axis: FloatArray) -> FloatArray:
    """Some rotation whose z axis is `axis`, row by row, shape (9,)."""
    quaternion, rotation = np.empty(4), np.empty(9)
    mujoco.mju_quatZ2Vec(quaternion, axis)
    mujoco.mju_quat2Mat(rotation, quaternion)
    return rotation


@lru_cache(maxsize=1)
def obstacles_of(robot: Robot) -> Obstacles:
    """Made once for a robot: the hulls of its meshes take most of the time."""
    return Obstacles(robot)


def forget_obstacles() -> None:
    """Let go of the last robot's: large meshes take hundreds of megabytes."""
    obstacles_of.cache_clear()
