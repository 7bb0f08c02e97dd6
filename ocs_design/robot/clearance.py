"""Postures in which a device must be clear of the robot, and limbs that could hit it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ocs_design.robot.collision import (
    FARTHEST,
    CollisionBody,
    CollisionModel,
    GeomPoses,
    Nearest,
    Posture,
)
from ocs_design.robot.leg_geometry import leg_geometries
from ocs_design.robot.probe import Probe, Reach
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.robot.tree import JointKind

GIVE = 0.4
PITCH_GIVE = 0.7
KNEE_GIVE = 0.5 * np.pi
"""Largest deflection of a leg's joints from the nominal posture in a landing [rad]: of joints that
spread or twist the leg, of pitch joints, and of knees; see docs/theory.md, Placement."""

_SLIDE_GIVE = 0.5
"""Largest deflection of a slide from the nominal posture in a landing, over the leg's length."""

SAMPLES = 512
"""Number of postures sampled from ranges."""

_OVERSHOOT = 0.1
"""Share of a range sampled beyond either end and clamped to it, where most contacts occur."""

Ranges = Mapping[str, tuple[float, float]]
"""Lower and upper value of driven joints [rad or m]; joints that are not listed are locked."""


@lru_cache(maxsize=1)
def landing_ranges(robot: Robot) -> Ranges:
    """Ranges of the legs' joints in a landing: drives hold the nominal posture, but compliantly."""
    ranges: dict[str, tuple[float, float]] = {}
    for geometry in leg_geometries(robot.tree, robot.trunk, robot.legs) if robot.legs else ():
        pitch = [geometry.chain.names[column] for column in geometry.plane.pitch]
        for name in geometry.leg.joints:
            give = PITCH_GIVE if name in pitch else GIVE
            if not _is_revolute(robot, name):
                give = _SLIDE_GIVE * geometry.leg.length
            elif name in pitch[1:2]:
                give = KNEE_GIVE
            ranges[name] = _range_around(robot, name, give)
    return ranges


def full_ranges(robot: Robot, names: Iterable[str]) -> Ranges:
    """Ranges of some joints up to their limits; hinges at most half a turn to each side."""
    return {
        name: _range_around(robot, name, np.pi if _is_revolute(robot, name) else np.inf)
        for name in names
    }


def _is_revolute(robot: Robot, name: str) -> bool:
    return robot.tree.joints[name].kind is JointKind.REVOLUTE


def _range_around(robot: Robot, name: str, deflection: float) -> tuple[float, float]:
    """Range of a joint, `deflection` to either side of the nominal posture, within its limits."""
    joint, value = robot.tree.joints[name], robot.posture[name]
    # A posture may exceed a limit, and a slide may have none.
    lower = min(max(joint.lower, value - deflection), value)
    upper = max(min(joint.upper, value + deflection), value)
    return (
        float(lower if np.isfinite(lower) else value),
        float(upper if np.isfinite(upper) else value),
    )


def sampled_postures(ranges: Ranges, count: int = SAMPLES) -> Sequence[Posture]:
    """Random postures within the ranges, the same on each call; joints move independently."""
    if not ranges:
        return ()
    lower, upper = np.array(list(ranges.values())).T
    unit = np.random.default_rng(0).random((count, len(ranges)))
    share = np.clip(unit * (1.0 + 2.0 * _OVERSHOOT) - _OVERSHOOT, 0.0, 1.0)
    values = lower + share * (upper - lower)
    return [dict(zip(ranges, map(float, row), strict=True)) for row in values]


@dataclass(frozen=True, eq=False)
class _StandingLeg:
    """A leg that stands on its foot.

    Attributes:
        joints: that move no other leg. foot: its last part.
        above: all other parts on the way to it, including the trunk.
    """

    joints: tuple[str, ...]
    foot: CollisionBody
    above: tuple[CollisionBody, ...]

    def stands_in(self, collision: CollisionModel, poses: GeomPoses) -> NDArray[np.bool_]:
        """Whether in each posture no part of leg or trunk is lower than the foot, shape (n,).

        This must also hold for a robot tilted by `LANDING_TOLERANCE`.
        """
        foot, stands = collision.lowest(poses, self.foot), np.ones(len(poses.postures), dtype=bool)
        for part in self.above:
            off = foot - collision.lowest(poses, part)
            stands &= off[:, 2] <= np.tan(LANDING_TOLERANCE) * np.hypot(off[:, 0], off[:, 1])
        return stands


@lru_cache(maxsize=1)
def standing_legs(collision: CollisionModel) -> tuple[_StandingLeg, ...]:
    """Legs whose feet are known, and on which the robot stands in the nominal posture."""
    robot, legs = collision.robot, []
    for leg in robot.legs:
        name = robot.tree.bodies[leg.body].name
        for foot in (part for part in collision.parts if part.name == name):
            others = [part for part in collision.parts if part is not foot]
            above = (part for part in others if foot.joints[: len(part.joints)] == part.joints)
            shared = {joint for other in robot.legs if other is not leg for joint in other.joints}
            joints = tuple(joint for joint in leg.joints if joint not in shared)
            standing = _StandingLeg(joints, foot, tuple(above))
            if standing.stands_in(collision, collision.nominal).all():
                legs.append(standing)
    return tuple(legs)


@lru_cache(maxsize=2)
def landing_poses(collision: CollisionModel, *, on_feet: bool = False) -> GeomPoses:
    """The nominal posture, and postures sampled from `landing_ranges`.

    Args:
        collision: of the robot.
        on_feet: whether a leg that would no longer stand on its foot, because its heel is up
            behind it for example, is put in the nominal posture instead.
    """
    postures = [{}, *map(dict, sampled_postures(landing_ranges(collision.robot)))]
    poses = collision.poses(postures)
    if not on_feet:
        return poses
    for leg in standing_legs(collision):
        for row in np.flatnonzero(~leg.stands_in(collision, poses)).tolist():
            postures[row] = {
                name: value for name, value in postures[row].items() if name not in leg.joints
            }
    return collision.poses(postures)


_FIRST_STEP = 0.125
"""First step of a search along a joint, over its range."""

_HALVINGS = 5

_PROGRESS = 1e-5
"""Smallest gain for which the search continues [m]."""


def nearest_in_landings(
    collision: CollisionModel,
    probe: Probe,
    *,
    within: float = FARTHEST,
    enough: float = -np.inf,
    on_feet: bool = False,
) -> Nearest | None:
    """Nearest that a limb comes to a solid while the legs yield; None beyond `within` [m].

    A pattern search along the joints that move the limb, from the nearest of the sampled postures:
    these are too sparse to find the least distance of a limb with many joints.

    Args:
        collision, probe: as for `CollisionModel.nearest`.
        within: distance of interest in the sampled postures [m].
        enough: distance at which the search may stop [m].
        on_feet: whether legs stand on their feet: see `landing_poses`.
    """
    poses = landing_poses(collision, on_feet=on_feet)
    start = collision.nearest(probe, poses, collision.limbs, within=within, enough=enough)
    if start is None:
        return None
    robot, ranges = collision.robot, landing_ranges(collision.robot)
    joints = [name for name in start.part.joints if name in ranges]
    standing = standing_legs(collision) if on_feet else ()
    legs = [leg for leg in standing if set(leg.joints) & set(joints)]
    placed = [start.part, *(part for leg in legs for part in (leg.foot, *leg.above))]
    best, share = start, _FIRST_STEP
    for _ in range(_HALVINGS):
        while best.distance >= enough:
            # One joint at a time, by a fraction of its range to either side.
            neighbours = []
            for name, step in product(joints, (-share, share)):
                lower, upper = ranges[name]
                current = best.posture.get(name, robot.posture[name])
                value = min(max(current + step * (upper - lower), lower), upper)
                if value != current:
                    neighbours.append({name: value})
            poses = collision.poses(neighbours, list(dict.fromkeys(placed)), start=best.posture)
            for leg in legs:
                poses = poses.take(leg.stands_in(collision, poses))
            nearer = collision.nearest(probe, poses, [best.part], within=best.distance - _PROGRESS)
            if nearer is None:
                break
            best = nearer
        share /= 2.0
    return best


_STEPS = 32
"""Number of steps from the nominal posture to a contact."""

_STILL = 0.02
"""Travel of a joint, over the largest of any joint, below which it is left at rest."""


def reaches(collision: CollisionModel, solids: Sequence[Probe]) -> tuple[Reach, ...]:
    """Movements by which limbs hit the solids, at most one for each limb.

    A movement of one joint, the shortest, if there is one; otherwise of several joints together. A
    limb without an entry hit nothing in any posture tried.
    """
    limbs: dict[str, list[CollisionBody]] = {}
    for part in collision.parts:
        if part.limb:
            limbs.setdefault(part.limb, []).append(part)
    joints = dict.fromkeys(name for part in collision.parts for name in part.joints)
    ranges = full_ranges(collision.robot, joints)
    # Limbs move independently: one set of postures serves all of them.
    poses = collision.poses(sampled_postures(ranges))
    limb_reaches = (
        _Limb(collision, parts, solids).reach(ranges, poses) for parts in limbs.values()
    )
    return tuple(reach for reach in limb_reaches if reach is not None)


@dataclass(frozen=True, eq=False)
class _Limb:
    """Parts of one limb, and the solids that they could hit."""

    collision: CollisionModel
    parts: Sequence[CollisionBody]
    solids: Sequence[Probe]

    def reach(self, ranges: Ranges, poses: GeomPoses) -> Reach | None:
        """Shortest movement to a contact; None if no posture tried has one."""
        joints = dict.fromkeys(name for part in self.parts for name in part.joints)
        single_joint_reaches = [
            reach
            for name in joints
            for end in ranges[name]
            if (reach := self._first_hit({name: end})) is not None
        ]
        if single_joint_reaches:
            return min(
                single_joint_reaches, key=lambda reach: max(self._travels(reach.joints).values())
            )
        hit = self._hit(poses)
        if hit is None:
            return None
        return self._first_hit({name: hit.posture[name] for name in joints})

    def _first_hit(self, end: Posture) -> Reach | None:
        """The first contact on the straight path to a posture."""
        start = self.collision.robot.posture
        path = [
            {name: start[name] + float(share) * (end[name] - start[name]) for name in end}
            for share in np.linspace(0.0, 1.0, _STEPS + 1)
        ]
        poses = self.collision.poses(path)
        if self._hit(poses) is None:
            return None
        for index, posture in enumerate(poses.postures):
            hit = self._hit(poses[index])
            if hit is not None:
                travels = self._travels(end)
                moved = [name for name in end if travels[name] >= _STILL * max(travels.values())]
                return Reach(hit.part.name, {name: posture[name] for name in moved})
        return None

    def _hit(self, poses: GeomPoses) -> Nearest | None:
        nearest_parts = [
            self.collision.nearest(solid, poses, self.parts, within=0.0) for solid in self.solids
        ]
        hits = [nearest for nearest in nearest_parts if nearest is not None]
        return min(hits, key=lambda nearest: nearest.distance, default=None)

    def _travels(self, end: Posture) -> Posture:
        """Travel of each joint from the nominal posture [rad or m]."""
        start = self.collision.robot.posture
        return {name: abs(value - start[name]) for name, value in end.items()}
