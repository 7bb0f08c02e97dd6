"""Entries of a catalogue by name: the package's own, and those of a user's file."""

from collections.abc import Callable, Mapping
from importlib.resources import as_file, files
from pathlib import Path
from types import MappingProxyType
from typing import Protocol, TypeVar

from ocs_design.catalogue.names import named_twice
from ocs_design.catalogue.table import Row, read_rows, refuse


class Named(Protocol):
    """What a catalogue holds."""

    @property
    def name(self) -> str:
        """Unique in its catalogue."""


E = TypeVar("E", bound=Named)


def load_entries(
    path: Path, kind: str, entry_of: Callable[[Row, list[str]], E | None]
) -> Mapping[str, E]:
    """Every entry of a CSV or TOML file by name, sorted (docs/catalogue.md has the columns).

    Args:
        path: of the file.
        kind: of entry: `motor` or `gear`.
        entry_of: makes one of a row; None, with its faults added, of a row that cannot be right.

    Raises:
        SpecificationError: it cannot be read, or has faults, all of which are listed.
    """
    faults: list[str] = []
    rows = read_rows(path, kind, faults)
    found = [entry for row in rows if (entry := entry_of(row, faults)) is not None]
    faults.extend(named_twice(rows))
    refuse(path, faults)
    return _by_name({entry.name: entry for entry in found})


def packaged(name: str, load: Callable[[Path], Mapping[str, E]]) -> Mapping[str, E]:
    """Every entry of a file that comes with the package."""
    with as_file(files("ocs_design.catalogue").joinpath(name)) as path:
        return load(path)


def extended(
    known: Mapping[str, E], file: Path | None, load: Callable[[Path], Mapping[str, E]]
) -> Mapping[str, E]:
    """These entries and those of a user's file, which replace those of the same name."""
    return known if file is None else _by_name({**known, **load(file)})


def _by_name(entries: Mapping[str, E]) -> Mapping[str, E]:
    return MappingProxyType(dict(sorted(entries.items())))
