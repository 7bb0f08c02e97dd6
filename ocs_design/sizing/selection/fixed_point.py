"""Wheel, incidence and robot settled together, for many modules at once.

A heavier module asks for a larger wheel. Its spin inertia, the rim and the housing for it, the
inertia of the whole with them, and the spin inertia that the maneuvers then ask for are iterated to
their fixed point, from a lower bound up. Each iteration looks at some incidences around the best so
far and takes one step of Newton's method towards what is asked for at the best of them; it closes
in on the incidence as it goes. What a turn asks of the busier wheel, |P_x| / s + |P_y| / c, has one
valley over the incidence, and so has the largest of several such.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray, put_rows
from ocs_design.sizing.module_shape import ModuleShape
from ocs_design.sizing.selection.demand import Reach, reach
from ocs_design.sizing.selection.lot import Lot
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.trunk import trunk_inertia

_ROUNDS = 40
_POINTS = np.linspace(-1.0, 1.0, 5)
# The next incidences reach a little beyond the neighbours of the best one.
_CLOSE_IN = 0.55
# Of what is asked for over the spin inertia, up to where a secant is trusted.
_STEEPEST, _STEEPEST_NEAR = 0.9, 0.9995
# How close to each other two iterations are near, relative.
_NEAR = 0.02
# Beyond any spin inertia [kg m^2], and below any margin.
_BEYOND, _NOTHING = 1e9, 1e-9


class Design(NamedTuple):
    """What a candidate's dimensions are chosen by, beyond its spin inertia; shape (n,) each.

    Attributes:
        radius: outer radius of the rim [m]; the nearest possible is taken.
        flatness: see `lightest_module_at`.
        angle: incidence [rad]. width: how far around it to look for a better one [rad].
    """

    radius: FloatArray
    flatness: FloatArray
    angle: FloatArray
    width: FloatArray


class FixedPoint(NamedTuple):
    """Candidates of given designs, shape (n,) each.

    Attributes:
        spin_inertia: of each wheel [kg m^2]; of what cannot be, that of the largest margin.
        angle: the best incidence [rad].
        shapes: of rims and housings.
        possible: whether the candidate can be.
        margin: of the worst part of the requirement, see `Reach`.
        residual: relative change of the spin inertia in one more iteration.
    """

    spin_inertia: FloatArray
    angle: FloatArray
    shapes: ModuleShape
    possible: NDArray[np.bool_]
    margin: FloatArray
    residual: FloatArray

    def take(self, rows: NDArray[np.intp]) -> "FixedPoint":
        """The candidates of these rows."""
        return FixedPoint(
            spin_inertia=self.spin_inertia[rows],
            angle=self.angle[rows],
            shapes=self.shapes.take(rows),
            possible=self.possible[rows],
            margin=self.margin[rows],
            residual=self.residual[rows],
        )

    def put(self, rows: NDArray[np.intp], others: "FixedPoint") -> "FixedPoint":
        """With other candidates in these rows."""
        return FixedPoint(
            spin_inertia=put_rows(self.spin_inertia, rows, others.spin_inertia),
            angle=put_rows(self.angle, rows, others.angle),
            shapes=self.shapes.put(rows, others.shapes),
            possible=put_rows(self.possible, rows, others.possible),
            margin=put_rows(self.margin, rows, others.margin),
            residual=put_rows(self.residual, rows, others.residual),
        )


class Tolerance(NamedTuple):
    """When candidates count as settled.

    Attributes:
        residual: of the spin inertia, relative. width: of the incidence, over the first one.
    """

    residual: float
    width: float


class _Step(NamedTuple):
    """What one iteration finds: the best incidence, what is asked for there, and the margin."""

    angle: FloatArray
    width: FloatArray
    asked: FloatArray
    margin: FloatArray


def fixed_point(
    problem: SelectionProblem, lot: Lot, start: FloatArray, design: Design, tolerance: Tolerance
) -> tuple[FixedPoint, int]:
    """The smallest wheels that do everything that is required, and the iterations it took.

    Args:
        problem: robot, requirement and place.
        lot: the candidates.
        start: lower bounds of their spin inertias [kg m^2], shape (n,).
        design: of each.
        tolerance: when to stop.
    """
    stated = problem.requirement.spin_inertia
    spin = start = np.maximum(start, lot.least_spin_inertia)
    if stated is not None:
        spin = np.full_like(spin, stated)
    narrow = tolerance.width * design.width
    last_spin = last_asked = np.zeros_like(spin)
    best_spin, best_margin = spin, np.zeros_like(spin)
    iterations = 0
    while True:
        iterations += 1
        shapes = lot.shapes_at(spin, design.radius, design.flatness)
        step = _step(problem, lot, spin, shapes, design)
        design = design._replace(angle=step.angle, width=step.width)
        asked = spin if stated is not None else step.asked
        better = step.margin > best_margin
        best_spin = np.where(better, spin, best_spin)
        best_margin = np.where(better, step.margin, best_margin)
        residual = np.abs(asked / spin - 1.0)
        following, runaway = _along_secant(spin, asked, last_spin, last_asked)
        possible = (shapes.mass > 0.0) & np.isfinite(asked) & ~runaway
        arrived = possible & (residual <= tolerance.residual)
        ended = (design.width <= narrow) & (arrived | ~possible)
        if ended.all() or iterations == _ROUNDS:
            break
        last_spin, last_asked = spin, asked
        # At a poor incidence too much is asked for: once it is better, begin anew.
        spin = np.where(ended, spin, np.where(possible, following, start))
    # A residual leaves as much of the margin open.
    settled = ended & arrived & (step.margin >= 1.0 - 10.0 * tolerance.residual)
    spin = np.where(settled, spin, best_spin)
    shapes = lot.shapes_at(spin, design.radius, design.flatness)
    margin = np.where(settled, step.margin, best_margin)
    return FixedPoint(spin, design.angle, shapes, settled, margin, residual), iterations


def _step(
    problem: SelectionProblem, lot: Lot, spin: FloatArray, shapes: ModuleShape, design: Design
) -> _Step:
    """Look at the incidences around that of the design, and ask for a better spin inertia.

    Turned maneuvers have no say in the incidence of the design.
    """
    trunk = trunk_inertia(problem.robot, problem.place, lot.modules(spin, shapes))
    searched = bool(design.width.any())
    offsets = design.width[:, None] * (_POINTS if searched else np.zeros(1))
    angles = np.clip(design.angle[:, None] + offsets, 0.0, np.pi / 2.0)
    tried, turned = reach(problem.requirement, lot.drives, trunk, spin, angles)
    best, row = _best(tried), np.arange(spin.size)
    angle, last = angles[row, best], offsets.shape[1] - 1
    inside = ((best > 0) & (best < last)) | (angle == 0.0) | (angle == np.pi / 2.0)
    asked = np.maximum(tried.following[row, best], turned.following[:, 0])
    return _Step(
        angle=angle,
        width=np.where(inside | ~np.isfinite(asked), _CLOSE_IN, 1.0) * design.width,
        asked=np.maximum(asked, lot.least_spin_inertia),
        margin=np.minimum(tried.margin[row, best], turned.margin[:, 0]),
    )


def _best(tried: Reach) -> NDArray[np.intp]:
    """Where the least is asked for; where nothing is enough, what comes closest.

    Where nothing is asked for, one is as good as the other, and the middle is kept.
    """
    possible = np.isfinite(tried.following)
    score = np.where(possible, tried.following, _BEYOND / np.maximum(tried.margin, _NOTHING))
    middle = score.shape[1] // 2
    score[:, middle] *= 1.0 - 1e-15
    return np.asarray(np.argmin(score, axis=1))


def _along_secant(
    spin: FloatArray, asked: FloatArray, last_spin: FloatArray, last_asked: FloatArray
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """To where what is asked for meets the spin inertia, by the last two; and if it never does.

    Close to each other, the last two tell how steeply what is asked for rises, which it does ever
    more steeply: a secant from below leads no further than to the fixed point, and none is ahead
    where it is steeper than one. Farther apart, they may still tell how Newton's method went.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        steepness = (asked - last_asked) / (spin - last_spin)
        near = np.abs(asked / last_spin - 1.0) < _NEAR
        steady = (last_spin > 0.0) & (steepness > 0.0)
        steady &= steepness < np.where(near, _STEEPEST_NEAR, _STEEPEST)
        following = spin + (asked - spin) / np.where(steady, 1.0 - steepness, 1.0)
        runaway = near & (steepness > 1.0) & (asked > spin) & (spin > last_spin)
    return following, runaway
