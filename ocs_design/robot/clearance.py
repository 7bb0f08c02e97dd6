"""Postures in which a device has to stand clear of the robot, and which limbs could hit it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ocs_design.robot.collision import (
    FARTHEST,
    CollisionModel,
    Nearest,
    Part,
    Poses,
    Posture,
)
from ocs_design.robot.leg_geometry import leg_geometries
from ocs_design.robot.probe import Probe
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.robot.tree import JointKind

GIVE = 0.4
PITCH_GIVE = 0.7
KNEE_GIVE = 0.5 * np.pi
"""Farthest that joints of a leg leave the nominal posture in a landing [rad]: those that spread or
twist the leg, pitch joints, and knees; see docs/theory.md, Placement."""

_SLIDE_GIVE = 0.5
"""Farthest that a slide leaves the nominal posture in a landing, over its leg's length."""

SAMPLES = 512
"""Number of postures that are drawn from ranges."""

_OVERSHOOT = 0.1
"""Share of a range that is drawn beyond either end and put at that end, where most is hit."""

Ranges = Mapping[str, tuple[float, float]]
"""Lower and upper value of driven joints [rad or m]; those that are not in it are held."""


@lru_cache(maxsize=1)
def landing_ranges(robot: Robot) -> Ranges:
    """Ranges of the legs' joints in a landing: drives hold the nominal posture, but not stiffly."""
    ranges: dict[str, tuple[float, float]] = {}
    for each in leg_geometries(robot.tree, robot.trunk, robot.legs) if robot.legs else ():
        pitch = [each.chain.names[column] for column in each.plane.pitch]
        for name in each.leg.joints:
            give = PITCH_GIVE if name in pitch else GIVE
            if not _turns(robot, name):
                give = _SLIDE_GIVE * each.leg.length
            elif name in pitch[1:2]:
                give = KNEE_GIVE
            ranges[name] = _around(robot, name, give)
    return ranges


def full_ranges(robot: Robot, names: Iterable[str]) -> Ranges:
    """Everything within the limits of some joints; hinges at most half a turn to each side."""
    return {name: _around(robot, name, np.pi if _turns(robot, name) else np.inf) for name in names}


def _turns(robot: Robot, name: str) -> bool:
    return robot.tree.joints[name].kind is JointKind.REVOLUTE


def _around(robot: Robot, name: str, way: float) -> tuple[float, float]:
    """Range of a joint that goes `way` to either side of the nominal posture, within its limits."""
    joint, value = robot.tree.joints[name], robot.posture[name]
    # A posture may lie beyond a limit, and a slide may have none.
    lower = min(max(joint.lower, value - way), value)
    upper = max(min(joint.upper, value + way), value)
    return (
        float(lower if np.isfinite(lower) else value),
        float(upper if np.isfinite(upper) else value),
    )


def drawn(ranges: Ranges, count: int = SAMPLES) -> Sequence[Posture]:
    """Random postures within the ranges, the same ones each time; joints move independently."""
    if not ranges:
        return ()
    lower, upper = np.array(list(ranges.values())).T
    unit = np.random.default_rng(0).random((count, len(ranges)))
    share = np.clip(unit * (1.0 + 2.0 * _OVERSHOOT) - _OVERSHOOT, 0.0, 1.0)
    values = lower + share * (upper - lower)
    return [dict(zip(ranges, map(float, row), strict=True)) for row in values]


@dataclass(frozen=True, eq=False)
class _Standing:
    """A leg that stands on its foot.

    Attributes:
        joints: that move it alone. foot: its last part.
        above: all others on the way to it, the trunk among them.
    """

    joints: tuple[str, ...]
    foot: Part
    above: tuple[Part, ...]

    def holds(self, collision: CollisionModel, poses: Poses) -> NDArray[np.bool_]:
        """Whether in each posture nothing of leg or trunk is lower than its foot, shape (n,).

        On a robot that is off level by `LANDING_TOLERANCE`, as well.
        """
        foot, found = collision.lowest(poses, self.foot), np.ones(len(poses.postures), dtype=bool)
        for part in self.above:
            off = foot - collision.lowest(poses, part)
            found &= off[:, 2] <= np.tan(LANDING_TOLERANCE) * np.hypot(off[:, 0], off[:, 1])
        return found


@lru_cache(maxsize=1)
def standing_legs(collision: CollisionModel) -> tuple[_Standing, ...]:
    """Legs whose feet are known, and are what the robot stands on in the nominal posture."""
    robot, found = collision.robot, []
    for leg in robot.legs:
        name = robot.tree.bodies[leg.body].name
        for foot in (part for part in collision.parts if part.name == name):
            before = [each for each in collision.parts if each is not foot]
            above = (each for each in before if foot.joints[: len(each.joints)] == each.joints)
            shared = {joint for each in robot.legs if each is not leg for joint in each.joints}
            own = tuple(joint for joint in leg.joints if joint not in shared)
            stands = _Standing(own, foot, tuple(above))
            if stands.holds(collision, collision.nominal).all():
                found.append(stands)
    return tuple(found)


@lru_cache(maxsize=2)
def landing_poses(collision: CollisionModel, *, on_feet: bool = False) -> Poses:
    """The nominal posture, and postures drawn from `landing_ranges`.

    Args:
        collision: of the robot.
        on_feet: a leg that would no longer stand on its foot, as where its heel is kicked up
            behind, is in the nominal posture instead.
    """
    postures = [{}, *map(dict, drawn(landing_ranges(collision.robot)))]
    poses = collision.poses(postures)
    if not on_feet:
        return poses
    for leg in standing_legs(collision):
        for row in np.flatnonzero(~leg.holds(collision, poses)).tolist():
            postures[row] = {
                name: value for name, value in postures[row].items() if name not in leg.joints
            }
    return collision.poses(postures)


_FIRST_STEP = 0.125
"""First step of a search along a joint, over its range."""

_HALVINGS = 5

_PROGRESS = 1e-5
"""Smallest gain for which the search goes on [m]."""


def nearest_in_landings(
    collision: CollisionModel,
    probe: Probe,
    *,
    within: float = FARTHEST,
    enough: float = -np.inf,
    on_feet: bool = False,
) -> Nearest | None:
    """Nearest that a limb comes to a solid while the legs give way; None beyond `within` [m].

    From the nearest of the postures that are drawn, a pattern search along the joints that move the
    limb: they lie too far apart to find the least distance of a limb with many joints.

    Args:
        collision, probe: as for `CollisionModel.nearest`.
        within: distance of interest in the postures that are drawn [m].
        enough: distance below which it need not be nearer [m].
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
            # One joint at a time, by a share of its range to either side.
            around = []
            for name, step in product(joints, (-share, share)):
                lower, upper = ranges[name]
                here = best.posture.get(name, robot.posture[name])
                value = min(max(here + step * (upper - lower), lower), upper)
                if value != here:
                    around.append({name: value})
            poses = collision.poses(around, list(dict.fromkeys(placed)), start=best.posture)
            for leg in legs:
                poses = poses.take(leg.holds(collision, poses))
            nearer = collision.nearest(probe, poses, [best.part], within=best.distance - _PROGRESS)
            if nearer is None:
                break
            best = nearer
        share /= 2.0
    return best


_STEPS = 32
"""Number of steps from the nominal posture to where something is hit."""

_STILL = 0.02
"""Way of a joint, over the farthest that another goes, below which it need not have moved."""


@dataclass(frozen=True)
class Reach:
    """Shortest movement by which a limb hits a solid.

    Attributes:
        part: name of the body that hits it first.
        joints: values [rad or m] at which it does, on a straight way from the nominal posture; one
            joint where one is enough.
    """

    part: str
    joints: Posture


def reaches(collision: CollisionModel, solids: Sequence[Probe]) -> tuple[Reach, ...]:
    """Movements by which limbs hit the solids, at most one for each limb.

    One joint alone that has to move least, if there is one, else several together. A limb without
    an entry hit nothing in any posture that was tried.
    """
    limbs: dict[str, list[Part]] = {}
    for part in collision.parts:
        if part.limb:
            limbs.setdefault(part.limb, []).append(part)
    joints = dict.fromkeys(name for part in collision.parts for name in part.joints)
    ranges = full_ranges(collision.robot, joints)
    # Limbs move independently: one set of postures does for all of them.
    poses = collision.poses(drawn(ranges))
    found = (_Limb(collision, parts, solids).reach(ranges, poses) for parts in limbs.values())
    return tuple(reach for reach in found if reach is not None)


@dataclass(frozen=True, eq=False)
class _Limb:
    """Parts of one limb, and the solids that they may hit."""

    collision: CollisionModel
    parts: Sequence[Part]
    solids: Sequence[Probe]

    def reach(self, ranges: Ranges, poses: Poses) -> Reach | None:
        """Shortest movement to a contact; None if no posture that was tried has one."""
        joints = dict.fromkeys(name for part in self.parts for name in part.joints)
        alone = [
            reach
            for name in joints
            for end in ranges[name]
            if (reach := self._first_hit({name: end})) is not None
        ]
        if alone:
            return min(alone, key=lambda reach: max(self._ways(reach.joints).values()))
        hit = self._hit(poses)
        if hit is None:
            return None
        return self._first_hit({name: hit.posture[name] for name in joints})

    def _first_hit(self, end: Posture) -> Reach | None:
        """The first contact on the straight way to a posture."""
        start = self.collision.robot.posture
        way = [
            {name: start[name] + float(share) * (end[name] - start[name]) for name in end}
            for share in np.linspace(0.0, 1.0, _STEPS + 1)
        ]
        poses = self.collision.poses(way)
        if self._hit(poses) is None:
            return None
        for index, posture in enumerate(poses.postures):
            hit = self._hit(poses[index])
            if hit is not None:
                ways = self._ways(end)
                moved = [name for name in end if ways[name] >= _STILL * max(ways.values())]
                return Reach(hit.part.name, {name: posture[name] for name in moved})
        return None

    def _hit(self, poses: Poses) -> Nearest | None:
        found = [
            self.collision.nearest(solid, poses, self.parts, within=0.0) for solid in self.solids
        ]
        hits = [nearest for nearest in found if nearest is not None]
        return min(hits, key=lambda nearest: nearest.distance, default=None)

    def _ways(self, end: Posture) -> Posture:
        """Distance of each joint from the nominal posture [rad or m]."""
        start = self.collision.robot.posture
        return {name: abs(value - start[name]) for name, value in end.items()}
