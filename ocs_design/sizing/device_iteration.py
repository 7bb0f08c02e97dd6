"""The fixed point of a device and the robot that carries it.

A heavier wheel asks for more momentum, and the axes lie where robot and wheels together want them:
spin inertia and incidence are the fixed point of rim -> total inertia -> incidence -> demand. It is
approached from below, from the robot alone. As heavier wheels ask for more, the first spin inertia
that no rim has proves that there is no device.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ocs_design.exceptions import UsageError
from ocs_design.requirement.bound import SpinDemand
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.device_problem import (
    DeviceProblem,
    braked_total,
    chosen_incidence,
    device_demands,
)
from ocs_design.sizing.incidence import incidence_by_criterion
from ocs_design.sizing.rim_closed_form import RimShape, lightest_rim, smallest_spin_inertia

_SETTLED = 1e-12
_ITERATIONS_MAX = 1000
# The smallest rim of all must not get lost to rounding.
_OFF_THE_EDGE = 1.0 + 1e-10


@dataclass(frozen=True, eq=False)
class FixedPoint:
    """A device that meets what robot and device together ask for.

    Attributes:
        spin_inertia: of each wheel [kg m^2]. incidence: [rad].
        demands: on the wheels.
        total: robot and wheels, braked, in B.
        residual: relative change of the spin inertia or change of the incidence [rad] in one more
            iteration, the larger one.
        iterations: taken.
    """

    spin_inertia: float
    incidence: float
    demands: tuple[SpinDemand, ...]
    total: MassProperties
    residual: float
    iterations: int


@dataclass(frozen=True, eq=False)
class DeadEnd:
    """The iteration came to a spin inertia that no rim has.

    Attributes:
        spin_inertia: at least asked of each wheel [kg m^2]; inf if an axis is out of reach.
        demands: on the wheels.
    """

    spin_inertia: float
    demands: tuple[SpinDemand, ...]


class _Guess(NamedTuple):
    spin_inertia: float
    incidence: float
    demands: tuple[SpinDemand, ...]


def find_fixed_point(problem: DeviceProblem) -> FixedPoint | DeadEnd:
    """Iterate from the robot alone until nothing moves.

    Raises:
        UsageError: the requirement asks for nothing.
    """
    guess = _follow(problem, None, incidence_by_criterion(problem.robot.inertia)[problem.criterion])
    for iterations in range(1, _ITERATIONS_MAX + 1):
        shape = lightest_rim(guess.spin_inertia, problem.rim_problem(guess.spin_inertia).limits)
        if not shape.mass > 0.0:
            break
        following = _follow(problem, shape, guess.incidence)
        residual = _change(guess, following)
        if residual < _SETTLED:
            return FixedPoint(
                spin_inertia=guess.spin_inertia,
                incidence=guess.incidence,
                demands=following.demands,
                total=braked_total(problem, shape, guess.incidence),
                residual=residual,
                iterations=iterations,
            )
        guess = following
    return DeadEnd(guess.spin_inertia, guess.demands)


def _follow(problem: DeviceProblem, shape: RimShape | None, incidence: float) -> _Guess:
    """The incidence, the demands and the spin inertia that a rim at an incidence entails."""
    incidence = chosen_incidence(problem, shape, incidence)
    demands = device_demands(problem, shape, incidence)
    asked = problem.requirement.spin_inertia
    return _Guess(_needed(problem, demands) if asked is None else asked, incidence, demands)


def _needed(problem: DeviceProblem, demands: Sequence[SpinDemand]) -> float:
    """The largest demand, or the smallest rim within the limits if that has more [kg m^2]."""
    largest = max((demand.spin_inertia for demand in demands), default=0.0)
    if largest == 0.0:
        raise UsageError(
            "nothing is asked of the wheels",
            hint="Ask for a rate change, for a maneuver, or for a spin inertia.",
        )
    smallest = smallest_spin_inertia(problem.rim_problem(largest).limits)
    return max(largest, float(smallest) * _OFF_THE_EDGE)


def _change(guess: _Guess, following: _Guess) -> float:
    spin = abs(following.spin_inertia / guess.spin_inertia - 1.0)
    return max(spin, abs(following.incidence - guess.incidence))
