"""The lightest device of each candidate: dimensions, incidence and fixed point together.

The lightest module of a given spin inertia has one valley over its radius (`lightest_module`), but
a smaller or a flatter one stands nearer to the robot and may ask for less, and where the torque
hardly does it may be the only one that can be. So masses are compared at their fixed points, with
the best incidence for each: where two maneuvers ask for the same, neither can be mended alone.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.module_radii import smallest_radius
from ocs_design.sizing.rim_closed_form import smallest_spin_inertia
from ocs_design.sizing.selection.fixed_point import Design, FixedPoint, Tolerance, fixed_point
from ocs_design.sizing.selection.lot import Lot
from ocs_design.sizing.selection.problem import SelectionProblem

# Of the logarithm of a radius, around the best so far.
_POINTS = np.linspace(-1.0, 1.0, 7)
# How far around: each time a little beyond the neighbours of the best so far. First as shares of
# all radii, then as they are.
_COARSE, _CLOSER = (1.0, 0.4, 0.15), (0.1, 0.04, 0.016, 0.006, 0.0025, 0.001)
# Of the logarithm of a flatness, which goes with the radius: either alone may be too much.
_FEW_POINTS = np.array([-1.0, 0.0, 1.0])
# Half the range of incidences around a design that is about settled [rad].
_NEAR = 0.01
_ROUGH = Tolerance(residual=1e-7, width=0.05)
_FINE = Tolerance(residual=1e-12, width=1e-3)
# Margin of what cannot be, but may if looked at more closely.
_PROMISING = 0.97
# [kg], of what cannot be; the closer to possible, the less is added.
_BEYOND = 1e9


class Outset(NamedTuple):
    """Where to look for a candidate first; shape (n,) each.

    Attributes:
        spin_inertia: a lower bound [kg m^2].
        mass: a lower bound, of both modules [kg].
        angle: incidence [rad]. width: how far around it [rad]; 0: there only.
    """

    spin_inertia: FloatArray
    mass: FloatArray
    angle: FloatArray
    width: FloatArray


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
    start = np.maximum(outset.spin_inertia, lot.least_spin_inertia)
    radius, span = _radii(problem, lot, start)
    design = Design(radius, np.ones_like(start), outset.angle, outset.width)
    search = _Search(problem, lot, start, design)
    for share in _COARSE:
        search.close_in(share * span, share * outset.width, np.zeros(1))
    point, iterations = search.point(np.zeros_like(start))
    return Settled(lot, outset, search.design, point, iterations)


def refine(problem: SelectionProblem, settled: Settled, lightest: float) -> Settled:
    """The same, with what may be the lightest device of all to about 1e-6 of its mass.

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
    search, width = _Search(problem, lot, start, design), settled.outset.width[rows]
    width = np.minimum(width, _NEAR)
    for span in _CLOSER:
        share = span / _CLOSER[0]
        search.close_in(np.full_like(width, span), share * width, share * _FEW_POINTS)
    point, _ = search.point(1e-3 * width)
    return replace(settled, point=settled.point.put(rows, point))


def _radii(problem: SelectionProblem, lot: Lot, start: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The middle of the outer radii that a rim may have [m], and half the range of their logarithm.

    A larger wheel than that of the start may be needed, and may have a larger radius.
    """
    rim = np.maximum(start - lot.drives.rotor_share, smallest_spin_inertia(lot.limits))
    high = problem.envelope.outer_radius_max
    low = np.minimum(smallest_radius(rim, lot.limits), high)
    return np.sqrt(low * high), np.log(high / low) / 2.0


@dataclass(eq=False)
class _Search:
    """Candidates, where to start from, and the best designs so far."""

    problem: SelectionProblem
    lot: Lot
    start: FloatArray
    design: Design

    def close_in(self, span: FloatArray, width: FloatArray, flatness: FloatArray) -> None:
        """Take the best of several designs around, or the closest to possible.

        Args:
            span: of the logarithm of the radius, shape (n,).
            width: of the incidence [rad], shape (n,).
            flatness: steps of its logarithm, shape (k,).
        """
        radii, flat = np.meshgrid(_POINTS, flatness, indexing="ij")
        times = radii.size
        each = Design(*(np.repeat(column, times) for column in self.design._replace(width=width)))
        each = each._replace(
            radius=each.radius * np.exp(np.outer(span, radii).ravel()),
            flatness=np.maximum(each.flatness * np.exp(np.tile(flat.ravel(), span.size)), 1.0),
        )
        start, lot = np.repeat(self.start, times), self.lot.repeated(times)
        point, _ = fixed_point(self.problem, lot, start, each, _ROUGH)
        with np.errstate(divide="ignore"):
            score = np.where(point.possible, point.shapes.mass, _BEYOND / point.margin)
        at = np.argmin(score.reshape(-1, times), axis=1) + times * np.arange(self.start.size)
        self.design = Design(each.radius[at], each.flatness[at], point.angle[at], width)

    def point(self, width: FloatArray) -> tuple[FixedPoint, int]:
        """What the best so far come to, to all digits."""
        design = self.design._replace(width=width)
        return fixed_point(self.problem, self.lot, self.start, design, _FINE)
