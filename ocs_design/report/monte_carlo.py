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
        decision = "interval asked for" if record.certificate is None else "certificate"
        count += f" of {record.asked:,}"
        enough = f"; that was enough for the {decision}"
    return f"{count} sampled robots, seed {record.seed}{enough}"


def success_table(record: MonteCarloRecord) -> CellTable:
    """Number of flights that pass, the pass rate with its interval, and the kinds of failure."""
    rows = [
        (
            scenario.scenario,
            *_share(scenario.success),
            ", ".join(f"{count} {fault}" for fault, count in scenario.faults.items()) or "-",
        )
        for scenario in record.scenarios
    ]
    if len(rows) > 1:
        rows.append(("all maneuvers", *_share(record.success), "-"))
    return CellTable(
        columns(
            "<scenario", "passed", "pass rate", f"{record.confidence:.0%} interval", "<failures"
        ),
        tuple(rows),
    )


def certificate_line(certificate: ReliabilityRecord) -> str:
    """Verdict on the requested reliability, short enough for the first line."""
    words = {
        Conclusion.CERTIFIED: "certified for",
        Conclusion.SHORT: "falls short of",
        Conclusion.UNDECIDED: "undecided about",
    }
    passed = f"{certificate.whole:,} of {certificate.samples:,} pass"
    return f"{words[certificate.verdict]} {100.0 * certificate.asked:.4g} %: {passed}"


def certificate_notes(certificate: ReliabilityRecord) -> Iterator[str]:
    """Findings of each round, confidence of the verdict, and the samples that it rests on."""
    yield from certificate.rounds
    required, worse = (f"{100.0 * value:.3g} %" for value in (certificate.asked, certificate.worse))
    if certificate.verdict == Conclusion.UNDECIDED:
        yield (
            f"{certificate.samples:,} robots do not decide it: --certify without --samples flies "
            "as many as the test takes"
        )
    yield (
        "Sampled robots flew all maneuvers, one robot after another, for a sequential test: "
        f"a design of {worse} or worse would be certified in at most 5 of 100 cases, and one of "
        f"{required} or better would be found to fall short in at most 5 (Wald 1945)"
    )
    low, high = certificate.whole_interval
    yield (
        f"From these {certificate.samples:,} alone, between {floored(100.0 * low, 1)} and "
        f"{ceiled(100.0 * high, 1)} % of robots pass (95 % interval)"
    )
    last = certificate.first + certificate.samples - 1
    yield (
        f"Samples {certificate.first} to {last} of seed {certificate.seed}; none of them was used "
        f"to size the device"
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
    for scenario in record.scenarios:
        spreads = (scenario.attitude_error, scenario.peak_wheel_speed, scenario.peak_wheel_torque)
        name = scenario.scenario
        for spread, (quantity, factor, form) in zip(spreads, _SPREAD, strict=True):
            if spread is not None:
                values = (format(factor * value, form) for value in spread.quantiles[1:])
                # Bins as bars, one character each; every bin that is not empty is visible.
                fractions = (count / max(spread.counts) for count in spread.counts)
                bars = "".join(
                    BARS[int(np.ceil(fraction * (len(BARS) - 1)))] for fraction in fractions
                )
                rows.append((name, quantity, *values, bars))
                name = ""
    heads = columns("<scenario", "<in flight", "5 %", "median", "95 %", "max", "min to max")
    return CellTable(heads, tuple(rows))


def campaign_remarks(record: MonteCarloRecord) -> Iterator[str]:
    """Correlates of bad outcomes, advice, and the worst samples."""
    for scenario in record.scenarios:
        causes = ", ".join(
            f"{cause.quantity.replace('_', ' ').replace('.', ' ')} "
            f"({'either sign ' if cause.either_way else ''}{cause.correlation:+.2f})"
            for cause in scenario.causes
        )
        if causes:
            yield f"{scenario.scenario}: the angle off level correlates with {causes}"
        numbers = {"level": scenario.level, "stands": scenario.stands}
        counts = {word: count for word, count in numbers.items() if count is not None}
        if min(counts.values(), default=record.samples) < record.samples:
            counted = (f"{word} {count:,} of {record.samples:,}" for word, count in counts.items())
            yield f"{scenario.scenario}: {', '.join(counted)}"
        if scenario.advice:
            yield f"{scenario.scenario}: {scenario.advice}"
        worst = ", ".join(map(str, scenario.worst))
        if worst:
            yield f"{scenario.scenario}: worst samples {worst}"
