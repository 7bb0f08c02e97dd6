"""Finding a catalogue's entry by its name."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import TypeVar

from ocs_design.catalogue.table import Row
from ocs_design.exceptions import SpecificationError

T = TypeVar("T")

MOST_SUGGESTED = 3
# One letter of five or more may be wrong.
_SAME_MODEL = 0.8

MOST_LISTED = 12
"""Names in a hint; more are read in the catalogue itself."""


def entry(known: Mapping[str, T], name: str, kind: str) -> T:
    """The entry called `name`; `kind` says of what, for people.

    Raises:
        SpecificationError: there is none; the hint names the closest.
    """
    if name in known:
        return known[name]
    raise SpecificationError(
        f"there is no {kind} {name!r}", hint=_hint(known, _closest(known, name), kind)
    )


def _closest(known: Iterable[str], name: str) -> Sequence[str]:
    """At most three names that may be meant, best first.

    A model without its winding is how people call a motor, misspelt or not.
    """
    folded = {candidate.casefold(): candidate for candidate in known}
    part = name.casefold()
    longer = [match for match in folded if part and part in match][:MOST_SUGGESTED]
    if longer:
        return [folded[match] for match in longer]
    whole = get_close_matches(part, folded, n=MOST_SUGGESTED)
    begun = {match[: len(part)] for match in folded}
    models = get_close_matches(part, begun, n=MOST_SUGGESTED, cutoff=_SAME_MODEL)
    begin = [match for model in models for match in folded if match.startswith(model)]
    return [folded[match] for match in (whole or begin)[:MOST_SUGGESTED]]


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
