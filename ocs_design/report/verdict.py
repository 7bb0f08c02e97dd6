"""One-line verdict on a design (buildable, level, stands) and the finding that matters most."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ocs_design.device.answers import Validated
from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.flights import Conclusion, ValidationRecord
from ocs_design.report.device import has_motor
from ocs_design.report.flights import falls, leaning, leans, survival_sentence, turned_by_hand
from ocs_design.report.monte_carlo import certificate_line
from ocs_design.report.table import Tone, Toned

SEPARATOR = "  \N{MIDDLE DOT}  "
"""Text between the parts of the line."""


@dataclass(frozen=True)
class Headline:
    """The verdict in one line, and what matters most.

    Attributes:
        parts: parts of the line, each with its tone.
        matter: the finding that matters most, as a sentence; empty if there is none.
        flight: scenario that `matter` is about; empty if it is about something else.
    """

    parts: tuple[Toned, ...]
    matter: str
    flight: str = ""

    @property
    def text(self) -> str:
        """All parts in one line."""
        return SEPARATOR.join(part.text for part in self.parts)

    @property
    def whole(self) -> str:
        """The line, with the most important finding at its end."""
        return SEPARATOR.join(filter(None, [self.text, self.matter]))

    @property
    def tone(self) -> Tone:
        """The worst of all parts."""
        tones = {part.tone for part in self.parts}
        return next(tone for tone in (Tone.FAIL, Tone.OPEN, Tone.PASS) if tone in tones)


def headline(found: OcsDesign | Validated) -> Headline:
    """Verdict on a design and its flights, or on flights alone; those with the device count."""
    runs, survival = [run for run in found.validation if run.ocs], found.survival
    parts, by_hand, shortage = [], "", ""
    if isinstance(found, OcsDesign):
        certified = found.reliability
        parts.append(_buildable(found))
        by_hand = next(iter(turned_by_hand(found)), "")
        if found.buildable.yes is False and found.buildable.open:
            shortage = f"{found.buildable.open[0].what}; {found.buildable.open[0].cure}"
    else:
        certified = None if found.monte_carlo is None else found.monte_carlo.certificate
    parts += _flights(runs)
    if survival is not None:
        count = len(survival.flights)
        parts.append(
            _share("survives a drive failure", count - len(survival.lost), count, Tone.FAIL)
        )
    if certified is not None:
        tones = {
            Conclusion.CERTIFIED: Tone.PASS,
            Conclusion.SHORT: Tone.FAIL,
            Conclusion.UNDECIDED: Tone.OPEN,
        }
        verdict = f"{100.0 * certified.asked:.4g} % {certified.verdict}"
        parts.append(Toned(verdict, tones[certified.verdict]))
    # Failures come before flights that were not judged.
    worst = sorted(runs, key=lambda run: run.passed is None)
    fault = next((run for run in worst if run.passed is not True), None)
    if fault is not None and not shortage:
        return Headline(tuple(parts), f"{fault.scenario}: {fault.reason}", fault.scenario)
    matters = (
        shortage,
        falls(runs),
        leans(runs),
        survival_sentence(survival) if survival is not None and survival.lost else "",
        by_hand,
        "" if certified is None else certificate_line(certified),
    )
    return Headline(tuple(parts), next(filter(None, matters), ""))


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
    touching = [run.level for run in runs if run.level is not None or run.passed is None]
    if touching:
        yield _share("level", touching.count(True), len(touching), Tone.FAIL)
    standing = [run for run in runs if run.stands is not None]
    if standing:
        # The device is not at fault if the legs cannot take even a level landing.
        fault = any(run.stands is False and run.passed is False for run in standing)
        up, tilted = [run.stands for run in standing].count(True), len(leaning(runs))
        part = _share("stands", up, len(standing), Tone.FAIL if fault else Tone.OPEN)
        if tilted:
            tone = Tone.OPEN if part.tone is Tone.PASS else part.tone
            part = Toned(f"{part.text}, {tilted} leaning", tone)
        yield part
    if unjudged:
        yield Toned(f"{unjudged} of {len(runs)} not judged", Tone.FAIL)
    elif any(run.passed is False and run.level and run.stands is not False for run in runs):
        passed = [run.passed for run in runs].count(True)
        yield Toned(f"{passed} of {len(runs)} pass", Tone.FAIL)


def _share(word: str, good: int, of: int, otherwise: Tone) -> Toned:
    return Toned(f"{word} {good} of {of}", Tone.PASS if good == of else otherwise)
