"""Facts about Monte Carlo flights: how often they pass, and how their results spread."""

from collections.abc import Iterator

import numpy as np

from ocs_design.common.units import ceiled, floored
from ocs_design.device.answers import MonteCarloRecord, Share
from ocs_design.device.records.flights import Conclusion, ReliabilityRecord
from ocs_design.report.table import CellTable, columns

BARS = " ▁▂▃▄▅▆▇█"
"""Bars of 0 to 8 eighths of a character's height."""

_SPREAD = (
    ("off level deg", 180.0 / np.pi, ".2f"),
    ("wheel rpm", 30.0 / np.pi, ",.0f"),
    ("torque N m", 1.0, ".3f"),
)
"""Name with unit, factor from SI, and format of each spread quantity."""


def campaign_title(record: MonteCarloRecord) -> str:
    """Number of robots flown, and the seed that they were drawn from."""
    count, enough = f"{record.samples:,}", ""
    if record.samples != record.asked:
        what = "interval asked for" if record.certificate is None else "certificate"
        count += f" of {record.asked:,}"
        enough = f"; that was enough for the {what}"
    return f"{count} sampled robots, seed {record.seed}{enough}"


def success_table(record: MonteCarloRecord) -> CellTable:
    """Number of flights that pass, the pass rate with its interval, and the kinds of failure."""
    rows = [
        (
            each.scenario,
            *_share(each.success),
            ", ".join(f"{count} {fault}" for fault, count in each.faults.items()) or "-",
        )
        for each in record.scenarios
    ]
    if len(rows) > 1:
        rows.append(("all maneuvers", *_share(record.success), "-"))
    return CellTable(
        columns(
            "<scenario", "passed", "pass rate", f"{record.confidence:.0%} interval", "<failures"
        ),
        tuple(rows),
    )


def certificate_line(found: ReliabilityRecord) -> str:
    """Verdict on the requested reliability, short enough for the first line."""
    words = {
        Conclusion.CERTIFIED: "certified for",
        Conclusion.SHORT: "falls short of",
        Conclusion.UNDECIDED: "undecided about",
    }
    passed = f"{found.whole:,} of {found.samples:,} pass"
    return f"{words[found.verdict]} {100.0 * found.asked:.4g} %: {passed}"


def certificate_notes(found: ReliabilityRecord) -> Iterator[str]:
    """Findings of each round, confidence of the verdict, and the samples that it rests on."""
    yield from found.rounds
    asked, worse = (f"{100.0 * value:.3g} %" for value in (found.asked, found.worse))
    if found.verdict == Conclusion.UNDECIDED:
        yield (
            f"{found.samples:,} robots do not decide it: --certify without --samples flies as many "
            "as the test takes"
        )
    yield (
        "Sampled robots flew all maneuvers, one robot after another, for a sequential test: "
        f"a design of {worse} or worse would be certified in at most 5 of 100 cases, and one of "
        f"{asked} or better would be found to fall short in at most 5 (Wald 1945)"
    )
    low, high = found.whole_interval
    yield (
        f"From these {found.samples:,} alone, between {floored(100.0 * low, 1)} and "
        f"{ceiled(100.0 * high, 1)} % of robots pass (95 % interval)"
    )
    last = found.first + found.samples - 1
    yield (
        f"Samples {found.first} to {last} of seed {found.seed}; none of them was used to size "
        f"the device"
    )


def _share(share: Share) -> tuple[str, str, str]:
    # Rounded to the conservative side: 100 % means every flight.
    return (
        f"{share.passed:,}",
        f"{floored(100.0 * share.estimate, 1)} %",
        f"{floored(100.0 * share.low, 1)} .. {ceiled(100.0 * share.high, 1)} %",
    )


def spread_table(record: MonteCarloRecord) -> CellTable:
    """Quantiles and histogram of attitude, wheel speed and torque in flight."""
    rows = []
    for each in record.scenarios:
        spreads = (each.attitude_error, each.peak_wheel_speed, each.peak_wheel_torque)
        name = each.scenario
        for spread, (quantity, factor, form) in zip(spreads, _SPREAD, strict=True):
            if spread is not None:
                values = (format(factor * value, form) for value in spread.quantiles[1:])
                # Bins as bars, one character each; every bin that is not empty is visible.
                parts = (count / max(spread.counts) for count in spread.counts)
                bars = "".join(BARS[int(np.ceil(part * (len(BARS) - 1)))] for part in parts)
                rows.append((name, quantity, *values, bars))
                name = ""
    heads = columns("<scenario", "<in flight", "5 %", "median", "95 %", "max", "min to max")
    return CellTable(heads, tuple(rows))


def campaign_remarks(record: MonteCarloRecord) -> Iterator[str]:
    """Correlates of bad outcomes, advice, and the worst samples."""
    for scenario in record.scenarios:
        found = ", ".join(
            f"{cause.quantity.replace('_', ' ').replace('.', ' ')} "
            f"({'either sign ' if cause.either_way else ''}{cause.correlation:+.2f})"
            for cause in scenario.causes
        )
        if found:
            yield f"{scenario.scenario}: the angle off level correlates with {found}"
        known = {"level": scenario.level, "stands": scenario.stands}
        counts = {word: count for word, count in known.items() if count is not None}
        if min(counts.values(), default=record.samples) < record.samples:
            counted = (f"{word} {count:,} of {record.samples:,}" for word, count in counts.items())
            yield f"{scenario.scenario}: {', '.join(counted)}"
        if scenario.advice:
            yield f"{scenario.scenario}: {scenario.advice}"
        worst = ", ".join(map(str, scenario.worst))
        if worst:
            yield f"{scenario.scenario}: the worst samples are {worst}"
