"""A front as a folder: tables, a drawing, and the specification of every point."""

import csv
from collections.abc import Mapping
from dataclasses import asdict
from io import StringIO
from pathlib import Path

from ocs_design.answers import Front, to_json
from ocs_design.export.folder import FRONT_FILE, staged_folder
from ocs_design.report.charts.files import write_charts
from ocs_design.report.figures.front import front_chart

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
}
"""Heading of each field of a device."""


def write_front(front: Front, folder: Path, *, force: bool = False) -> tuple[str, ...]:
    """Write all of it or nothing.

    Returns:
        What could not be written, and the cure.

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
    """A row for each point, SI, all digits; a point without a device has its reason."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    value = f"{front.against}_{front.si_unit}"
    writer.writerow([value, *COLUMNS.values(), "specification", "reason"])
    for point in front.points:
        device = {} if point.device is None else asdict(point.device)
        cells = [device.get(name, "") for name in COLUMNS]
        writer.writerow([point.value, *cells, point.file, point.reason])
    return text.getvalue()
