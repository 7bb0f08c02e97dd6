"""The story of a design on one screen; `-v` has all of it."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path, PurePosixPath

from rich.console import Console
from rich.text import Text

from ocs_design.design_file import OcsDesign
from ocs_design.export.folder import DESIGN_FILE, REPORT_FILE
from ocs_design.report.device import device_facts
from ocs_design.report.flights import WITH_DEVICE, WITHOUT_DEVICE, summary
from ocs_design.report.layout import columns, facts, heading, items, note, show
from ocs_design.report.mind import mind
from ocs_design.report.prices import what_buys
from ocs_design.report.quantities import degrees
from ocs_design.report.terminal import recorded_margins, robot_facts
from ocs_design.report.tilt_plot import off_level, tilt_plots
from ocs_design.simulation.metrics import Metrics
from ocs_design.simulation.scenario import Run
from ocs_design.sizing.margins.margin import Margin
from ocs_design.units import ceiled

ROBOT_FACTS = ("mass", "posture", "locked inertia")
DEVICE_FACTS = (
    "mass of both",
    "mass of a module",
    "incidence alpha*",
    "rim",
    "spin inertia",
    "motor",
    "gear",
    "drive at the wheel",
    "left wheel at",
)

TIGHT = 1.05
"""A smaller factor between capacity and demand is worth telling."""

NARROWEST_PLOT, WIDEST_PLOT = 8, 20
BESIDE_PLOTS = 63
"""Columns of the flights' table without its plots."""


def print_summary(console: Console, design: OcsDesign, runs: Sequence[Run], folder: Path) -> None:
    """What was assumed first and the verdict last, where the eye is when a command ends."""
    if design.requirement.assumptions:
        heading(console, "Assumed, because nothing else was stated")
        note(console, " ".join(design.requirement.assumptions))
    heading(console, f"Robot: {design.robot.name}")
    facts(console, _chosen(robot_facts(design.robot), ROBOT_FACTS))
    heading(console, "Device: two flywheels" + ("" if _has_motor(design) else ", no motors yet"))
    facts(console, [*_device(design), ("limits", _limits(design)), *_prices(design)])
    _print_flights(console, design, runs)
    remarks = list(mind(design))
    if remarks:
        heading(console, "Mind")
        items(console, remarks, style="yellow")
    console.print()
    console.print(Text(f"{folder}/: {', '.join(_written(design))}"))
    console.print(
        summary([run.passed for run in runs if run.ocs]), Text("(-v: all figures)", "dim")
    )


def _has_motor(design: OcsDesign) -> bool:
    return design.ocs.motor.bus_voltage is not None


def _chosen(rows: Iterable[tuple[str, str]], names: Sequence[str]) -> Iterator[tuple[str, str]]:
    """The rows of these names, in the order of the names."""
    found = dict(rows)
    return ((name, found[name]) for name in names if name in found)


def _device(design: OcsDesign) -> Iterator[tuple[str, str]]:
    """Sources of figures are left to the whole report."""
    for name, value in _chosen(device_facts(design), DEVICE_FACTS):
        yield name, design.ocs.motor.name if name == "motor" and _has_motor(design) else value


def _limits(design: OcsDesign) -> str:
    """What binds, and what is used up or nearly so."""
    binding = [f"{name} binds" for name in design.sizing.binding]
    tight = [
        f"{margin.name}, {ceiled(100.0 / margin.factor, 0)}% used{_by(margin)}"
        for margin in recorded_margins(design)
        if margin.factor is not None and margin.factor < TIGHT
    ]
    return "; ".join([*binding, *tight]) or "none is reached"


def _prices(design: OcsDesign) -> Iterator[tuple[str, str]]:
    found = "" if design.selection is None else what_buys(design.selection)
    if found:
        yield "lighter with", found


def _by(margin: Margin) -> str:
    return f" ({margin.maneuver})" if margin.maneuver else ""


def _print_flights(console: Console, design: OcsDesign, runs: Sequence[Run]) -> None:
    """Each scenario with the device and without, and a curve of each."""
    if not runs:
        return
    heading(console, "Flights in MuJoCo, with the device and without")
    width = min((console.width - BESIDE_PLOTS) // 2, WIDEST_PLOT)
    plotted = width >= NARROWEST_PLOT and console.encoding.startswith("utf")
    flips = {item.name for item in design.requirement.maneuvers if item.kind == "flip"}
    plots = ("tilt with", "without") if plotted else ()
    table = columns("scenario", "with\ndeg off level", "without\ndeg off level", *plots, left=5)
    for pair in zip(runs[::2], runs[1::2], strict=True):
        verdicts = (_verdict(run, turns=run.scenario in flips) for run in pair)
        curves = _plots(pair, width) if plotted else ()
        table.add_row(Text(pair[0].scenario), *verdicts, *curves)
    show(console, table)


def _verdict(run: Run, *, turns: bool) -> Text:
    """With the angle that it rests on."""
    word, style = (WITH_DEVICE if run.ocs else WITHOUT_DEVICE)[run.passed]
    if run.metrics is None or run.passed is None:
        return Text(word, style=style)
    angle, kind = _angle(run.metrics, turns=turns)
    return Text(f"{word:<5} {degrees(angle).removesuffix(' deg'):>5}{kind}", style=style)


def _angle(found: Metrics, *, turns: bool) -> tuple[float, str]:
    """Turned by in a flip, swung by after a shove, else off level at touchdown [rad]."""
    if turns:
        return abs(found.turned_angle), " turned"
    if found.touchdown_time == found.lift_off_time:
        return float(off_level(found.roll_swing, found.pitch_swing)), " swing"
    return float(off_level(found.touchdown_roll, found.touchdown_pitch)), ""


def _plots(pair: tuple[Run, Run], width: int) -> list[Text]:
    plots, _ = tilt_plots([run.series for run in pair], width)
    return [Text(plot) for plot in plots]


def _written(design: OcsDesign) -> Iterator[str]:
    """The artefact, the report, the other files beside them, and the folders."""
    yield from (DESIGN_FILE, REPORT_FILE)
    paths = [PurePosixPath(name) for name in design.files]
    yield from sorted(str(path) for path in paths if len(path.parts) == 1)
    yield from sorted({f"{path.parts[0]}/" for path in paths if len(path.parts) > 1})
