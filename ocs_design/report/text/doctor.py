"""Findings of `doctor` in the terminal."""

from collections.abc import Iterable

from rich.console import Console
from rich.text import Text

from ocs_design.common.errors import extra_command
from ocs_design.device.findings import Examination, Finding, State
from ocs_design.report.table import Table, Tone, Toned, columns, listed
from ocs_design.report.text.layout import heading, items, show

_TONES = {
    State.WORKS: Tone.PASS,
    State.MISSING: Tone.OPEN,
    State.UNFIT: Tone.OPEN,
    State.BROKEN: Tone.FAIL,
}


def print_examination(console: Console, examination: Examination) -> None:
    """A table of all findings, how to mend what does not work, and the verdict last."""
    _print_findings(console, "Machine", examination.machine)
    for title, required in (("Packages", True), ("Extras", False)):
        _print_findings(
            console, title, (each for each in examination.packages if each.required is required)
        )
    lacking = [each for each in examination.findings if each.state is not State.WORKS]
    optional = [each for each in lacking if not each.required and each.state is State.MISSING]
    _print_cures(console, "To mend", (each for each in lacking if each not in optional))
    _print_cures(console, "To add, if you want what it is for", optional)
    extras = dict.fromkeys(each.extra for each in optional if each.extra)
    if len(extras) > 1:
        items(console, [f"all packages of these: {extra_command(*extras)}"], style="")
    console.print()
    broken = [each.name for each in examination.findings if each.stands_in_the_way]
    verdict = f"does not work without {listed(broken)}" if broken else "works here"
    console.print(Text(f"ocs-design {examination.version} {verdict}", style="bold"))


def _print_findings(console: Console, title: str, findings: Iterable[Finding]) -> None:
    heads = columns(f"<{title}", "<state", "<found", "<wanted", "<for")
    rows = tuple(
        (
            each.name,
            Toned(each.state.value, _TONES[each.state]),
            each.found,
            each.wanted,
            each.purpose,
        )
        for each in findings
    )
    console.print()
    show(console, Table(heads, rows))


def _print_cures(console: Console, title: str, findings: Iterable[Finding]) -> None:
    names: dict[str, list[str]] = {}
    for each in findings:
        if each.cure:
            reason = f" ({each.reason})" if each.reason else ""
            names.setdefault(each.cure, []).append(each.name + reason)
    cures = [f"{', '.join(which)}: {cure}" for cure, which in names.items()]
    if cures:
        heading(console, title)
        items(console, cures, style="")
