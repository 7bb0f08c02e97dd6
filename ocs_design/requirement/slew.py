"""What a maneuver comes to for the wheels, whichever kind it is."""

from dataclasses import dataclass

from ocs_design.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Slew:
    """What both wheels together must do to the trunk in a given time, roll and pitch.

    Attributes:
        swept: momentum that must pass through the wheels, over time: inertia times angle of a turn
            from rest to rest [N m s^2], shape (..., 2).
        momentum: that the wheels still hold at the end [N m s], shape (..., 2).
            Signs count, but for that of all together.
        duration: in which it must be done [s].
    """

    swept: FloatArray
    momentum: FloatArray
    duration: float
