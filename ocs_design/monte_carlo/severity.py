"""How near a flight came to failing, or how far it went beyond, and what that goes with."""

from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.monte_carlo.outcomes import Outcomes
from ocs_design.monte_carlo.reality import NAMES
from ocs_design.requirement.maneuver import Flip, Maneuver

SIGNIFICANT = 4.0
"""Standard deviations of a rank correlation of independent numbers; 56 are looked at at a time."""

MOST_CAUSES = 4


@dataclass(frozen=True, kw_only=True)
class Cause:
    """A drawn quantity that the outcome goes with.

    Attributes:
        quantity: see `reality.NAMES`.
        correlation: Spearman's, of the quantity with the severity, -1..1.
        either_way: it is the distance of the quantity from its median that counts.
    """

    quantity: str
    correlation: float
    either_way: bool


def attitude_error(outcomes: Outcomes, maneuver: Maneuver, number: int) -> FloatArray:
    """Largest of roll and pitch at touchdown and of what a flip falls short by [rad], (n,)."""
    error = np.maximum(
        np.abs(outcomes.metric("touchdown_roll")), np.abs(outcomes.metric("touchdown_pitch"))
    )[:, number]
    if isinstance(maneuver, Flip):
        turned = outcomes.metric("turned_angle")[:, number]
        error = np.maximum(error, np.abs(turned - maneuver.angle))
    return np.asarray(error)


def order(outcomes: Outcomes, maneuver: Maneuver, number: int) -> np.ndarray:
    """Samples from the best to the worst: passes first, each by its attitude error, (n,)."""
    failed = ~outcomes.passed[:, number]
    error = np.nan_to_num(attitude_error(outcomes, maneuver, number), nan=np.inf)
    return np.lexsort((error, failed))


def causes(outcomes: Outcomes, ranking: np.ndarray) -> tuple[Cause, ...]:
    """The quantities whose rank goes with that of the outcome, most telling first.

    Args:
        outcomes: of n samples.
        ranking: from the best to the worst, see `order`.
    """
    n = len(ranking)
    varied = np.ptp(outcomes.values, axis=0) > 0.0
    if n < 3 or not varied.any():
        return ()
    severity = np.empty(n)
    severity[ranking] = np.arange(n)
    away = np.abs(outcomes.values - np.median(outcomes.values, axis=0))
    found = np.array([_correlations(outcomes.values, severity), _correlations(away, severity)])
    # One that goes up and down with its quantity does so with its distance too.
    found[1] *= np.abs(found[1]) > 2.0 * np.abs(found[0])
    found[:, ~varied] = 0.0
    strongest = np.abs(found).max(axis=0)
    telling = np.argsort(-strongest, kind="stable")[:MOST_CAUSES]
    return tuple(
        _cause(NAMES[index], found[:, index])
        for index in telling.tolist()
        if strongest[index] > SIGNIFICANT / np.sqrt(n - 1.0)
    )


def _cause(name: str, both: FloatArray) -> Cause:
    either = bool(np.argmax(np.abs(both)))
    return Cause(quantity=name, correlation=float(both[int(either)]), either_way=either)


def _correlations(values: FloatArray, severity: FloatArray) -> FloatArray:
    """Spearman's of each column with the severity, a permutation of 0..n-1; shape (columns,)."""
    n = len(severity)
    ranks = np.argsort(np.argsort(values, axis=0, kind="stable"), axis=0)
    middle = 0.5 * (n - 1.0)
    spread = n * (n**2 - 1.0) / 12.0
    return np.asarray((severity - middle) @ (ranks - middle) / spread)
