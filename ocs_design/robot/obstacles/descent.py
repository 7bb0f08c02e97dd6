"""From the nearest of some postures to the nearest of all around it."""

from ocs_design.robot.obstacles.motion import Ranges
from ocs_design.robot.obstacles.obstacles import Nearest, Obstacles
from ocs_design.robot.obstacles.probes import Probe

_FIRST_STEP = 0.125
"""Over a joint's range."""

_HALVINGS = 5

_PROGRESS = 1e-5
"""Less is none [m]."""


def descended(obstacles: Obstacles, probe: Probe, start: Nearest, ranges: Ranges) -> Nearest:
    """Where a part comes nearest to a solid, near a posture in which it is near already.

    A pattern search along the joints that move the part: drawn postures lie too far apart to find
    the least distance of a limb with many joints.

    Args:
        obstacles, probe: as for `Obstacles.nearest`.
        start: from there.
        ranges: of joints, which are kept.
    """
    best, share = start, _FIRST_STEP
    for _ in range(_HALVINGS):
        while (found := _nearer(obstacles, probe, best, ranges, share)) is not None:
            best = found
        share /= 2.0
    return best


def _nearer(
    obstacles: Obstacles, probe: Probe, start: Nearest, ranges: Ranges, share: float
) -> Nearest | None:
    """The best of all steps of one joint by a share of its range, if it is any better."""
    around = []
    for name in (joint for joint in start.part.joints if joint in ranges):
        lower, upper = ranges[name]
        here = start.posture.get(name, obstacles.robot.posture[name])
        for step in (-share, share):
            value = min(max(here + step * (upper - lower), lower), upper)
            around.append({**start.posture, name: value})
    poses = obstacles.poses(around)
    return obstacles.nearest(probe, poses, [start.part], within=start.distance - _PROGRESS)
