"""Summary of many samples: causes of failures, spreads, advice."""

import copy
from collections.abc import Callable, Mapping
from dataclasses import replace
from math import cos, sin, sqrt
from types import MappingProxyType

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.device.answers import (
    BINS,
    CONFIDENCE,
    QUANTILES,
    Cause,
    Histogram,
    MonteCarloRecord,
    ScenarioSummary,
)
from ocs_design.monte_carlo.campaign import Campaign
from ocs_design.monte_carlo.outcomes import FAULTS, Outcomes, share, shares
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.simulation.scenario import fly
from ocs_design.simulation.verdict import (
    Fault,
    attitude_errors,
    ends_at_any_attitude,
    landing_attitude,
)
from ocs_design.simulation.world import World
from ocs_design.simulation.world_builder import Options

SIGNIFICANT = 4.0
"""Correlation that counts as significant, in standard deviations of the rank correlation of
independent numbers; about 60 are tested together."""

MOST_CAUSES = 4


def attitude_error(outcomes: Outcomes, maneuver: Maneuver, number: int) -> FloatArray:
    """Largest error of attitude at touchdown and of a flip's total turn [rad], shape (n,).

    NaN for a maneuver that may end at any attitude.
    """
    roll, pitch = (outcomes.metric(f"touchdown_{axis}")[:, number] for axis in ("roll", "pitch"))
    if ends_at_any_attitude(maneuver):
        return np.full(len(roll), np.nan)
    error = attitude_errors(roll, pitch, maneuver)
    if maneuver.counts_turns:
        turned = outcomes.metric("turned_angle")[:, number]
        error = np.maximum(error, np.abs(turned - maneuver.boundary().angle))
    _, _, heading = landing_attitude(maneuver)
    if heading is not None:
        heading_error = outcomes.metric("heading_drift")[:, number] - heading
        error = np.maximum(error, np.abs((heading_error + np.pi) % (2.0 * np.pi) - np.pi))
    return np.asarray(error)


def severity_ranking(outcomes: Outcomes, maneuver: Maneuver, number: int) -> np.ndarray:
    """Samples from best to worst: passes before failures, each by attitude error, shape (n,)."""
    failed = ~outcomes.passed[:, number]
    error = np.nan_to_num(attitude_error(outcomes, maneuver, number), nan=np.inf)
    return np.lexsort((error, failed))


def causes(outcomes: Outcomes, ranking: np.ndarray) -> tuple[Cause, ...]:
    """Quantities whose rank correlates with that of the outcome, strongest first.

    `ranking`: from best to worst, see `severity_ranking`.
    """
    n = len(ranking)
    varied = np.ptp(outcomes.values, axis=0) > 0.0
    if n < 3 or not varied.any():
        return ()
    severity = np.empty(n)
    severity[ranking] = np.arange(n)
    distance = np.abs(outcomes.values - np.median(outcomes.values, axis=0))
    correlations = np.array(
        [_correlations(outcomes.values, severity), _correlations(distance, severity)]
    )
    # An outcome that is monotonic in a quantity also correlates with its distance from the median.
    correlations[1] *= np.abs(correlations[1]) > 2.0 * np.abs(correlations[0])
    correlations[:, ~varied] = 0.0
    strongest = np.abs(correlations).max(axis=0)
    strongest_first = np.argsort(-strongest, kind="stable")[:MOST_CAUSES]
    either = np.argmax(np.abs(correlations), axis=0)
    return tuple(
        Cause(
            quantity=outcomes.names[index],
            correlation=float(correlations[either[index], index]),
            either_way=bool(either[index]),
        )
        for index in strongest_first.tolist()
        if strongest[index] > SIGNIFICANT / np.sqrt(n - 1.0)
    )


def _correlations(values: FloatArray, severity: FloatArray) -> FloatArray:
    """Spearman's correlation of each column with a severity that permutes 0..n-1, (columns,)."""
    n = len(severity)
    ranks = np.argsort(np.argsort(values, axis=0, kind="stable"), axis=0)
    middle = 0.5 * (n - 1.0)
    spread = n * (n**2 - 1.0) / 12.0
    return np.asarray((severity - middle) @ (ranks - middle) / spread)


_NO_AUTHORITY = 1e-3
"""Share of its momentum below which a device as good as does not reach an axis."""


def advice(outcomes: Outcomes, maneuver: Maneuver, number: int) -> str:
    """How to land level about an axis that modules turned by hand do not control.

    The rate about such an axis at lift-off stays until landing. One sentence; empty if no sample
    fails for this reason.
    """
    if maneuver.incidence is None:
        return ""
    reach = {"roll": sin(maneuver.incidence), "pitch": cos(maneuver.incidence)}
    axis = min(reach, key=lambda name: abs(reach[name]))
    if abs(reach[axis]) >= _NO_AUTHORITY:
        return ""
    landed_off = outcomes.codes[:, number] == 1 + FAULTS.index(Fault.LANDING)
    error = np.abs(outcomes.metric(f"touchdown_{axis}")[:, number])
    count = np.count_nonzero(landed_off & (error > LANDING_TOLERANCE))
    if not count:
        return ""
    return (
        f"{count} land off level in {axis}, which modules turned to this incidence cannot correct; "
        f"without `incidence` in its [[maneuver]] they keep the design's angle, which can"
    )


MOST_REFLOWN = 8
"""Most level landings with a fall, per scenario, that are flown again."""


def standing_advice(campaign: Campaign, outcomes: Outcomes, number: int) -> str:
    """Changes that keep up robots that land level and then fall, found by flying them again.

    One sentence; empty if none falls.
    """
    falls = outcomes.codes[:, number] == 1 + FAULTS.index(Fault.STANDING)
    if not falls.any():
        return ""
    fell = outcomes.index[falls]
    worlds = [
        campaign.sampled_world(campaign.sample(index), number)
        for index in fell[:MOST_REFLOWN].tolist()
    ]
    standing_count = {}
    for remedy, change in REMEDIES.items():
        flights = fly([change(world) for world in worlds], Options(hold=campaign.hold))
        passed = [campaign.judged(flight.metrics, number).passed for flight in flights]
        standing_count[remedy] = passed.count(True)
    best = sorted(standing_count, key=lambda remedy: -standing_count[remedy])
    text = ", ".join(f"{standing_count[remedy]} with {remedy}" for remedy in best)
    roll, pitch = (
        np.abs(outcomes.metric(f"final_{axis}")[falls, number]) for axis in ("roll", "pitch")
    )
    sideways = 2 * np.count_nonzero(roll > pitch) > len(fell)
    way, stance = ("sideways", "wider") if sideways else ("lengthwise", "longer")
    which = "these" if len(worlds) == len(fell) else f"{len(worlds)} of these"
    return (
        f"{len(fell)} land level and then fall {way}, where a {stance} stance would help; when "
        f"{which} are flown again, {text} stand"
    )


def _with_stiff_legs(world: World) -> World:
    """The flight with leg drives twice as stiff, at the same damping ratio."""
    model = copy.copy(world.model)
    drives = np.setdiff1d(np.arange(model.nu), world.addresses.motors)
    model.actuator_gainprm[drives, 0] *= 2.0
    model.actuator_biasprm[drives, 1] *= 2.0
    model.actuator_biasprm[drives, 2] *= sqrt(2.0)
    return replace(world, model=model, support=world.support / 2.0)


REMEDIES: Mapping[str, Callable[[World], World]] = MappingProxyType(
    {
        "legs twice as stiff": _with_stiff_legs,
        "wheels that damp twice as hard": lambda world: replace(
            world, law=replace(world.law, standing_damping=2.0 * world.law.damping)
        ),
        "wheels that also hold the attitude": lambda world: replace(
            world, law=replace(world.law, standing_stiffness=world.law.stiffness)
        ),
    }
)
"""Changes that may keep a robot on its feet."""


WORST = 3
"""Number of worst cases kept per scenario."""


def summarise(campaign: Campaign, outcomes: Outcomes, requested: int) -> MonteCarloRecord:
    """Record that summarises these outcomes."""
    flown, all_passed = len(outcomes.index), outcomes.all_passed
    scenarios = []
    for number, (flight, success) in enumerate(
        zip(campaign.flights, shares(outcomes), strict=True)
    ):
        maneuver, codes = flight.maneuver, outcomes.codes[:, number]
        ranking = severity_ranking(outcomes, maneuver, number)
        scenarios.append(
            ScenarioSummary(
                scenario=maneuver.name,
                success=success,
                faults={
                    str(fault): int(count)
                    for code, fault in enumerate(FAULTS, 1)
                    if (count := np.count_nonzero(codes == code))
                },
                attitude_error=_spread(attitude_error(outcomes, maneuver, number)),
                peak_wheel_speed=_spread(outcomes.metric("peak_wheel_speed")[:, number]),
                peak_wheel_torque=_spread(outcomes.metric("peak_wheel_torque")[:, number]),
                causes=causes(outcomes, ranking),
                worst=tuple(outcomes.index[ranking[::-1][:WORST]].tolist()),
                advice=advice(outcomes, maneuver, number)
                or standing_advice(campaign, outcomes, number),
                level=None
                if maneuver.on_feet
                else int(np.isin(codes, [0, 1 + FAULTS.index(Fault.STANDING)]).sum()),
                stands=None
                if flight.can_stand is None
                else int((outcomes.metric("upright_at_end")[:, number] == 1.0).sum()),
            )
        )
    return MonteCarloRecord(
        seed=campaign.seed,
        samples=flown,
        asked=requested,
        confidence=CONFIDENCE,
        reality=campaign.uncertainty.written(),
        success=share(int(all_passed.sum()), flown),
        scenarios=tuple(scenarios),
    )


def _spread(values: FloatArray) -> Histogram | None:
    """Spread of a figure over the flights; None if no flight has it."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return None
    counts, _ = np.histogram(finite, bins=BINS)
    return Histogram(
        quantiles=tuple(np.quantile(finite, QUANTILES).tolist()), counts=tuple(counts.tolist())
    )
