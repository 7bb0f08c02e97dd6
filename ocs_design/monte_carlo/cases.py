"""One sample kept by itself: to be flown again, with the same numbers, whatever is drawn later."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from ocs_design.exceptions import OcsError
from ocs_design.monte_carlo.campaign import Campaign
from ocs_design.monte_carlo.outcomes import METRICS, Outcomes
from ocs_design.monte_carlo.reality import NAMES
from ocs_design.monte_carlo.sample import Sample
from ocs_design.simulation.metrics import Metrics
from ocs_design.text_files import TextKind, safe_name

SCHEMA_VERSION = 1

_KIND = TextKind("case", 1 << 20, 1 << 20, "give a file from the folder worst/", '"..."')


@dataclass(frozen=True, kw_only=True)
class Case:
    """A sample with what came of it.

    Attributes:
        design: SHA-256 of what was designed.
        seed, sample: which its noise follows from.
        scenario: for which it was kept. verdict: on it, in one sentence.
        values: that were drawn, by name (SI).
        metrics: of each scenario by its name; what there is none of is null.
    """

    schema_version: int
    design: str
    seed: int
    sample: int
    scenario: str
    verdict: str
    values: Mapping[str, float]
    metrics: Mapping[str, Mapping[str, float | None]]

    def drawn(self) -> Sample:
        """The sample itself."""
        return Sample(self.seed, self.sample, np.array([self.values[name] for name in NAMES]))


def case_of(campaign: Campaign, outcomes: Outcomes, row: int, scenario: int, design: str) -> Case:
    """The sample in one row of the outcomes, kept for one scenario."""
    names = [flight.maneuver.name for flight in campaign.flights]
    return Case(
        schema_version=SCHEMA_VERSION,
        design=design,
        seed=campaign.seed,
        sample=int(outcomes.index[row]),
        scenario=names[scenario],
        verdict=campaign.judged(metrics_of(outcomes, row, scenario), scenario).reason,
        values=dict(zip(NAMES, outcomes.values[row].tolist(), strict=True)),
        metrics={
            name: dict(zip(METRICS, outcomes.metrics[row, number].tolist(), strict=True))
            for number, name in enumerate(names)
        },
    )


def metrics_of(outcomes: Outcomes, row: int, scenario: int) -> Metrics | None:
    """The figures of one flight; None if it became unstable."""
    values = dict(zip(METRICS, outcomes.metrics[row, scenario].tolist(), strict=True))
    if np.isnan(values["final_roll"]):
        return None
    upright = bool(values.pop("upright_at_end"))
    landed, left = (_known(values.pop(name)) for name in ("touchdown_time", "lift_off_time"))
    return Metrics(upright_at_end=upright, touchdown_time=landed, lift_off_time=left, **values)


def _known(time: float) -> float | None:
    return None if np.isnan(time) else time


def write_case(case: Case, folder: Path) -> Path:
    """As JSON, named after scenario and sample."""
    path = folder / f"{safe_name(case.scenario)}-{case.sample}.json"
    path.write_bytes(msgspec.json.format(msgspec.json.encode(case), indent=2) + b"\n")
    return path


def read_case(path: Path) -> Case:
    """What `write_case` wrote.

    Raises:
        OcsError: it cannot be read, or lacks a quantity that is drawn.
    """
    try:
        case = msgspec.json.decode(_KIND.read(path), type=Case)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OcsError(f"{path}: not a case: {error}", hint=_KIND.path_hint) from error
    missing = [name for name in NAMES if name not in case.values]
    if missing:
        raise OcsError(
            f"{path}: says nothing of {', '.join(missing)}",
            hint="it is of another version; draw it again with --seed and --sample",
        )
    return case
