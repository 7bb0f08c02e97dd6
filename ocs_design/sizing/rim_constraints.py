"""The limits of a rim as constraints in CVXPY, each with its derivative by its limit.

Variables are a = (R / s)^2 and b = (r / s)^2 with a scale s, so that both are of the order of one,
and limits that may be far away are divided by their own size: else the solver loses digits. By
Lagrange, the optimal mass changes with a limit as the constraint g(a, b; limit) <= 0 does, times
its multiplier.
"""

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.rim_problem import RimProblem

if TYPE_CHECKING:
    from cvxpy import Constraint as CvxpyConstraint
    from cvxpy import Expression, Variable


class Constraint(NamedTuple):
    """One limit, g(a, b; limit) <= 0.

    Attributes:
        convex: the CVXPY constraint.
        value: of g itself, without tangents.
        gradient: of g by a and b.
        derivative: of g by the limit where it binds, at (a, b) [1 / SI unit of the limit].
    """

    convex: "CvxpyConstraint"
    value: Callable[[float, float], float]
    gradient: Callable[[float, float], tuple[float, float]]
    derivative: Callable[[float, float], float]


class Tangent:
    """The line y <= f(x0) + f'(x0) (x - x0) in place of y <= f(x), for a convex f and a movable x0.

    Attributes:
        bound: the line as a CVXPY expression of x.
    """

    def __init__(self, x: "Variable", function: Callable[[float], tuple[float, float]]) -> None:
        """`function` returns f and f'."""
        cvxpy = import_module("cvxpy")
        self._x, self._function = x, function
        self._slope, self._offset = cvxpy.Parameter(), cvxpy.Parameter()
        self.bound: Expression = self._slope * x + self._offset

    def touch(self) -> None:
        """Move x0 to the value that x has now."""
        contact = np.asarray(self._x.value).item()
        height, slope = self._function(contact)
        self._slope.value, self._offset.value = slope, height - slope * contact


class RimConstraints:
    """All limits of one rim problem.

    Attributes:
        a, b: CVXPY variables.
        by_name: the limits that are set, in the words of the specification.
    """

    def __init__(self, problem: RimProblem, scale: float) -> None:
        # Importing CVXPY takes a second, which only those pay who solve.
        self._cvxpy = import_module("cvxpy")
        self._problem, self._room, self._scale = problem, problem.envelope, scale
        self.a: Variable
        self.b: Variable
        self.a, self.b = self._cvxpy.Variable(), self._cvxpy.Variable()
        self._tangents: list[Tangent] = []
        self.by_name = {"r_max": self._r_max(), "r_min": self._r_min(), "h_max": self._h_max()}
        if self._room.wall_min > 0.0:
            self.by_name["wall_min"] = self._wall_min()
        if self._room.height_min > 0.0:
            self.by_name["h_min"] = self._h_min()
        if np.isfinite(self._room.mass_max):
            self.by_name["wheel_mass_max"] = self._wheel_mass_max()
        if np.isfinite(self._problem.stretch_max):
            self.by_name["hoop_stress"] = self._hoop_stress()

    def touch(self, a: float, b: float) -> None:
        """Move the tangents to this point."""
        self.a.value, self.b.value = a, b
        for tangent in self._tangents:
            tangent.touch()

    def point(self) -> FloatArray:
        """The values of a and b, shape (2,); never below zero, as a solver's last digit may be."""
        return np.maximum([np.asarray(x.value).item() for x in (self.a, self.b)], 0.0)

    def _tangent(
        self, x: "Variable", function: Callable[[float], tuple[float, float]]
    ) -> "Expression":
        tangent = Tangent(x, function)
        self._tangents.append(tangent)
        return tangent.bound

    def _r_max(self) -> Constraint:
        radius = self._room.outer_radius_max
        largest = (radius / self._scale) ** 2
        return Constraint(
            convex=self.a / largest <= 1.0,
            value=lambda a, _b: a / largest - 1.0,
            gradient=lambda _a, _b: (1.0 / largest, 0.0),
            derivative=lambda _a, _b: -2.0 / radius,
        )

    def _r_min(self) -> Constraint:
        inner = self._room.inner_radius_min / self._scale
        return Constraint(
            convex=self.b >= inner**2,
            value=lambda _a, b: inner**2 - b,
            gradient=lambda _a, _b: (0.0, -1.0),
            derivative=lambda _a, _b: 2.0 * inner / self._scale,
        )

    def _h_max(self) -> Constraint:
        """a^2 - b^2 >= P as a second-order cone, norm(b, sqrt(P)) <= a.

        The geometric mean of a - b and a + b is the same cone, but costs Clarabel four digits of
        the multipliers.
        """
        height = self._room.height_max
        least = self._spread(height)
        norm = self._cvxpy.norm(self._cvxpy.hstack([self.b, np.sqrt(least)]))
        return Constraint(
            convex=norm <= self.a,
            value=lambda a, b: np.hypot(b, np.sqrt(least)) - a,
            gradient=lambda _a, b: (-1.0, b / np.hypot(b, np.sqrt(least))),
            derivative=lambda _a, b: -least / (2.0 * height * np.hypot(b, np.sqrt(least))),
        )

    def _h_min(self) -> Constraint:
        """a <= sqrt(Q + b^2), by its tangent."""
        height = self._room.height_min
        largest = self._spread(height)
        return Constraint(
            convex=self.a <= self._tangent(self.b, self._widest_rim),
            value=lambda a, b: a - self._widest_rim(b)[0],
            gradient=lambda _a, b: (1.0, -self._widest_rim(b)[1]),
            derivative=lambda _a, b: largest / (2.0 * height * self._widest_rim(b)[0]),
        )

    def _wall_min(self) -> Constraint:
        """b <= (sqrt(a) - t)^2, by its tangent."""
        wall = self._room.wall_min / self._scale
        return Constraint(
            convex=self.b <= self._tangent(self.a, self._widest_bore),
            value=lambda a, b: b - self._widest_bore(a)[0],
            gradient=lambda a, _b: (-self._widest_bore(a)[1], 1.0),
            derivative=lambda a, _b: 2.0 * (np.sqrt(a) - wall) / self._scale,
        )

    def _wheel_mass_max(self) -> Constraint:
        mass = self._room.mass_max
        least = 2.0 * self._problem.spin_inertia / (mass * self._scale**2)
        return Constraint(
            convex=(self.a + self.b) / least >= 1.0,
            value=lambda a, b: 1.0 - (a + b) / least,
            gradient=lambda _a, _b: (-1.0 / least, -1.0 / least),
            derivative=lambda _a, _b: -1.0 / mass,
        )

    def _hoop_stress(self) -> Constraint:
        """The derivative is by the allowed stress [1 / Pa]."""
        nu = self._problem.material.poisson_ratio or 0.0
        stretch = self._problem.stretch_max / self._scale**2
        outer, inner = (3.0 + nu) / stretch, (1.0 - nu) / stretch
        return Constraint(
            convex=self.a * outer + self.b * inner <= 1.0,
            value=lambda a, b: a * outer + b * inner - 1.0,
            gradient=lambda _a, _b: (outer, inner),
            derivative=lambda _a, _b: -1.0 / self._problem.hoop_stress_max,
        )

    def _spread(self, height: float) -> float:
        """a^2 - b^2 of a rim of this height."""
        density = self._problem.material.density
        return 2.0 * self._problem.spin_inertia / (np.pi * density * height * self._scale**4)

    def _widest_bore(self, a: float) -> tuple[float, float]:
        """(sqrt(a) - t)^2 and its slope."""
        bore = np.sqrt(a) - self._room.wall_min / self._scale
        return bore**2, bore / np.sqrt(a)

    def _widest_rim(self, b: float) -> tuple[float, float]:
        """sqrt(Q + b^2) and its slope."""
        widest = np.hypot(b, np.sqrt(self._spread(self._room.height_min)))
        return widest, b / widest
