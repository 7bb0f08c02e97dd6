"""What `ocs-design doctor` found."""

from collections.abc import Iterable

from rich.console import Console
from rich.text import Text

from ocs_design.doctor.finding import Examination, Finding, State
from ocs_design.report.layout import columns, heading, items, show

_STYLES = {
    State.WORKS: "green",
    State.MISSING: "yellow",
    State.UNFIT: "yellow",
    State.BROKEN: "red",
}


def print_examination(console: Console, examination: Examination) -> None:
    """A table of all, how to mend what does not work, and the verdict last."""
    _table(console, "Machine", examination.machine)
    _table(console, "Packages", (each for each in examination.packages if each.required))
    _table(console, "Extras", (each for each in examination.packages if not each.required))
    lacking = [each for each in examination.findings if each.state is not State.WORKS]
    optional = [each for each in lacking if not each.required and each.state is State.MISSING]
    _cures(console, "To mend", (each for each in lacking if each not in optional))
    _cures(console, "To add, if you want what it is for", optional)
    console.print()
    console.print(Text(_verdict(examination), style="bold"))


def _table(console: Console, title: str, findings: Iterable[Finding]) -> None:
    table = columns(title, "state", "found", "wanted", "for", left=5)
    for each in findings:
        state = Text(each.state.value, style=_STYLES[each.state])
        table.add_row(each.name, state, each.found, each.wanted, each.purpose)
    console.print()
    show(console, table)


def _cures(console: Console, title: str, findings: Iterable[Finding]) -> None:
    cures = dict.fromkeys(_cure(each) for each in findings if each.cure)
    if cures:
        heading(console, title)
        items(console, cures, style="")


def _cure(finding: Finding) -> str:
    reason = f" ({finding.reason})" if finding.reason else ""
    return f"{finding.name}{reason}: {finding.cure}"


def _verdict(examination: Examination) -> str:
    broken = [each.name for each in examination.findings if each.stands_in_the_way]
    if broken:
        return f"ocs-design {examination.version} does not work without {', '.join(broken)}"
    return f"ocs-design {examination.version} works here"
