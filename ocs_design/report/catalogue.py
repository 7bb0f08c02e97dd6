"""What `catalogue` prints."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from rich.console import Console

from ocs_design.catalogue.gears import gears_to_json, known_gears
from ocs_design.catalogue.materials import materials, materials_to_json
from ocs_design.catalogue.motors import known_motors, motors_to_json
from ocs_design.drive.motor import Motor
from ocs_design.exceptions import UsageError
from ocs_design.report.catalogue_tables import print_gears, print_materials, print_motors
from ocs_design.report.layout import heading, items
from ocs_design.report.threads import mounting_text

MOST_NAMES = 8
"""That are spelt out before a source they share."""


class Row(Protocol):
    """An entry of any catalogue."""

    @property
    def name(self) -> str:
        """Unique in its catalogue."""

    @property
    def source(self) -> str:
        """Where its figures come from."""


def _remark(row: Row) -> str:
    """What a reader of its figures must know; materials have none."""
    return str(getattr(row, "remark", ""))


def _mounting(row: Row) -> str:
    """Shaft and threads of a motor."""
    return mounting_text(row.mounting) if isinstance(row, Motor) else ""


@dataclass(frozen=True)
class Listing:
    """One catalogue, ready to be printed.

    Attributes:
        to_json: as one document.
        print_table: for people.
        rows: every entry.
    """

    to_json: Callable[[], bytes]
    print_table: Callable[[Console], None]
    rows: Sequence[Row]

    def show(self, console: Console, *, verbose: bool) -> None:
        """The table and the sources, with `verbose` of each row."""
        self.print_table(console)
        heading(console, "Sources")
        items(console, _sources(self.rows, verbose=verbose))


def listing(what: str, files: Mapping[str, str | None]) -> Listing:
    """The catalogue `what`, with the user's file of its kind, if there is one.

    Raises:
        UsageError: there is no such catalogue, or a file of another kind is given.
        SpecificationError: the file cannot be read or has faults.
    """
    if what not in LISTINGS:
        known = ", ".join(f"catalogue {name}" for name in LISTINGS)
        raise UsageError(f"there is no catalogue of {what}", hint=f"try: {known}")
    for kind, file in files.items():
        if file is not None and kind != what:
            raise UsageError(f"--{kind} says nothing of {what}", hint=f"try: catalogue {kind}")
    file = files.get(what)
    return LISTINGS[what](None if file is None else Path(file))


def _motor_listing(file: Path | None) -> Listing:
    found = tuple(known_motors(file).values())
    return Listing(
        lambda: motors_to_json(found), lambda console: print_motors(console, found), found
    )


def _gear_listing(file: Path | None) -> Listing:
    found = tuple(known_gears(file).values())
    return Listing(lambda: gears_to_json(found), lambda console: print_gears(console, found), found)


def _material_listing(_: Path | None) -> Listing:
    found = tuple(materials().values())
    return Listing(materials_to_json, lambda console: print_materials(console, found), found)


LISTINGS: Mapping[str, Callable[[Path | None], Listing]] = {
    "motors": _motor_listing,
    "gears": _gear_listing,
    "materials": _material_listing,
}


def _sources(rows: Sequence[Row], *, verbose: bool) -> Iterator[str]:
    """Each source with the entries that rest on it; with `verbose` each entry by itself."""
    if verbose:
        for row in rows:
            said = (row.source, _mounting(row), _remark(row))
            yield f"{row.name}: " + "; ".join(part for part in said if part)
        return
    by_source: dict[str, list[str]] = {}
    for row in rows:
        by_source.setdefault(row.source, []).append(row.name)
    for source, names in by_source.items():
        several = f"{len(names)} of the above"
        yield f"{several if len(names) > MOST_NAMES else ', '.join(names)}: {source}"
