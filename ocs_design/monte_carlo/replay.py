"""One sample flown by itself, with its time series."""

from ocs_design.monte_carlo.campaign import Campaign
from ocs_design.monte_carlo.sample import Sample
from ocs_design.simulation.engine import simulate
from ocs_design.simulation.metrics import measure, series_of
from ocs_design.simulation.poses import poses_of
from ocs_design.simulation.scenario import Run


def replayed(
    campaign: Campaign, sample: Sample, *, pose_rate: float | None = None
) -> tuple[Run, ...]:
    """Every scenario of one sample; the numbers are those that it had among others.

    Args:
        campaign: that it belongs to. sample: to fly.
        pose_rate: see `simulate`.
    """
    worlds = campaign.worlds(sample)
    recording = simulate(worlds, hold=campaign.hold, pose_rate=pose_rate)
    runs = []
    for number, (flight, world) in enumerate(zip(campaign.flights, worlds, strict=True)):
        metrics = measure(recording, number, world)
        verdict = campaign.judged(metrics, number)
        runs.append(
            Run(
                scenario=flight.maneuver.name,
                ocs=True,
                passed=verdict.passed,
                reason=verdict.reason,
                metrics=metrics,
                series=series_of(recording, number, world),
                note=world.note,
                can_stand=flight.can_stand,
                poses=poses_of(recording, number, world),
            )
        )
    return tuple(runs)
