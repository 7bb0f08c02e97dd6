"""Directions of the wheels' axes (docs/layouts.md), and the incidence angle of a pair.

A layout has at most one free angle: the incidence of a pair (docs/theory.md, Incidence angle) or
the elevation of a pyramid.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ocs_design.actuation.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.common.arrays import FloatArray, frozen

Direction = tuple[float, float, float]
"""Unit vector in B."""

SIDES = ("left", "right")
"""Names of a pair's modules; with several pairs, numbered: left_1, right_1, left_2 and so on."""

ISOTROPIC = float(np.arctan(np.sqrt(0.5)))
"""Elevation of four wheels with equal capability about x, y and z: atan(1 / sqrt(2)), 35.3 deg
[rad].
"""


class LayoutName(StrEnum):
    """Arrangement of the axes.

    Attributes:
        SINGLE: one wheel, on pitch. PAIR: two at an incidence to the lateral direction (paper).
        DOUBLE_PAIR, TRIPLE_PAIR: two and three pairs one behind the other, all at one incidence.
        TRIAD: three in the horizontal plane, 120 degrees apart, one of them on pitch.
        ORTHOGONAL: on roll, pitch and yaw. PYRAMID: four at 45 degrees to forward, all at one
            elevation.
        BY_HAND: as specified.
    """

    SINGLE = "single"
    PAIR = "pair"
    DOUBLE_PAIR = "double-pair"
    TRIPLE_PAIR = "triple-pair"
    TRIAD = "triad"
    ORTHOGONAL = "orthogonal"
    PYRAMID = "pyramid"
    BY_HAND = "by-hand"


_PAIRS: Mapping[LayoutName, int] = {
    LayoutName.PAIR: 1,
    LayoutName.DOUBLE_PAIR: 2,
    LayoutName.TRIPLE_PAIR: 3,
}

_AZIMUTHS: Mapping[LayoutName, tuple[float, ...]] = {
    LayoutName.SINGLE: (90.0,),
    LayoutName.TRIAD: (90.0, 210.0, 330.0),
    LayoutName.PYRAMID: (45.0, 135.0, 225.0, 315.0),
}
"""Azimuths of axes, and of modules about their centre, from forward to the left [deg]."""


@dataclass(frozen=True)
class Layout:
    """Directions of the wheels' axes, and placement of their modules around a centre.

    Attributes:
        name: see `LayoutName`.
        specified: axes given by hand, otherwise empty.
    """

    name: LayoutName = LayoutName.PAIR
    specified: tuple[Direction, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the modules: sides for pairs, otherwise numbers from 1."""
        if self.pairs == 1:
            return SIDES
        if self.pairs:
            return tuple(f"{side}_{row + 1}" for row in range(self.pairs) for side in SIDES)
        return tuple(str(number + 1) for number in range(len(self)))

    @property
    def pairs(self) -> int:
        """Number of pairs; 0 for other layouts."""
        return _PAIRS.get(self.name, 0)

    def __len__(self) -> int:
        """Number of wheels."""
        return int(self.axes(0.0).shape[-1])

    @property
    def tilting(self) -> int:
        """Number of wheels that act about roll or pitch, and share the power for it."""
        tilted = np.abs(self.axes(ISOTROPIC)[:2]).max(axis=0) > OUT_OF_REACH
        return int(np.count_nonzero(tilted))

    @property
    def text(self) -> str:
        """Name for messages, such as "the layout 'triad'"."""
        return f"the layout '{self.name}'"

    @property
    def angle(self) -> float | None:
        """Default angle [rad]; None: it is a result of the design."""
        if self.pairs:
            return None
        return ISOTROPIC if self.name is LayoutName.PYRAMID else 0.0

    def axes(self, angle: ArrayLike) -> FloatArray:
        """Unit spin axes of the wheels in B as columns, shape (..., 3, n).

        Those of the pair are the matrix C of the paper, section 3.2.

        Args:
            angle: for pairs, between an axis and the lateral direction y, 0..pi/2; for the pyramid,
                between an axis and the horizontal plane; ignored for others [rad], shape (...).
        """
        angles = np.asarray(angle, dtype=np.float64)[..., None]
        sine, cosine = np.sin(angles), np.cos(angles)
        if self.pairs:
            left_right = np.tile([1.0, -1.0], self.pairs)
            x, y, z = sine * left_right, cosine * left_right**2, 0.0 * sine * left_right**2
            return frozen(np.stack([x, y, z], axis=-2))
        if self.name in {LayoutName.ORTHOGONAL, LayoutName.BY_HAND}:
            rows = np.eye(3) if self.name is LayoutName.ORTHOGONAL else np.array(self.specified).T
            return frozen(np.broadcast_to(rows, (*angles.shape[:-1], *rows.shape)))
        rise = 1.0 if self.name is LayoutName.PYRAMID else 0.0
        horizontal, vertical = np.where(rise, cosine, 1.0), rise * sine
        azimuths = np.radians(_AZIMUTHS[self.name])
        # Keep rounding errors of cos(90 deg) out of the files.
        x, y = (
            np.where(np.abs(component) > OUT_OF_REACH, component, 0.0)
            for component in (np.cos(azimuths), np.sin(azimuths))
        )
        return frozen(
            np.stack([horizontal * x, horizontal * y, vertical * np.ones_like(x)], axis=-2)
        )

    def frames(self, angle: ArrayLike) -> FloatArray:
        """Attitudes of the modules, which are identical, in B, shape (..., n, 3, 3).

        Their y axis points outward, along the wheel's axis away from its motor: a pair's right
        module is the left one turned about the vertical, and also its mirror image.
        """
        outward = np.swapaxes(self.axes(angle), -1, -2)
        return standing_frames(outward * np.array([*map(outward_sign, self.names)])[:, None])

    def feet(self, axes: FloatArray) -> FloatArray:
        """Directions about which modules turn on their feet, shape (3, n).

        For upright modules this is the vertical of B, signed so that a pair's incidence grows; a
        tilted module's foot tilts with it.

        Args:
            axes: of the wheels in B, shape (3, n).
        """
        # As incidence grows, a pair's right wheel turns to the left as seen from above, and the
        # left one to the right, like all other modules.
        return standing_frames(axes.T)[..., 2].T * [-outward_sign(name) for name in self.names]

    @property
    def ring(self) -> tuple[Direction, ...]:
        """Positions of touching modules of radius 1 around their centre in the horizontal plane.

        Pairs stand one behind the other, the first in front.
        """
        count = len(self)
        if self.pairs:
            rows = [self.pairs - 1.0 - 2.0 * row for row in range(self.pairs)]
            return tuple((along, across, 0.0) for along in rows for across in (1.0, -1.0))
        if count == 1:
            return ((0.0, 0.0, 0.0),)
        first = 90.0 if self.name is not LayoutName.ORTHOGONAL else 0.0
        first = _AZIMUTHS.get(self.name, (first,))[0]
        around = np.radians(first + 360.0 / count * np.arange(count))
        off = np.stack([np.cos(around), np.sin(around)], axis=1) / np.sin(np.pi / count)
        off = np.where(np.abs(off) > OUT_OF_REACH, off, 0.0)
        return tuple((float(x), float(y), 0.0) for x, y in off)

    def stands(self, angle: float) -> NDArray[np.bool_]:
        """Whether each module stands upright on its foot, shape (n,)."""
        return np.asarray(self.frames(angle)[..., 2, 2] > 1.0 - OUT_OF_REACH)

    def hull(self, low: float, high: float) -> FloatArray:
        """Axes about roll and pitch whose zonotope contains the layout's at all angles between two.

        The zonotope is symmetric in roll and in pitch; shape (2, n).
        """
        if self.pairs:
            sine, cosine = np.sin(high), np.cos(low)
            return frozen(np.tile([[sine, -sine], [cosine, cosine]], self.pairs))
        axes = self.axes(low)[:2]
        # A box for axes given by hand.
        return axes if self.name is not LayoutName.BY_HAND else np.diag(np.abs(axes).sum(axis=1))


PAIR = Layout()
"""The paper's two wheels."""


def outward_sign(name: str) -> float:
    """Sign of a module's outward direction along its wheel's axis; negative for a right module."""
    return -1.0 if name.startswith(SIDES[1]) else 1.0


def standing_frames(outward: FloatArray) -> FloatArray:
    """Attitudes whose y axis is `outward`, as upright as possible, shape (..., 3, 3).

    For one that points straight up, the z axis is forward.

    Args:
        outward: unit vectors in B, shape (..., 3).
    """
    up = np.array([0.0, 0.0, 1.0]) - outward[..., 2:] * outward
    size = np.linalg.norm(up, axis=-1, keepdims=True)
    points_up = size < OUT_OF_REACH
    upward = np.where(points_up, [1.0, 0.0, 0.0], up / np.where(points_up, 1.0, size))
    return frozen(np.stack([np.cross(outward, upward), outward, upward], axis=-1))


def module_axes(incidence: float) -> FloatArray:
    """Axes of a pair at an incidence [rad], shape (3, 2); see `Layout.axes`."""
    return PAIR.axes(incidence)


class Criterion(StrEnum):
    """Criterion for the incidence angle.

    Attributes:
        EQUAL_RATE: equal change of rate in roll and in pitch, one axis at a time (paper; including
            the momentum of a coupled robot about the other axis).
        WEIGHTED: the required momenta in roll and in pitch, one axis at a time.
        SIMULTANEOUS: the required momenta in roll and in pitch at the same time.
        PITCH_ONLY: both axes lateral. ROLL_ONLY: both axes forward.
    """

    EQUAL_RATE = "equal-rate"
    WEIGHTED = "weighted"
    SIMULTANEOUS = "simultaneous"
    PITCH_ONLY = "pitch-only"
    ROLL_ONLY = "roll-only"


def incidence_by_criterion(
    inertia: FloatArray, momenta: FloatArray | None = None
) -> Mapping[Criterion, float]:
    """The best incidence under each criterion [rad] (docs/theory.md, Incidence angle).

    Args:
        inertia: of the body that the wheels turn, about its centre of mass in B [kg m^2], shape (3,
            3).
        momenta: required in roll and in pitch [N m s], shape (2,); only their ratio matters. By
            default, those for equal rates about both axes.
    """
    # For equal rates the ratio of these is the tangent: I_xx / s + |J_xy| / c = |J_xy| / s + I_yy /
    # c. Where the coupling exceeds either inertia, both rates load the same axis most, and the
    # incidence of the uncoupled robot is as good as any.
    tilt = TiltInertia.of(inertia)
    decoupled = tilt.diagonal - np.abs(tilt.product)
    equal_rate = decoupled if (decoupled > 0.0).all() else tilt.diagonal
    same_rate = np.diag(inertia)[:2]
    roll, pitch = np.abs(momenta) if momenta is not None and np.any(momenta) else same_rate
    return {
        Criterion.EQUAL_RATE: float(np.arctan2(*equal_rate)),
        Criterion.WEIGHTED: float(np.arctan2(roll, pitch)),
        Criterion.SIMULTANEOUS: float(np.arctan2(np.cbrt(roll), np.cbrt(pitch))),
        Criterion.PITCH_ONLY: 0.0,
        Criterion.ROLL_ONLY: float(np.pi / 2.0),
    }


def heading_drift(inertia: FloatArray) -> tuple[float, float]:
    """Yaw rate per roll rate and per pitch rate at zero momentum.

    Args:
        inertia: of the robot with its device about the centre of mass in B [kg m^2], shape (3, 3).
    """
    roll, pitch = -inertia[2, :2] / inertia[2, 2]
    return float(roll), float(pitch)
