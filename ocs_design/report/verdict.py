"""The verdict on a design in one line: buildable, level, stands; and what matters most about it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.flights import ReliabilityRecord, SurvivalRecord, ValidationRecord
from ocs_design.report.flights import falls, survival_sentence, turned_by_hand
from ocs_design.report.monte_carlo import certificate_line
from ocs_design.report.table import Tone, Toned

SEPARATOR = "  \N{MIDDLE DOT}  "
"""Text between the parts of the line."""


@dataclass(frozen=True)
class Headline:
    """The verdict in one line, and what matters most.

    Attributes:
        parts: of the line, each with its tone.
        matter: the one thing that matters most, a sentence; empty: nothing is in the way.
    """

    parts: tuple[Toned, ...]
    matter: str

    @property
    def text(self) -> str:
        """All parts in one line."""
        return SEPARATOR.join(part.text for part in self.parts)

    @property
    def tone(self) -> Tone:
        """The worst of all parts."""
        tones = {part.tone for part in self.parts}
        return next(tone for tone in (Tone.FAIL, Tone.OPEN, Tone.PASS) if tone in tones)


def headline(design: OcsDesign) -> Headline:
    """Verdict on a design and its flights."""
    runs = [run for run in design.validation if run.ocs]
    yes, without_shapes = design.buildable.yes, "buildable: not known, for the robot has no shapes"
    if yes is not None:
        first = Toned("buildable" if yes else "NOT buildable", Tone.PASS if yes else Tone.FAIL)
    elif design.ocs.motor.bus_voltage is None:
        first = Toned("no motor chosen yet", Tone.OPEN)
    else:
        first = Toned("buildable: not known" if design.robot.sha256 else without_shapes, Tone.OPEN)
    flights = (*_flights(runs), *_survives(design.survival), *_certified(design.reliability))
    if design.buildable.yes is False and design.buildable.open:
        point = design.buildable.open[0]
        return Headline((first, *flights), f"{point.what}; {point.cure}")
    by_hand = next(iter(turned_by_hand(design)), "")
    matter = _of_flights(runs) or _lost(design.survival) or by_hand or _sure(design.reliability)
    return Headline((first, *flights), matter)


def flights_headline(
    runs: Sequence[ValidationRecord],
    reliability: ReliabilityRecord | None = None,
    survival: SurvivalRecord | None = None,
) -> Headline:
    """Verdict on flights alone, of which those with the device count, and their certificate."""
    carrying = [run for run in runs if run.ocs]
    parts = (*_flights(carrying), *_survives(survival), *_certified(reliability))
    return Headline(parts, _of_flights(carrying) or _lost(survival) or _sure(reliability))


def _survives(found: SurvivalRecord | None) -> Iterator[Toned]:
    """How many landings with a stopped drive are within the allowance; nothing without such."""
    if found is not None:
        count = len(found.flights)
        yield _share("with a drive stopped", count - len(found.lost), count, Tone.FAIL)


def _lost(found: SurvivalRecord | None) -> str:
    return survival_sentence(found) if found is not None and found.lost else ""


def _sure(found: ReliabilityRecord | None) -> str:
    return "" if found is None else certificate_line(found)


def _certified(found: ReliabilityRecord | None) -> Iterator[Toned]:
    """Certificate; nothing where none was flown."""
    if found is not None:
        tones = {"certified": Tone.PASS, "falls short": Tone.FAIL, "undecided": Tone.OPEN}
        yield Toned(f"{100.0 * found.asked:.4g} % {found.verdict}", tones[found.verdict])


def _flights(runs: Sequence[ValidationRecord]) -> Iterator[Toned]:
    """How many of the flights are level, and how many robots stand after them."""
    if not runs:
        yield Toned("no flight was simulated", Tone.OPEN)
        return
    unjudged = [run.passed for run in runs].count(None)
    touching = [run.level for run in runs if run.level is not None or run.passed is None]
    if touching:
        yield _share("level", touching.count(True), len(touching), Tone.FAIL)
    standing = [run for run in runs if run.stands is not None]
    if standing:
        # A robot whose legs do not bear even a level landing is no fault of the device.
        fault = any(run.stands is False and run.passed is False for run in standing)
        up = [run.stands for run in standing].count(True)
        yield _share("stands", up, len(standing), Tone.FAIL if fault else Tone.OPEN)
    if unjudged:
        yield Toned(f"{unjudged} of {len(runs)} not judged", Tone.FAIL)
    elif any(run.passed is False and run.level and run.stands is not False for run in runs):
        passed = [run.passed for run in runs].count(True)
        yield Toned(f"{passed} of {len(runs)} pass", Tone.FAIL)


def _share(word: str, good: int, of: int, otherwise: Tone) -> Toned:
    return Toned(f"{word} {good} of {of}", Tone.PASS if good == of else otherwise)


def _of_flights(runs: Sequence[ValidationRecord]) -> str:
    """What is wrong with the worst flight; empty if nothing is."""
    for run in sorted(runs, key=lambda run: run.passed is None):
        if run.passed is not True:
            return f"{run.scenario}: {run.reason}"
    return falls(runs)
