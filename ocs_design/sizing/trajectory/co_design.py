"""Co-design: the lightest wheels and incidence of the selected parts, with all maneuvers in 3-D.

Motor, gear and material are fixed. A wheel is free in its spin inertia and its outer radius; bore
and height are those of the lightest module with both. A smaller module may weigh more and still be
easier to carry. The incidence is free too.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import casadi as ca
import numpy as np

from ocs_design.actuation.drive import RESERVE, DriveLine
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.arrays import FloatArray
from ocs_design.device.layout import module_axes
from ocs_design.sizing.lightest_module import binding_limits, lightest_module_at
from ocs_design.sizing.selection.demand import ROLL_CANCELLED, rate_demands
from ocs_design.sizing.selection.problem import Candidate, SelectionProblem
from ocs_design.sizing.trajectory.flight import Flight, fly
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.program import Dimensions, solve
from ocs_design.sizing.trajectory.transcription import Phase, Plant

LEAST_GAIN = 1e-4
"""Fraction of the mass below which a gain is within the program's error, and the selection
stands."""

PASSES = (16, 48)
"""Number of intervals of each maneuver, in successive passes."""

_WHEELS, _RADII = np.linspace(0.85, 1.15, 21), np.linspace(0.85, 1.15, 21)
"""Spin inertias and outer radii that are tabulated, relative to the selected ones."""

_SPLINE_POINTS_MIN = 4
"""Least number of points of a cubic spline."""

_ANGLE_MARGIN = np.radians(1.0)
"""Distance of a free incidence to 0 and to a right angle, where an axis is out of reach [rad]."""


@dataclass(frozen=True, eq=False)
class CoDesign:
    """Outcome of the co-design.

    Attributes:
        adopted: whether `device` is the co-design's; otherwise the selected device is kept.
        remark: one sentence on that.
        device: the device to build.
        mass: mass of the program's result, adopted or not [kg].
        selected_mass: of the selection [kg].
        status: IPOPT's return status. iterations: number of iterations.
        flights: of all maneuvers, on the finer grid.
    """

    adopted: bool
    remark: str
    device: Candidate
    mass: float
    selected_mass: float
    status: str
    iterations: int
    flights: tuple[Flight, ...]

    @property
    def gain(self) -> float:
        """Mass saved, relative to the selection's; negative where the result is heavier."""
        return 1.0 - self.mass / self.selected_mass

    @property
    def violation(self) -> float:
        """Largest relative violation of a drive's limit on the fine grid."""
        return max((flight.violation for flight in self.flights), default=0.0)


def co_design(problem: SelectionProblem, selected: Candidate) -> CoDesign:
    """The lightest device of the selected motor, gear and material that flies its maneuvers.

    It is never heavier than the selection: where IPOPT fails, finds nothing lighter, or the fine
    grid does not confirm its result, the selected device is kept and the remark says why.
    """
    mass = float(selected.mass)
    rejected = CoDesign(
        adopted=False,
        remark="the selected device is kept: the spin inertia is specified",
        device=selected,
        mass=mass,
        selected_mass=mass,
        status="not tried",
        iterations=0,
        flights=(),
    )
    if problem.requirement.spin_inertia is not None:
        return rejected
    if any(maneuver.on_pivot for maneuver in problem.requirement.maneuvers):
        return replace(
            rejected, remark="the selected device is kept: no co-design of a robot on a pivot"
        )
    device = FreeDevice.of(problem, selected)
    if device is None:
        remark = "the selected device is kept: the limits leave the wheels no choice"
        return replace(rejected, remark=remark)
    turns = list(device.turns())
    solution = solve(turns, _usable_line(problem, selected), PASSES, device.dimensions())
    result = device.at(*solution.dimensions.tolist())
    maneuvers, flights = problem.requirement.maneuvers, list[Flight]()
    for maneuver, turn, motion in zip(maneuvers, turns, solution.motions, strict=True):
        incidence = result.incidence if maneuver.incidence is None else maneuver.incidence
        flown = replace(turn, gyrostat=_gyrostat(problem, result, incidence))
        flights.append(fly(flown, _usable_line(problem, result), motion))
    failures = (
        f"in {turn.boundary.name!r}, {flight.failure}"
        for turn, flight in zip(turns, flights, strict=True)
        if flight.failure
    )
    mass_ratio, failure = result.mass / mass, next(failures, "")
    if not solution.solved:
        failure = f"IPOPT ended with {solution.status}"
    elif not failure and mass_ratio > 1.0 - LEAST_GAIN:
        difference = f"{100.0 * (mass_ratio - 1.0):+.2f} % of mass"
        failure = f"the co-design in 3-D found nothing lighter ({difference})"
    outcome = replace(
        rejected,
        remark=f"the selected device is kept: {failure}",
        mass=result.mass,
        status=solution.status,
        iterations=solution.iterations,
        flights=tuple(flights),
    )
    if failure:
        return outcome
    # Each maneuver needs what it takes in 3-D, and all the time given. Its smallest spin inertia is
    # that of the closed form, or the device's own where a smaller one suffices.
    demands = [
        replace(
            demand,
            incidence=result.incidence if maneuver.incidence is None else demand.incidence,
            spin_inertia=min(demand.spin_inertia, result.spin_inertia),
            time_needed=demand.time_given,
            peak_speed=float(np.abs(flight.trajectory.wheel_speed).max()),
            peak_torque=float(np.abs(flight.trajectory.wheel_torque).max()),
        )
        for maneuver, demand, flight in zip(maneuvers, result.demands, flights, strict=False)
    ]
    demands += rate_demands(problem.requirement, result, TiltInertia.of(result.total.inertia))
    return replace(
        outcome,
        adopted=True,
        remark=f"co-design in 3-D saves {outcome.gain:.2%} of the selection's mass",
        device=replace(
            result,
            demands=tuple(demands),
            residual=solution.violation,
            iterations=solution.iterations,
        ),
    )


@dataclass(frozen=True, eq=False)
class FreeDevice:
    """A selected device whose wheels and incidence are free.

    Its dimensions are spin inertia and outer radius relative to the selected ones, and incidence
    [rad].

    Attributes:
        problem: for which it was selected. selected: the selection's outcome.
        lower, upper: bounds of the first two dimensions, shape (2,).
        figures: function of those two: mass relative to the selected one, and coefficients of 1, s,
            c, s^2 and s c in the inertia of robot and device [kg m^2], (46, 1); with sine s and
            cosine c of the incidence, bodies that turn about the vertical have no other terms.
    """

    problem: SelectionProblem
    selected: Candidate
    lower: FloatArray
    upper: FloatArray
    figures: ca.Function

    @classmethod
    def of(cls, problem: SelectionProblem, selected: Candidate) -> "FreeDevice | None":
        """The device with splines through wheels around the selected one; None: too few."""
        angles = np.linspace(0.0, np.pi / 2.0, 5)
        sine, cosine = np.sin(angles), np.cos(angles)
        terms = np.column_stack([np.ones(5), sine, cosine, sine**2, sine * cosine])
        room = float(selected.limits.outer_radius_max) / selected.outer_radius
        # Relative spin inertias for which a module fits the envelope.
        modules = with_wheels(problem, selected, _WHEELS, np.ones_like(_WHEELS))
        factors = np.array([module.spin_inertia for module in modules]) / selected.spin_inertia
        radii = np.linspace(_RADII[0], max(min(_RADII[-1], room), 1.0), _RADII.size)
        if factors.size < _SPLINE_POINTS_MIN:
            return None
        # In the order of a tensor, the first dimension fastest.
        spin, outer = (grid.ravel() for grid in np.meshgrid(factors, radii))
        values = [
            np.append(
                device.mass / selected.mass,
                np.linalg.solve(
                    terms,
                    [device.total_at(problem.robot, angle).inertia.ravel() for angle in angles],
                ),
            )
            for device in with_wheels(problem, selected, spin, outer)
        ]
        figures = ca.interpolant("figures", "bspline", [factors, radii], np.ravel(values))
        lower, upper = (np.array([factors[i], radii[i]]) for i in (0, -1))
        return cls(problem, selected, lower, upper, figures)

    def at(self, factor: float, radius: float, incidence: float) -> Candidate:
        """The device with these dimensions."""
        device = next(
            with_wheels(self.problem, self.selected, np.array([factor]), np.array([radius]))
        )
        problem = replace(self.selected.problem, robot=self.problem.robot)
        return replace(device, incidence=incidence, problem=problem)

    def plant(self, dimensions: ca.MX, own_incidence: float | None = None) -> Plant:
        """Symbolic robot and device, at their incidence or `own_incidence` [rad]."""
        incidence = dimensions[2] if own_incidence is None else ca.MX(own_incidence)
        sine, cosine = ca.sin(incidence), ca.cos(incidence)
        terms = ca.vertcat(1.0, sine, cosine, sine**2, sine * cosine)
        inertia = ca.reshape(self.figures(dimensions[:2])[1:], 9, 5) @ terms
        return Plant(
            inertia=ca.reshape(inertia, 3, 3),
            axes=ca.vertcat(ca.horzcat(sine, -sine), ca.horzcat(cosine, cosine), ca.MX(1, 2)),
            spin_inertia=dimensions[0] * self.selected.spin_inertia,
            armature=ca.MX(self.selected.drive.armature),
        )

    def turns(self) -> Iterator[Phase]:
        """Every maneuver, at its own incidence if it has one, else at that of the device."""
        start = self.at(*self.dimensions().start.tolist())
        requirement = self.problem.requirement
        for maneuver in requirement.maneuvers:
            incidence = maneuver.incidence
            boundary = maneuver.boundary()
            gyrostat = _gyrostat(
                self.problem, start, start.incidence if incidence is None else incidence
            )
            yield Phase(boundary, gyrostat, partial(self.plant, own_incidence=incidence))

    def dimensions(self) -> Dimensions:
        """Bounds of all three dimensions, and the mass to be minimised."""
        incidence, requirement = self.selected.incidence, self.problem.requirement
        nearest, farthest = _ANGLE_MARGIN, np.pi / 2.0 - _ANGLE_MARGIN
        # A device for one axis stays one: otherwise the other axis would have to be stopped too.
        if self.problem.incidence is not None or not nearest < incidence < farthest:
            nearest = farthest = incidence
        # A flip at an incidence of its own does not constrain the design's.
        rolls = (
            requirement.reserves[maneuver.name].roll
            for maneuver in requirement.maneuvers
            if maneuver.incidence is None and maneuver.name in requirement.reserves
        )
        rate_change, roll = requirement.rate_change or 0.0, max(rolls, default=0.0)
        top_speed = float(self.selected.line.reserved().top_speed)
        robot_inertia = self.problem.robot.inertia
        # One wheel is the busier one; which of the two does not depend on the dimensions.
        sense = np.sign(TiltInertia.of(self.selected.total.inertia).product)

        def excess(dimensions: ca.MX) -> ca.MX:
            """Missing momentum of the wheels, relative to the robot's.

            Parts: the change of rate, and cancelling a roll at lift-off
            (`roll_cancelling_momentum`).
            """
            plant, parts = self.plant(dimensions), []
            inertia, shares = plant.inertia, plant.axes[:2, 0]
            absorbed = 2.0 * top_speed * plant.spin_inertia * shares
            if rate_change:
                product = inertia[0, 1] - inertia[0, 2] * inertia[1, 2] / inertia[2, 2]
                coupling = sense * product * shares / ca.vertcat(shares[1], shares[0])
                required = (ca.vertcat(inertia[0, 0], inertia[1, 1]) + coupling) * rate_change
                parts.append(
                    (required - absorbed) / ca.DM(np.diag(robot_inertia)[:2] * rate_change)
                )
            if roll:
                required = (
                    inertia[0, 0] * (1.0 + inertia[0, 0] / inertia[2, 2]) * roll / ROLL_CANCELLED
                )
                parts.append((required - absorbed[0]) / float(robot_inertia[0, 0] * roll))
            return ca.vertcat(*parts)

        return Dimensions(
            start=np.append(np.clip(1.0, self.lower, self.upper), incidence),
            lower=np.append(self.lower, nearest),
            upper=np.append(self.upper, farthest),
            objective=lambda dimensions: self.figures(dimensions[:2])[0],
            excess=excess if rate_change or roll else None,
        )


def with_wheels(
    problem: SelectionProblem, selected: Candidate, factors: FloatArray, radii: FloatArray
) -> Iterator[Candidate]:
    """The selected device with other wheels, where a module of that spin inertia is feasible.

    Spin inertias and outer radii are relative to the selected ones, shape (n,); the nearest
    feasible radius is used.
    """
    limits, turning = selected.limits, selected.drive.rotor_inertia + selected.hub_share
    spin_inertias, outer_radii = factors * selected.spin_inertia, radii * selected.outer_radius
    shapes = lightest_module_at(spin_inertias - turning, outer_radii, limits, selected.shell)
    for row in np.flatnonzero(np.isfinite(shapes.mass)).tolist():
        shape = shapes.take(row)
        yield replace(
            selected,
            inner_radius=float(shape.inner_radius),
            outer_radius=float(shape.outer_radius),
            height=float(shape.height),
            spin_inertia=float(spin_inertias[row]),
            binding=binding_limits(shape, limits, problem.envelope),
        )


def _gyrostat(problem: SelectionProblem, device: Candidate, incidence: float) -> Gyrostat:
    inertia = device.total_at(problem.robot, incidence).inertia
    return Gyrostat(inertia, module_axes(incidence), device.spin_inertia, device.drive.armature)


def _usable_line(problem: SelectionProblem, device: Candidate) -> DriveLine:
    """Voltage line that the drives may use, reduced by the reserve's factor.

    The largest reserve of all maneuvers applies to each.
    """
    factors = (reserve.demand for reserve in problem.requirement.reserves.values())
    return device.line.reserved(RESERVE / max(factors, default=1.0))
