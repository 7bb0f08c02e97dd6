"""One-line verdict on a design (buildable, level, stands) and the finding that matters most."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ocs_design.device.answers import Validated
from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.flights import Conclusion, ValidationRecord
from ocs_design.report.device import has_motor
from ocs_design.report.flights import (
    fall_remark,
    hand_turn_remarks,
    lean_remark,
    leaning_tilts,
    survival_sentence,
)
from ocs_design.report.monte_carlo import certificate_line
from ocs_design.report.table import Tone, Toned

SEPARATOR = "  \N{MIDDLE DOT}  "
"""Text between the parts of the line."""


@dataclass(frozen=True)
class Headline:
    """The verdict in one line, and what matters most.

    Attributes:
        parts: parts of the line, each with its tone.
        main_finding: the finding that matters most, as a sentence; empty if there is none.
        flight: scenario that `main_finding` is about; empty if it is about something else.
    """

    parts: tuple[Toned, ...]
    main_finding: str
    flight: str = ""

    @property
    def text(self) -> str:
        """All parts in one line."""
        return SEPARATOR.join(part.text for part in self.parts)

    @property
    def with_finding(self) -> str:
        """The line, with the main finding at its end."""
        return SEPARATOR.join(filter(None, [self.text, self.main_finding]))

    @property
    def tone(self) -> Tone:
        """The worst of all parts."""
        tones = {part.tone for part in self.parts}
        return next(tone for tone in (Tone.FAIL, Tone.OPEN, Tone.PASS) if tone in tones)


def headline(result: OcsDesign | Validated) -> Headline:
    """Verdict on a design and its flights, or on flights alone; those with the device count."""
    runs, survival = [run for run in result.validation if run.ocs], result.survival
    parts, hand_turn, shortage = [], "", ""
    if isinstance(result, OcsDesign):
        certificate = result.reliability
        parts.append(_buildable(result))
        hand_turn = next(iter(hand_turn_remarks(result)), "")
        if result.buildable.yes is False and result.buildable.open:
            shortage = f"{result.buildable.open[0].what}; {result.buildable.open[0].cure}"
    else:
        certificate = None if result.monte_carlo is None else result.monte_carlo.certificate
    parts += _flights(runs)
    if survival is not None:
        count, lost = len(survival.flights), len(survival.lost)
        parts.append(_share("survives a drive failure", count - lost, count, Tone.FAIL))
    if certificate is not None:
        tones = {
            Conclusion.CERTIFIED: Tone.PASS,
            Conclusion.SHORT: Tone.FAIL,
            Conclusion.UNDECIDED: Tone.OPEN,
        }
        verdict = f"{100.0 * certificate.asked:.4g} % {certificate.verdict}"
        parts.append(Toned(verdict, tones[certificate.verdict]))
    # Failures come before flights that were not judged.
    by_severity = sorted(runs, key=lambda run: run.passed is None)
    fault = next((run for run in by_severity if run.passed is not True), None)
    if fault is not None and not shortage:
        return Headline(tuple(parts), f"{fault.scenario}: {fault.reason}", fault.scenario)
    findings = (
        shortage,
        fall_remark(runs),
        lean_remark(runs),
        survival_sentence(survival) if survival is not None and survival.lost else "",
        hand_turn,
        "" if certificate is None else certificate_line(certificate),
    )
    return Headline(tuple(parts), next(filter(None, findings), ""))


def _buildable(design: OcsDesign) -> Toned:
    """Whether it can be built."""
    yes = design.buildable.yes
    if yes is not None:
        return Toned("buildable" if yes else "NOT buildable", Tone.PASS if yes else Tone.FAIL)
    if not has_motor(design):
        return Toned("no motor chosen yet", Tone.OPEN)
    why = "" if design.robot.sha256 else ", because the robot has no geometry"
    return Toned(f"buildable: unknown{why}", Tone.OPEN)


def _flights(runs: Sequence[ValidationRecord]) -> Iterator[Toned]:
    """Number of level flights, and of those after which the robot stands, or leans."""
    if not runs:
        yield Toned("no flight was simulated", Tone.OPEN)
        return
    unjudged = [run.passed for run in runs].count(None)
    judged = [run.level for run in runs if run.level is not None or run.passed is None]
    if judged:
        yield _share("level", judged.count(True), len(judged), Tone.FAIL)
    standing = [run for run in runs if run.stands is not None]
    if standing:
        # The device is not at fault if the legs cannot take even a level landing.
        is_device_fault = any(run.stands is False and run.passed is False for run in standing)
        upright, tilted = [run.stands for run in standing].count(True), len(leaning_tilts(runs))
        part = _share("stands", upright, len(standing), Tone.FAIL if is_device_fault else Tone.OPEN)
        if tilted:
            tone = Tone.OPEN if part.tone is Tone.PASS else part.tone
            part = Toned(f"{part.text}, {tilted} leaning", tone)
        yield part
    if unjudged:
        yield Toned(f"{unjudged} of {len(runs)} not judged", Tone.FAIL)
    elif any(run.passed is False and run.level and run.stands is not False for run in runs):
        passed = [run.passed for run in runs].count(True)
        yield Toned(f"{passed} of {len(runs)} pass", Tone.FAIL)


def _share(word: str, good: int, total: int, tone: Tone) -> Toned:
    return Toned(f"{word} {good} of {total}", Tone.PASS if good == total else tone)
