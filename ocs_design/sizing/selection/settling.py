"""The lightest device of each candidate: dimensions, incidence and fixed point together.

The lightest module of a given spin inertia has one valley over its radius (`lightest_module`), but
a smaller or a flatter one stands nearer to the robot and may ask for less, and where the torque
hardly does it may be the only one that can be. So masses are compared at their fixed points, with
the best incidence for each: where two maneuvers ask for the same, neither can be mended alone.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray, put_rows
from ocs_design.sizing.module_radii import smallest_radius
from ocs_design.sizing.rim_closed_form import smallest_spin_inertia
from ocs_design.sizing.selection.fixed_point import (
    Design,
    FixedPoint,
    Tolerance,
    fixed_point,
)
from ocs_design.sizing.selection.lot import Lot
from ocs_design.sizing.selection.outset import Outset
from ocs_design.sizing.selection.polishing import polish
from ocs_design.sizing.selection.problem import SelectionProblem


class _Around(NamedTuple):
    """Where to look around the best design so far.

    Attributes:
        span: how far, of the logarithm of the radius; ten times as far of the flatness.
        radii, flatnesses: how many of each; a radius or a flatness alone may be too much.
    """

    span: float
    radii: int
    flatnesses: int

    @property
    def steps(self) -> tuple[FloatArray, FloatArray]:
        """Of the logarithms of radius and flatness, every one with each other, shape (k,)."""
        flat = 10.0 * self.span * np.linspace(-1.0, 1.0, self.flatnesses)
        pairs = np.meshgrid(
            self.span * np.linspace(-1.0, 1.0, self.radii),
            flat if self.flatnesses > 1 else np.zeros(1),
            indexing="ij",
        )
        return pairs[0].ravel(), pairs[1].ravel()


# Each time a little beyond the neighbours of the best so far: first over shares of all radii...
_COARSE = (_Around(1.0, 7, 1), _Around(0.4, 7, 1), _Around(0.15, 7, 1))
# ... then over what they are, flatness too.
_CLOSER = tuple(_Around(span, 7, 3) for span in (0.1, 0.04, 0.016, 6e-3))
# Over what is not possible yet is given up.
_HOPELESS = 0.01
# By how much the mass may fall as the design is closed in on, over the span.
_FALL = 0.5
# Half the range of incidences around a design that is about settled [rad].
_NEAR = 0.01
_ROUGH = Tolerance(residual=1e-7, width=0.05)
_FINE = Tolerance(residual=1e-12, width=1e-3)
# Margin of what cannot be, but may if looked at more closely, and to all digits.
_PROMISING, _ALMOST = 0.97, 0.998
# [kg], of what cannot be; the closer to possible, the less is added.
_BEYOND = 1e9


@dataclass(frozen=True, eq=False)
class Settled:
    """Candidates about at their best, shape (n,) each.

    Attributes:
        lot: of them. outset: of each.
        design: what their dimensions are chosen by.
        point: what they come to. iterations: of all together.
    """

    lot: Lot
    outset: Outset
    design: Design
    point: FixedPoint
    iterations: int

    @property
    def mass(self) -> FloatArray:
        """Of both modules [kg]; inf where the candidate cannot be."""
        mass = 2.0 * (self.lot.drives.mass + self.point.shapes.mass)
        return np.where(self.point.possible, mass, np.inf)


def settle(problem: SelectionProblem, lot: Lot, outset: Outset) -> Settled:
    """A device of each candidate that does what is required, if there is any.

    It is up to some percent heavier than it would have to be.

    Args:
        problem: robot, requirement and place.
        lot: the candidates. outset: of each.
    """
    *_, search = _closing_in(problem, lot, outset)
    point, iterations = _to_all_digits(problem, search)
    return Settled(lot, outset, search.design, point, iterations)


def any_settles(problem: SelectionProblem, lot: Lot, outset: Outset) -> bool:
    """Whether `settle` finds a device of any candidate; closes in no further than to the first."""
    for search in _closing_in(problem, lot, outset):
        some = search.take(np.flatnonzero(search.point.possible))
        if some.score.size and _to_all_digits(problem, some)[0].possible.any():
            return True
    return False


def refine(problem: SelectionProblem, settled: Settled, lightest: float) -> Settled:
    """The same, with what may be the lightest device of all to all digits.

    Args:
        problem: robot, requirement and place.
        settled: to be refined.
        lightest: mass of the lightest device so far [kg].
    """
    promising = settled.point.possible | (settled.point.margin > _PROMISING)
    rows = np.flatnonzero(promising & (settled.outset.mass < lightest))
    if not rows.size:
        return settled
    lot, design = settled.lot.take(rows), Design(*(column[rows] for column in settled.design))
    start = np.maximum(settled.outset.spin_inertia[rows], lot.least_spin_inertia)
    width = np.minimum(settled.outset.width[rows], _NEAR) / _CLOSER[0].span
    search = _Search.at(problem, lot, start, design._replace(width=width))
    active = np.arange(rows.size)
    for around in _CLOSER:
        some = search.take(active)
        some.close_in(around, np.ones(active.size), around.span * width[active])
        search.put(active, some)
        keep = some.score <= (1.0 + _FALL * around.span) * search.score.min()
        # What is not possible yet may be, looked at more closely.
        hope = (around.span > _HOPELESS) | (some.point.margin > _ALMOST)
        active = active[keep | ((some.score >= _BEYOND / 2.0) & hope)]
    found = search.take(active)
    return replace(settled, point=_polished(settled.point, problem, found, rows[active]))


def _closing_in(problem: SelectionProblem, lot: Lot, outset: Outset) -> Iterator["_Search"]:
    """One search, at first and each time that it has come closer."""
    start = np.maximum(outset.spin_inertia, lot.least_spin_inertia)
    radius, span = _radii(problem, lot, start)
    design = Design(radius, np.ones_like(start), outset.angle, outset.width)
    search = _Search.at(problem, lot, start, design)
    yield search
    for around in _COARSE:
        search.close_in(around, scale=span, width=around.span * outset.width)
        yield search


def _to_all_digits(problem: SelectionProblem, search: "_Search") -> tuple[FixedPoint, int]:
    """What the best so far come to, and the iterations it took.

    The lightest radius may be the last that can be: there the fixed point runs away again.
    """
    point, iterations = search.to_all_digits()
    lost = np.flatnonzero(search.point.possible & ~point.possible)
    return _polished(point, problem, search.take(lost), lost), iterations


def _polished(
    point: FixedPoint, problem: SelectionProblem, found: "_Search", rows: NDArray[np.intp]
) -> FixedPoint:
    """What is settled, with lighter devices in these rows wherever there are any."""
    for at, row in enumerate(rows):
        one = np.array([at])
        polished = polish(problem, found.lot.take(one), found.point.take(one))
        heavier = point.possible[row] & (point.shapes.mass[row] <= polished.shapes.mass[0])
        if polished.possible[0] and not heavier:
            point = point.put(np.array([row]), polished)
    return point


def _radii(problem: SelectionProblem, lot: Lot, start: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The middle of the outer radii that a rim may have [m], and half the range of their logarithm.

    A larger wheel than that of the start may be needed, and may have a larger radius.
    """
    rim = np.maximum(start - lot.drives.beside_rim, smallest_spin_inertia(lot.limits))
    high = problem.envelope.outer_radius_max
    low = np.minimum(smallest_radius(rim, lot.limits), high)
    return np.sqrt(low * high), np.log(high / low) / 2.0


@dataclass(eq=False)
class _Search:
    """Candidates, where to start from, and the best designs so far.

    Attributes:
        problem: robot, requirement and place.
        lot: the candidates. start: lower bounds of their spin inertias [kg m^2], shape (n,).
        design: the best so far. point: what they come to.
        score: their masses [kg], shape (n,); large where they cannot be, the closer to it the less.
    """

    problem: SelectionProblem
    lot: Lot
    start: FloatArray
    design: Design
    point: FixedPoint
    score: FloatArray

    @classmethod
    def at(
        cls, problem: SelectionProblem, lot: Lot, start: FloatArray, design: Design
    ) -> "_Search":
        """Begin with these designs."""
        point, _ = fixed_point(problem, lot, start, design, _ROUGH)
        found = design._replace(angle=point.angle)
        return cls(problem, lot, start, found, point, _score(lot, point))

    def take(self, rows: NDArray[np.intp]) -> "_Search":
        """The candidates of these rows."""
        design = Design(*(column[rows] for column in self.design))
        lot, point = self.lot.take(rows), self.point.take(rows)
        return _Search(self.problem, lot, self.start[rows], design, point, self.score[rows])

    def put(self, rows: NDArray[np.intp], others: "_Search") -> None:
        """Their designs back."""
        columns = zip(self.design, others.design, strict=True)
        self.design = Design(*(put_rows(own, rows, other) for own, other in columns))
        self.point = self.point.put(rows, others.point)
        self.score = put_rows(self.score, rows, others.score)

    def close_in(self, around: _Around, scale: FloatArray, width: FloatArray) -> None:
        """Take the best of several designs around wherever it is better than the best so far.

        Args:
            around: where to look.
            scale: of its span, shape (n,).
            width: of the incidence [rad], shape (n,).
        """
        radii, flatnesses = around.steps
        times = radii.size
        each = Design(*(np.repeat(column, times) for column in self.design._replace(width=width)))
        radius = each.radius * np.exp(np.outer(scale, radii).ravel())
        flatness = each.flatness * np.exp(np.tile(flatnesses, scale.size))
        each = each._replace(radius=radius, flatness=np.maximum(flatness, 1.0))
        tried = _Search.at(
            self.problem, self.lot.repeated(times), np.repeat(self.start, times), each
        )
        best = np.argmin(tried.score.reshape(-1, times), axis=1) + times * np.arange(scale.size)
        better = np.flatnonzero(tried.score[best] < self.score)
        self.put(better, tried.take(best[better]))
        self.design = self.design._replace(width=width)

    def to_all_digits(self) -> tuple[FixedPoint, int]:
        """What the best so far come to at their incidence, and the iterations it took."""
        design = self.design._replace(width=np.zeros_like(self.score))
        return fixed_point(self.problem, self.lot, self.start, design, _FINE)


def _score(lot: Lot, point: FixedPoint) -> FloatArray:
    with np.errstate(divide="ignore"):
        mass = lot.drives.mass + point.shapes.mass
        return np.where(point.possible, mass, _BEYOND / point.margin)
