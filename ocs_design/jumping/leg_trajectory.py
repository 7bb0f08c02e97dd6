"""What the legs track during a jump; no solver is needed to read it."""

from dataclasses import dataclass

from ocs_design.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class LegTrajectory:
    """Joint references from the nominal stance to the touchdown posture; between samples linear.

    Attributes:
        joints: names, n of them.
        time: from the start of the push-off [s], shape (k,), increasing, from 0; after the last
            the joints are held there.
        position: [rad or m], shape (k, n).
        velocity: [rad/s or m/s], shape (k, n).
        torque: of the drives [N m or N], shape (k, n).
        lift_off: when the feet are to leave the ground [s].
    """

    joints: tuple[str, ...]
    time: FloatArray
    position: FloatArray
    velocity: FloatArray
    torque: FloatArray
    lift_off: float
