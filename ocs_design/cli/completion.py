"""Tab completion of values: words, names and files.

Nothing here loads a solver or the simulator: a shell asks at every press of the key. A space ends a
word in a shell, so names are offered with dashes instead, which the catalogues accept.
"""

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import TypeAlias

import typer

from ocs_design.common.errors import OcsError

Completer: TypeAlias = Callable[[str], list[str]]
Names: TypeAlias = Callable[[], Iterable[str]]

ROBOTS = (".urdf", ".xacro", ".xml", ".urdf.gz", ".xacro.gz", ".xml.gz")
"""Suffixes of robot files."""


def one_of(*words: str) -> Completer:
    """Completion of one of these words."""
    return any_of(lambda: words)


def any_of(names: Names) -> Completer:
    """Completion of names that are looked up on demand."""

    def complete(incomplete: str) -> list[str]:
        offered = (name.replace(" ", "-") for name in names())
        return [name for name in offered if name.startswith(incomplete)]

    return complete


def of_key(path: str) -> Completer:
    """Completion of the words that a key of the specification accepts, given by its path."""

    def words() -> Iterable[str]:
        from ocs_design.requirement.specification import all_keys

        return getattr(all_keys()[path].value, "words", ())

    return any_of(words)


def listed(completer: Completer) -> Completer:
    """Completion of the last of several names separated by commas."""

    def complete(incomplete: str) -> list[str]:
        before, comma, last = incomplete.rpartition(",")
        return [before + comma + name for name in completer(last)]

    return complete


def files(*ends: str) -> Completer:
    """Completion of files with these suffixes, and of folders on the way to them.

    Offers nothing if a name needs quotes or `~` must be expanded: the shell then offers its own.
    """

    def complete(incomplete: str) -> list[str]:
        paths = sorted(_paths(incomplete, ends))
        # A single folder would be taken as the complete word.
        while len(paths) == 1 and paths[0].endswith(os.sep):
            paths = sorted(_paths(paths[0], ends))
        needs_no_quotes = all(set(path) <= _PLAIN for path in paths)
        return paths if needs_no_quotes else []

    return complete


_PLAIN = frozenset(
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.,/@%" + os.sep
)


def _paths(typed: str, ends: tuple[str, ...]) -> Iterator[str]:
    folder, name = os.path.split(typed)
    try:
        entries = list(os.scandir(folder or os.curdir))
    except OSError:
        return
    for entry in entries:
        if not entry.name.startswith(name) or (entry.name.startswith(".") and not name):
            continue
        path = os.path.join(folder, entry.name)  # noqa: PTH118  begun with ./ it stays so
        if entry.is_dir():
            yield path + os.sep
        elif entry.name.lower().endswith(ends):
            yield path


def motors() -> Iterable[str]:
    """Motors in the catalogue, and the words accepted in place of one."""
    from ocs_design.catalogue.motors import motors

    return ("auto", "none", *motors())


def gears() -> Iterable[str]:
    """Gears in the catalogue, and the words accepted in place of one."""
    from ocs_design.catalogue.gears import gears

    return ("auto", "direct", *gears())


def materials() -> Iterable[str]:
    """Rim materials in the catalogue, and the words accepted in place of one."""
    from ocs_design.catalogue.materials import materials as rim_materials

    return ("auto", "steel", *rim_materials())


def formats() -> Iterable[str]:
    """Names of the formats that a design can be exported to."""
    from ocs_design.export.formats import ALL, FORMATS

    return (*(file_format.name for file_format in FORMATS), "figures", "report", ALL)


PAPER_MANEUVERS = ("disturbance", "drop", "back-flip")
"""Names of the default maneuvers."""


def maneuvers(context: typer.Context, incomplete: str) -> list[str]:
    """Names of the maneuvers in the specification typed so far, or of the paper's."""
    names: Iterable[str] = PAPER_MANEUVERS
    if context.params.get("spec") is not None:
        from ocs_design.requirement.reading import read_specification

        with suppress(OcsError):
            specified = read_specification(Path(context.params["spec"])).maneuvers
            names = [
                maneuver.name for maneuver in specified if " " not in maneuver.name
            ] or PAPER_MANEUVERS
    return any_of(lambda: names)(incomplete)
