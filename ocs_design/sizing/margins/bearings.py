"""What a wheel's bearings carry while the trunk turns."""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.margins.driven_wheel import DrivenWheel
from ocs_design.sizing.margins.motion import Motion


def bearing_moment(motion: Motion, axes: FloatArray, wheel: DrivenWheel) -> FloatArray:
    """Moment of the trunk on each wheel across its axis [N m], shape (n, 2).

    With a the axis, w the trunk's rate and W the wheel's speed relative to it, a rotor has the
    momentum I_t w_perp + (I_s (a w) + h W) a, whose change as seen from the world is, across a
    (Euler's equations in a frame that does not spin with the rotor; Hughes1986, Gyrostats):

        M = I_t w_dot_perp + (I_s (a w) + h W - I_t (a w)) w x a .

    Args:
        motion: of trunk and wheels.
        axes: unit spin axes in B as columns, shape (3, 2).
        wheel: either of the two.
    """
    moments = [
        _moment(motion, motion.wheel_speed[:, index], axes[:, index], wheel) for index in range(2)
    ]
    return np.column_stack(moments)


def _moment(
    motion: Motion, wheel_speed: FloatArray, axis: FloatArray, wheel: DrivenWheel
) -> FloatArray:
    """Of one wheel, shape (n,)."""
    along = motion.rate @ axis
    across = motion.acceleration - np.outer(motion.acceleration @ axis, axis)
    own = wheel.body.transverse_inertia
    excess = (wheel.axial_inertia - own) * along
    momentum = excess + wheel.spin_inertia * wheel_speed
    moment = own * across + momentum[:, None] * np.cross(motion.rate, axis)
    return np.asarray(np.linalg.norm(moment, axis=1))
