"""Every maneuver, flown with the device and without it."""

from collections.abc import Sequence

from ocs_design.design_file import ValidationRecord
from ocs_design.report.charts.chart import Chart
from ocs_design.report.figures.figures import scenario_charts
from ocs_design.report.flights import WITH_DEVICE, WITHOUT_DEVICE, flies, run_story
from ocs_design.report.html.elements import Markup, element, items, section, table
from ocs_design.report.html.figure import figures
from ocs_design.report.landings import landing_remarks
from ocs_design.report.quantities import degrees, rpm
from ocs_design.report.story import Story

_COLUMNS = (
    "device", "verdict",
    "pitch at touchdown [deg]", "roll [deg]", "pitch at the end [deg]", "roll [deg]",
    "turned [deg]",
    "wheel speed [rpm]", "torque [N m]",
)  # fmt: skip

_TOUCHDOWN = ("touchdown_pitch", "touchdown_roll")


def maneuvers_section(story: Story, scenarios: Sequence[str]) -> Markup:
    """A part for each maneuver; `scenarios` are those that can be shown again."""
    charts = scenario_charts(story)
    names = dict.fromkeys(run.scenario for run in story.design.validation)
    if not names:
        return section("maneuvers", "Maneuvers", element("p", "No flight was simulated."))
    parts = (_maneuver(story, name, charts.get(name, ()), scenarios) for name in names)
    remarks = items(landing_remarks(story.design), look="warnings")
    return section("maneuvers", "Maneuvers, with the device and without", remarks, *parts)


def _maneuver(story: Story, name: str, charts: Sequence[Chart], scenarios: Sequence[str]) -> Markup:
    runs = [run for run in story.design.validation if run.scenario == name]
    number = str(scenarios.index(name)) if name in scenarios else ""
    again = (
        element("button", "Show it in the view", type="button", data_replay=number)
        if number
        else Markup("")
    )
    return element(
        "article",
        element("h3", name, " ", again),
        table(f"{name}: outcome", _COLUMNS, map(_cells, runs), words=(0, 1)),
        *(element("p", run_story(run), class_="note") for run in runs),
        figures(charts, flight=number) if charts else Markup(""),
    )


def _cells(run: ValidationRecord) -> tuple[str, ...]:
    word, _ = (WITH_DEVICE if run.ocs else WITHOUT_DEVICE)[run.passed]
    mark = element("span", word, class_=f"mark {_look(run)}")
    return (
        "with" if run.ocs else "without",
        mark,
        *(_angle(run, name) if flies(run.metrics) else "-" for name in _TOUCHDOWN),
        _angle(run, "final_pitch"),
        _angle(run, "final_roll"),
        _angle(run, "turned_angle") if flies(run.metrics) else "-",
        _shown(run, "peak_wheel_speed"),
        _shown(run, "peak_wheel_torque"),
    )


def _look(run: ValidationRecord) -> str:
    """Without the device a failure is what one expects, and no alarm."""
    if run.passed is None:
        return "open"
    return "pass" if run.passed else "fail" if run.ocs else "plain"


def _angle(run: ValidationRecord, name: str) -> str:
    value = run.metrics.get(name)
    return "-" if value is None else degrees(value).removesuffix(" deg")


def _shown(run: ValidationRecord, name: str) -> str:
    value = run.metrics.get(name)
    if not run.ocs or value is None:
        return "-"
    return rpm(value).removesuffix(" rpm") if name == "peak_wheel_speed" else f"{value:.3g}"
