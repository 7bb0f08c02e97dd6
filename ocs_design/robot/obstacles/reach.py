"""Which limbs could hit a solid on the trunk if their joints went to their limits."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.robot.obstacles.motion import Ranges, drawn, full_ranges
from ocs_design.robot.obstacles.obstacles import Nearest, Obstacles, Poses, Posture
from ocs_design.robot.obstacles.parts import Part
from ocs_design.robot.obstacles.probes import Probe

_STEPS = 32
"""Along the way from the nominal posture to where something is hit."""

_STILL = 0.02
"""Share of a joint's way below which it need not have moved."""


@dataclass(frozen=True)
class Reach:
    """What a limb does to hit a solid.

    Attributes:
        part: name of the body that hits it first.
        joints: values [rad or m] at which it does, on a straight way from the nominal posture; one
            joint where one is enough.
    """

    part: str
    joints: Posture


def reaches(obstacles: Obstacles, solids: Sequence[Probe]) -> tuple[Reach, ...]:
    """At most one for each limb: the joint alone that has to move least, else several together.

    A limb that is not there could not be seen to hit anything in any posture that was tried.
    """
    limbs: dict[str, list[Part]] = {}
    for part in obstacles.parts:
        if part.limb:
            limbs.setdefault(part.limb, []).append(part)
    joints = dict.fromkeys(name for part in obstacles.parts for name in part.joints)
    ranges = full_ranges(obstacles.robot, joints)
    # Limbs move independently: one set of postures does for all of them.
    poses = obstacles.poses(drawn(ranges))
    found = (_Limb(obstacles, parts, solids).reach(ranges, poses) for parts in limbs.values())
    return tuple(reach for reach in found if reach is not None)


@dataclass(frozen=True, eq=False)
class _Limb:
    """Parts that hang on one another, and solids that they may hit."""

    obstacles: Obstacles
    parts: Sequence[Part]
    solids: Sequence[Probe]

    def reach(self, ranges: Ranges, poses: Poses) -> Reach | None:
        """How it hits a solid first; None: in no posture that was tried."""
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
        poses = self.obstacles.poses(list(self._way_to(end)))
        if self._hit(poses) is None:
            return None
        for index, posture in enumerate(poses.postures):
            hit = self._hit(poses[index])
            if hit is not None:
                ways = self._ways(end)
                moved = [name for name in end if ways[name] > _STILL * max(ways.values())]
                return Reach(hit.part.name, {name: posture[name] for name in moved})
        return None

    def _hit(self, poses: Poses) -> Nearest | None:
        found = [
            self.obstacles.nearest(solid, poses, self.parts, within=0.0) for solid in self.solids
        ]
        hits = [nearest for nearest in found if nearest is not None]
        return min(hits, key=lambda nearest: nearest.distance, default=None)

    def _way_to(self, end: Posture) -> Iterator[Posture]:
        start = self.obstacles.robot.posture
        for share in np.linspace(0.0, 1.0, _STEPS + 1):
            yield {name: start[name] + float(share) * (end[name] - start[name]) for name in end}

    def _ways(self, end: Posture) -> Posture:
        """How far each joint goes from the nominal posture."""
        start = self.obstacles.robot.posture
        return {name: abs(value - start[name]) for name, value in end.items()}
