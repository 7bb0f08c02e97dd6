"""Where a maneuver starts, how long it may take, and how far it turns the trunk.

The heading is left free, because the wheels cannot command it: the attitude is the world's upward
direction in B.
"""

from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.exceptions import SpecificationError
from ocs_design.requirement.maneuver import Drop, Flip, Maneuver, Unforeseen

UP = np.array([0.0, 0.0, 1.0])
_PITCH = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Boundary:
    """A turn of the trunk from rest to rest, with the wheels at rest in the beginning.

    Attributes:
        name: of the maneuver.
        vertical, final_vertical: the world's upward direction in B at the start and at the end,
            shape (3,).
        axis: about which the trunk mainly turns, in B, a unit vector, shape (3,).
        angle: of that turn [rad], signed; past half a turn it tells how often the trunk goes round.
        duration: of the turn at most [s].
        push: torque on the trunk before it, in B [N m], shape (3,).
        push_duration: [s]; the trunk starts at rest before the push, and turns as the push leaves
            it; 0: no push.
    """

    name: str
    vertical: FloatArray
    final_vertical: FloatArray
    axis: FloatArray
    angle: float
    duration: float
    push: FloatArray
    push_duration: float


@singledispatch
def boundary(maneuver: Maneuver, standing_height: float) -> Boundary:
    """What a maneuver asks of trunk and wheels.

    Args:
        maneuver: see `Maneuver`.
        standing_height: of the trunk over the ground [m].
    """
    del standing_height
    raise TypeError(f"no boundary is known for a {type(maneuver).__name__}")


@boundary.register
def _drop(maneuver: Drop, standing_height: float) -> Boundary:
    """From rest, tilted by pitch about y after roll about x, to level within the fall."""
    sine, cosine = np.sin(maneuver.pitch), np.cos(maneuver.pitch)
    vertical = np.array([-sine, np.sin(maneuver.roll) * cosine, np.cos(maneuver.roll) * cosine])
    # A rate w moves the vertical by -w x v.
    axis = np.cross(UP, vertical)
    length = float(np.linalg.norm(axis))
    return Boundary(
        name=maneuver.name,
        vertical=vertical,
        final_vertical=UP,
        axis=axis / length if length > 0.0 else _PITCH,
        angle=float(np.arctan2(length, vertical[2])),
        duration=maneuver.time(standing_height),
        push=np.zeros(3),
        push_duration=0.0,
    )


@boundary.register
def _flip(maneuver: Flip, standing_height: float) -> Boundary:
    """From level at lift-off by the whole angle of pitch."""
    del standing_height
    return Boundary(
        name=maneuver.name,
        vertical=UP,
        final_vertical=np.array([-np.sin(maneuver.angle), 0.0, np.cos(maneuver.angle)]),
        axis=_PITCH,
        angle=maneuver.angle,
        duration=maneuver.duration,
        push=np.zeros(3),
        push_duration=0.0,
    )


@boundary.register
def _unforeseen(maneuver: Unforeseen, standing_height: float) -> Boundary:
    """From level at the onset; what is left after the torque is for the turn back."""
    del standing_height
    if maneuver.time_left <= 0.0:
        raise SpecificationError(
            f"maneuver {maneuver.name!r}: no time is left after its torque",
            hint="Let the torque start earlier, or the robot jump higher.",
        )
    return Boundary(
        name=maneuver.name,
        vertical=UP,
        final_vertical=UP,
        axis=_PITCH,
        angle=0.0,
        duration=maneuver.time_left,
        push=np.array(maneuver.torque),
        push_duration=maneuver.duration,
    )
