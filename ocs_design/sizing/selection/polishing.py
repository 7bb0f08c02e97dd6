"""One candidate to all digits: the lightest device as a smooth programme, without a fixed point.

Over the logarithms of outer radius, height and wall, and the incidence, the mass is the smallest
for which every part of the requirement is met on the robot with the device. Where a device can
hardly carry itself, a fixed point at a given incidence runs away though there is one beside it;
here what is asked for is a limit as any other, and may be missed on the way.
"""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.drive.tilt_inertia import OUT_OF_REACH
from ocs_design.sizing.cylinder import cylinder_mass, cylinder_spin_inertia
from ocs_design.sizing.module_shape import ModuleShape
from ocs_design.sizing.rim_closed_form import BORE_SHARE
from ocs_design.sizing.selection.demand import margins, reach, shares_of
from ocs_design.sizing.selection.fixed_point import FixedPoint
from ocs_design.sizing.selection.lot import Lot
from ocs_design.sizing.selection.problem import SelectionProblem
from ocs_design.sizing.selection.trunk import TrunkInertia, trunk_inertia
from ocs_design.sizing.sequential_programming import Optimum, minimise

# First steps: of the logarithms, and of the incidence [rad].
_TRUST = 0.05
HELD = 1e-9
"""What a limit may be missed by, relative: rounding."""

# Margins beyond these tell nothing.
_LEAST, _MOST = 1e-6, 1e6


def polish(problem: SelectionProblem, lot: Lot, point: FixedPoint) -> FixedPoint:
    """The lightest device of one candidate near a point; impossible where none is found.

    Args:
        problem: robot, requirement and place.
        lot: the candidate alone.
        point: where to start, feasible or not.
    """
    programme = Programme(problem, lot)
    optimum = lightest(programme, coordinates(point.shapes, float(point.angle[0])))
    return programme.fixed_point(optimum.point[None], possible=optimum.violation <= HELD)


def lightest(programme: "Programme", start: FloatArray, **how: float) -> Optimum:
    """Near a start, see `coordinates`; the logarithm of the mass of a module is its value.

    Args:
        programme: of one candidate.
        start: feasible or not.
        how: see `minimise`.
    """
    held, angle = programme.holds_incidence(start), float(start[-1])
    turn = (angle, angle, 0.0) if held else (0.0, np.pi / 2.0, _TRUST)
    return minimise(
        programme,
        start,
        low=np.array([*np.full(3, -np.inf), turn[0]]),
        high=np.array([*np.full(3, np.inf), turn[1]]),
        trust=np.array([*np.full(3, _TRUST), turn[2]]),
        **how,
    )


@dataclass(frozen=True, eq=False)
class Programme:
    """One candidate on its robot, a point is what `coordinates` gives."""

    problem: SelectionProblem
    lot: Lot

    def __call__(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """See `sequential_programming.Evaluate`."""
        lot, shapes = self.lot.repeated(len(points)), self._shapes(points)
        spin, trunk = self._on_trunk(lot, shapes)
        met = margins(self.problem.requirement, lot.drives, trunk, spin, points[:, 3])
        limits = [np.log(np.clip(met, _LEAST, _MOST)), self._room(shapes), self._stated(spin)]
        return np.log(lot.drives.mass + shapes.mass), np.column_stack(limits)

    def holds_incidence(self, point: FloatArray) -> bool:
        """Whether it is stated, or no other one is near it.

        Beside the one that leaves an axis out of reach, and to itself, the wheels would have to
        take what the coupling asks there, with next to no lever.
        """
        shares = shares_of(point[None, 3:])
        _, trunk = self._on_trunk(self.lot, self._shapes(point[None]))
        alone = bool((shares <= OUT_OF_REACH).any() and trunk.at(shares).product.any())
        return self.problem.incidence is not None or alone

    def fixed_point(self, points: FloatArray, *, possible: bool) -> FixedPoint:
        """A single point as what it comes to."""
        shapes, angle = self._shapes(points), points[:, 3]
        spin, trunk = self._on_trunk(self.lot, shapes)
        requirement = self.problem.requirement
        parts = reach(requirement, self.lot.drives, trunk, spin, angle[:, None])
        asked = np.maximum.reduce(
            [self.lot.least_spin_inertia, *(p.following[:, 0] for p in parts)]
        )
        stated = requirement.spin_inertia
        margin = np.minimum(*(part.margin[:, 0] for part in parts))
        # Where no larger wheel would do either, a margin that rounding leaves below one asks for
        # an infinite one.
        missed = np.where(np.isfinite(asked), np.abs(asked / spin - 1.0), np.abs(margin - 1.0))
        residual = np.zeros(1) if stated is not None else missed
        return FixedPoint(spin, angle, shapes, np.array([possible]), margin, residual)

    def _on_trunk(self, lot: Lot, shapes: ModuleShape) -> tuple[FloatArray, TrunkInertia]:
        """Spin inertias of the wheels [kg m^2], and what they turn."""
        dimensions = (shapes.inner_radius, shapes.outer_radius, shapes.height)
        cut = lot.limits.cuts.axial_inertia(shapes.inner_radius, shapes.outer_radius, 1.0)
        rim = (cylinder_spin_inertia(*dimensions, 1.0) - cut) * np.asarray(lot.limits.density)
        web = shapes.web_mass * shapes.inner_radius**2 / 2.0
        spin = rim + web + lot.drives.beside_rim
        modules = lot.modules(spin, shapes)
        return spin, trunk_inertia(self.problem.robot, self.problem.place, modules)

    def _shapes(self, points: FloatArray) -> ModuleShape:
        outer, height, wall = np.exp(points[:, :3]).T
        # A wall is at most the radius; one that is thicker is refused as too small a bore.
        inner = np.maximum(outer - wall, BORE_SHARE * outer / 2.0)
        density = np.asarray(self.lot.limits.density)
        cut = self.lot.limits.cuts.mass(inner, outer, 1.0)
        mass = (cylinder_mass(inner, outer, height, 1.0) - cut) * density
        web = np.pi * density * self.lot.limits.web * inner**2
        return ModuleShape(inner, outer, height, mass, web, self.lot.shell.mass(outer, height))

    def _room(self, shapes: ModuleShape) -> FloatArray:
        """By how much rims stay within their limits, as logarithms, shape (k, limits)."""
        limits, nu = self.lot.limits, self.lot.limits.poisson_ratio
        inner, outer, height = shapes.inner_radius, shapes.outer_radius, shapes.height
        stretch = (3.0 + nu) * outer**2 + (1.0 - nu) * inner**2
        pairs = (
            (outer, limits.outer_radius_max),
            (height, limits.height_max),
            (shapes.rim_mass, limits.mass_max),
            (stretch, limits.stretch_max),
            (limits.outer_radius_min, outer),
            (limits.height_min, height),
            (limits.wall_min, outer - inner),
            (np.maximum(limits.inner_radius_min, BORE_SHARE * outer), inner),
        )
        with np.errstate(divide="ignore"):
            return np.column_stack(
                [np.log(np.clip(most / value, _LEAST, _MOST)) for value, most in pairs]
            )

    def _stated(self, spin: FloatArray) -> FloatArray:
        """A stated spin inertia is met exactly, any other is none; shape (k, 2)."""
        stated = self.problem.requirement.spin_inertia
        beyond = np.zeros_like(spin) if stated is None else np.log(spin / stated)
        return np.column_stack([beyond, -beyond])


def coordinates(shapes: ModuleShape, angle: float) -> FloatArray:
    """Of a single shape: logarithms of outer radius, height and wall, and the incidence [rad]."""
    inner, outer, height = (float(value[0]) for value in shapes[:3])
    return np.array([np.log(outer), np.log(height), np.log(outer - inner), angle])
