"""Finding a catalogue's entry by its name."""

from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import TypeVar

from ocs_design.catalogue.table import Row
from ocs_design.exceptions import SpecificationError

T = TypeVar("T")

MOST_LISTED = 12
"""Names in a hint; more are read in the catalogue itself."""


def entry(known: Mapping[str, T], name: str, kind: str) -> T:
    """The entry called `name`; `kind` says of what, for people.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    if name in known:
        return known[name]
    folded = {candidate.casefold(): candidate for candidate in known}
    part = name.casefold()
    # A model without its winding is how people call a motor.
    longer = [match for match in folded if part and part in match][:3]
    close = [folded[match] for match in longer or get_close_matches(part, folded, n=3)]
    raise SpecificationError(f"there is no {kind} {name!r}", hint=_hint(known, close, kind))


def _hint(known: Mapping[str, T], close: Sequence[str], kind: str) -> str:
    if close:
        return f"Did you mean {' or '.join(close)}?"
    if len(known) <= MOST_LISTED:
        return f"Known: {', '.join(known)}."
    return f"`ocs-design catalogue {kind}s` lists all {len(known)}."


def named_twice(rows: Sequence[Row]) -> Iterator[str]:
    """One line for each entry that has the name of one before it."""
    first: dict[str, str] = {}
    for row in rows:
        name = row.cells.get("name")
        if not isinstance(name, str):
            continue
        if name in first:
            yield f"{row.where}: {name!r} is already the name of {first[name]}"
        first.setdefault(name, row.where)


def merged(known: Mapping[str, T], own: Mapping[str, T]) -> Mapping[str, T]:
    """Both, sorted by name; an entry of `own` replaces one of the same name."""
    return dict(sorted({**known, **own}.items()))
