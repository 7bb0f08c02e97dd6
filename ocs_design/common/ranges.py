"""Ranges of the figures of a design, declared by the type of each field: `height: Length`.

They are wide: no device has a figure outside. `device.checks` refuses such figures. A field that is
a column of a catalogue's file declares its unit, too.
"""

from collections.abc import Collection, Mapping
from dataclasses import fields
from functools import cache
from math import inf
from types import UnionType
from typing import Annotated, NamedTuple, TypeAlias, Union, get_args, get_origin, get_type_hints

LARGEST = 1e12
"""Largest figure, SI: stresses reach 1e9."""

SMALLEST_LENGTH, LARGEST_LENGTH = 1e-7, 100.0
"""Limits of dimensions [m]."""

MOST_BOLTS = 100
"""Largest number of bolts or holes in a ring."""


class Range(NamedTuple):
    """Range of a figure.

    Attributes:
        low, high: limits, both allowed.
        absent: whether zero is allowed too, for a feature that does not exist.
        words: for messages; empty: its limits.
    """

    low: float
    high: float
    absent: bool = False
    words: str = ""

    def fault(self, value: object) -> str:
        """Text on a value that is out of the range; empty: it is not."""
        assert isinstance(value, int | float)
        if (self.absent and value == 0.0) or self.low <= value <= self.high:
            return ""
        return f"is {value:g}, not {self.words or f'between {self.low:g} and {self.high:g}'}"


class OneOf(NamedTuple):
    """Words or numbers that are allowed."""

    known: Collection[str | int]

    def fault(self, value: object) -> str:
        """Text on a value that is not one of them; empty: it is."""
        if value in self.known:
            return ""
        return f"is {value!r}, which is not one of {', '.join(map(str, self.known))}"


Length: TypeAlias = Annotated[float, Range(SMALLEST_LENGTH, LARGEST_LENGTH)]
LengthIfAny: TypeAlias = Annotated[float, Range(SMALLEST_LENGTH, LARGEST_LENGTH, absent=True)]
"""Zero where there is no such part or feature."""

Distance: TypeAlias = Annotated[float, Range(0.0, LARGEST_LENGTH)]
Positive: TypeAlias = Annotated[float, Range(1e-15, LARGEST)]
NotNegative: TypeAlias = Annotated[float, Range(0.0, LARGEST)]
Signed: TypeAlias = Annotated[float, Range(-LARGEST, LARGEST)]
Capacity: TypeAlias = Annotated[float, Range(1e-15, inf, words="positive")]
"""Limit of a supply; infinite: not limited."""

Count: TypeAlias = Annotated[int, Range(0, MOST_BOLTS)]


class Unit(NamedTuple):
    """Unit of a figure in a file, at the end of its column's name: `kg` in `mass_kg`."""

    suffix: str


@cache
def ranges_of(record: type) -> Mapping[str, Range | OneOf]:
    """Range of each number of a dataclass, and the choices of each word that has them.

    Raises:
        TypeError: a number's field states none.
    """
    hints, ranges = get_type_hints(record, include_extras=True), {}
    for name in (field.name for field in fields(record)):
        rule = _rule_of(hints[name])
        if rule is not None:
            ranges[name] = rule
        elif float in _options(hints[name]):
            raise TypeError(f"{record.__name__}.{name} states no range")
    return ranges


def _rule_of(hint: object) -> Range | OneOf | None:
    for option in (hint, *_options(hint)):
        for specified in getattr(option, "__metadata__", ()):
            if isinstance(specified, Range | OneOf):
                return specified
    return None


def _options(hint: object) -> tuple[object, ...]:
    """Types that a hint allows."""
    if get_origin(hint) is Annotated:
        return _options(get_args(hint)[0])
    return get_args(hint) if get_origin(hint) in {Union, UnionType} else (hint,)
