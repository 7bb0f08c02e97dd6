"""Mass of the lightest device against one key of the specification: charts and output folder."""

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from io import StringIO
from pathlib import Path

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.files import to_json
from ocs_design.common.wording import in_unit
from ocs_design.device.answers import Front, FrontPoint
from ocs_design.device.records.selection import SelectionRecord
from ocs_design.export.folder import FRONT_FILE, staged_folder
from ocs_design.report.charts.chart import SERIES, Axis, Chart, Curve, Ink, Mark, Points, Rule
from ocs_design.report.charts.svg import write_charts

_HEIGHT = 300.0
"""Height of the chart [px]."""

COLUMNS: Mapping[str, str] = {
    "mass": "mass_kg",
    "share": "share_of_robot",
    "motor": "motor",
    "gear": "gear",
    "material": "material",
    "incidence": "incidence_rad",
    "outer_radius": "outer_radius_m",
    "inner_radius": "inner_radius_m",
    "height": "height_m",
    "rim_mass": "rim_mass_kg",
    "spin_inertia": "spin_inertia_kg_m2",
    "overvoltage": "overvoltage",
}
"""Column headings of the CSV file, by the fields of a device."""


def front_chart(front: Front) -> Chart:
    """Chart of a front: a line, broken where there is no device, and points coloured by drive."""
    values = _values(front, front.points)
    masses = np.array([1e3 * p.device.mass if p.device else np.nan for p in front.points])
    y = Axis.around("mass of the device", "g", masses, room=0.1)
    marks: list[Mark] = [Curve(values, masses, Ink.FAINT)]
    drives: dict[str, list[FrontPoint]] = {}
    for point in front.feasible:
        if point.device is not None:
            drives.setdefault(f"{point.device.motor}, {point.device.gear}", []).append(point)
    for index, (name, points) in enumerate(drives.items()):
        # Rings once all colours are used.
        hollow, ink = index // len(SERIES) % 2 == 1, SERIES[index % len(SERIES)]
        heights = np.array([1e3 * point.device.mass for point in points if point.device])
        marks.append(Points(_values(front, points), heights, ink, name, hollow=hollow))
    without = [point for point in front.points if point.device is None]
    if without:
        # Rings on the x axis.
        foot = np.full(len(without), y.low)
        marks.append(Points(_values(front, without), foot, Ink.PLAIN, "no device", hollow=True))
    if front.spans_own_value:
        own_value = in_unit(front.own_value, front.unit)
        marks.insert(0, Rule(own_value, upright=True, label="as specified", ink=Ink.FAINT))
    return Chart(
        name="front",
        title=f"{front.robot}: lightest device",
        description=f"Mass of the lightest device against {front.label}; each point is a separate "
        "design, in the colour of its motor and gear.",
        x=Axis.around(front.label, front.unit, values, room=0.04),
        y=y,
        marks=tuple(marks),
        height=_HEIGHT,
    )


def reserve_charts(selection: SelectionRecord | None) -> Iterator[Chart]:
    """Mass for the same motor and material against the number of robots of which one may fail."""
    reserve = None if selection is None else selection.kept
    if reserve is None or not reserve.curve:
        return
    levels, kilograms = np.array(reserve.curve).T
    robots, masses = 1.0 / (1.0 - levels), 1e3 * kilograms
    labels = tuple(f"{100.0 * level:g} %" for level in levels)
    own = 1.0 / (1.0 - reserve.reliability)
    yield Chart(
        name="reliability",
        title="Mass against reliability",
        description="Mass of a device of the same motor and material against the number of robots "
        "of which one may fail; each point is labelled with its reliability.",
        x=Axis("robots of which one may fail", "", 1.5, 1500.0, log=True),
        y=Axis.around("mass of the device", "g", masses, room=0.15),
        marks=(
            Rule(own, upright=True, label="as specified", ink=Ink.FAINT),
            Curve(robots, masses, Ink.BLUE),
            Points(robots, masses, Ink.BLUE, labels=labels),
        ),
    )


def _values(front: Front, points: Sequence[FrontPoint]) -> FloatArray:
    return in_unit(np.array([point.value for point in points]), front.unit)


def write_front(front: Front, folder: Path, *, force: bool = False) -> tuple[str, ...]:
    """Write a front with its chart and specifications: all of it or nothing.

    Returns:
        Remarks on what could not be written, and the cure.

    Raises:
        OutputError: see `staged_folder`.
    """
    with staged_folder(folder, force=force) as staging:
        (staging / "points").mkdir()
        for point in front.points:
            (staging / point.file).write_text(point.specification, encoding="utf-8")
        (staging / "front.csv").write_text(front_csv(front), encoding="utf-8", newline="")
        remarks = write_charts([front_chart(front)], staging)
        (staging / FRONT_FILE).write_bytes(to_json(front))
    return remarks


def front_csv(front: Front) -> str:
    """CSV with a row for each point in SI units and full precision, or the reason for no device."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    value = f"{front.against}_{front.si_unit}"
    writer.writerow([value, *COLUMNS.values(), "specification", "reason"])
    for point in front.points:
        device = {} if point.device is None else asdict(point.device)
        cells = [device.get(name, "") for name in COLUMNS]
        writer.writerow([point.value, *cells, point.file, point.reason])
    return text.getvalue()
