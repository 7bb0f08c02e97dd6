"""The incidence angle of the two wheel axes (docs/theory.md, Incidence angle)."""

from collections.abc import Mapping
from enum import StrEnum

import numpy as np

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray, frozen


class Criterion(StrEnum):
    """What the incidence angle is best for.

    Attributes:
        EQUAL_RATE: the same change of rate on roll and on pitch, one axis at a time (paper; with
            the momentum that a coupled robot carries along about the other axis).
        WEIGHTED: the momenta asked of roll and of pitch, one axis at a time.
        SIMULTANEOUS: the momenta asked of roll and of pitch at once.
        PITCH_ONLY: both axes lateral. ROLL_ONLY: both axes forward.
    """

    EQUAL_RATE = "equal-rate"
    WEIGHTED = "weighted"
    SIMULTANEOUS = "simultaneous"
    PITCH_ONLY = "pitch-only"
    ROLL_ONLY = "roll-only"


def module_axes(incidence: float) -> FloatArray:
    """Unit spin axes of the left and the right wheel in B as columns, shape (3, 2).

    The matrix C of the paper, section 3.2.

    Args:
        incidence: angle between a wheel axis and the lateral direction y [rad], 0..pi/2.
    """
    sine, cosine = np.sin(incidence), np.cos(incidence)
    return frozen([[sine, -sine], [cosine, cosine], [0.0, 0.0]])


def module_frames(incidence: float) -> tuple[FloatArray, FloatArray]:
    """Attitudes of the left and the right module in B, shape (3, 3) each.

    Their x axis is forward in the left one, y along the wheel's axis away from the other module, z
    up: the right one is the left one turned about the vertical, and its mirror image.

    Args:
        incidence: see `module_axes` [rad].
    """
    sine, cosine = np.sin(incidence), np.cos(incidence)
    return (
        frozen([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]]),
        frozen([[-cosine, sine, 0.0], [-sine, -cosine, 0.0], [0.0, 0.0, 1.0]]),
    )


def incidence_by_criterion(
    inertia: FloatArray, momenta: FloatArray | None = None
) -> Mapping[Criterion, float]:
    """The best incidence under each criterion [rad] (docs/theory.md, Incidence angle).

    Args:
        inertia: of what the wheels turn, about its centre of mass in B [kg m^2], shape (3, 3).
        momenta: asked of roll and of pitch [N m s], shape (2,); only their ratio matters. Where
            none are asked, those of the same rate on both axes stand in for them.
    """
    # For equal rates the ratio of these is the tangent: I_xx / s + |J_xy| / c = |J_xy| / s +
    # I_yy / c. Where roll and pitch are coupled by more than either of them, both want one of the
    # axes most, and that of the uncoupled robot is as good as any.
    tilt = TiltInertia.of(inertia)
    less = tilt.diagonal - np.abs(tilt.product)
    equal_rate = less if (less > 0.0).all() else tilt.diagonal
    same_rate = np.diag(inertia)[:2]
    roll, pitch = np.abs(momenta) if momenta is not None and np.any(momenta) else same_rate
    return {
        Criterion.EQUAL_RATE: float(np.arctan2(*equal_rate)),
        Criterion.WEIGHTED: float(np.arctan2(roll, pitch)),
        Criterion.SIMULTANEOUS: float(np.arctan2(np.cbrt(roll), np.cbrt(pitch))),
        Criterion.PITCH_ONLY: 0.0,
        Criterion.ROLL_ONLY: float(np.pi / 2.0),
    }


def heading_drift(inertia: FloatArray) -> FloatArray:
    """Yaw rate per roll rate and per pitch rate at zero momentum, shape (2,).

    Args:
        inertia: of the robot with its device about the centre of mass in B [kg m^2], shape (3, 3).
    """
    return frozen(-inertia[2, :2] / inertia[2, 2])


def actuated_inertia(total: FloatArray, spin_inertia: float, incidence: float) -> FloatArray:
    """What the motors' torque accelerates, J = I_tot - I_w A A^T [kg m^2], shape (3, 3).

    The wheels' mass and transverse inertia count, their spin inertia does not.

    Args:
        total: inertia of the robot with its device, wheels braked [kg m^2], shape (3, 3).
        spin_inertia: of one wheel [kg m^2].
        incidence: [rad].
    """
    axes = module_axes(incidence)
    return frozen(total - spin_inertia * axes @ axes.T)
