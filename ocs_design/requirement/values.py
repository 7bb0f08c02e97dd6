"""Parsers of the specification's values, and messages on what is wrong with a value.

One class per kind of value; each parses it or raises an `OcsError` that names the key.
"""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from math import pi
from reprlib import repr as shortened
from typing import Any, Generic, Protocol, TypeAlias, TypeVar

from ocs_design.common.errors import QuantityError, SpecificationError, closest
from ocs_design.common.units import (
    UNITS,
    Dimension,
    format_quantity,
    parse_quantity,
    si_unit,
    written_unit,
)

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)

Vector3: TypeAlias = tuple[float, float, float]

ONE_TURN = 6.3
"""One turn [rad], to two digits: a larger bare number was meant in degrees."""

SMALLEST = 1e-15
"""Least positive quantity (SI); a smaller one is a slip, and its powers would underflow."""


class Sign(Enum):
    """Allowed sign of a number; the value completes 'must be ...'."""

    ANY = "a number"
    NOT_NEGATIVE = "zero or positive"
    POSITIVE = "positive"

    def allows(self, number: float) -> bool:
        """Whether `number` has this sign."""
        if self is Sign.POSITIVE:
            return number > 0.0
        return self is Sign.ANY or number >= 0.0


class Value(Protocol[T_co]):
    """Parser of a value of a specification."""

    @property
    def takes(self) -> str:
        """What may be written, in words."""

    def read(self, raw: object, where: str, /) -> T_co:
        """The value that `raw` stands for.

        Args:
            raw: as TOML gives it, or text from the command line.
            where: key or option, for the message.

        Raises:
            OcsError: `raw` is not of this kind.
        """


@dataclass(frozen=True)
class Form(Generic[T]):
    """A `Value` made from a function that parses it."""

    takes: str
    read: Callable[[object, str], T]


def form(takes: str) -> Callable[[Callable[[object, str], T]], Form[T]]:
    """Decorator that makes a parsing function a `Form`; `takes` says what may be written."""
    return lambda read: Form(takes, read)


@dataclass(frozen=True)
class Quantity:
    """A number with or without its unit, parsed to SI.

    Attributes:
        dimension: what it measures.
        sign: allowed sign.
        most: largest magnitude allowed (SI).
        most_bare: largest magnitude accepted without a unit (SI).
        likely: unit in which a larger bare number was probably meant.
    """

    dimension: Dimension
    sign: Sign = Sign.POSITIVE
    most: float = math.inf
    most_bare: float = math.inf
    likely: str = ""

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return f"{self.dimension}: {', '.join(UNITS[self.dimension])}"

    def read(self, raw: object, where: str) -> float:
        """Value that `raw` stands for (`Value.read`)."""
        number = parse_quantity(raw, self.dimension, where)
        if not self.sign.allows(number):
            raise QuantityError(f"{where}: {raw} must be {self.sign.value}")
        if 0.0 < number < SMALLEST:
            raise QuantityError(f"{where}: {raw} is practically zero", hint="Check its unit.")
        if abs(number) > self.most:
            # In the unit that it was written in; for a bare number, the unit is named.
            unit = written_unit(raw) or si_unit(self.dimension)
            limit = format_quantity(math.copysign(self.most, number), unit)
            given = raw if written_unit(raw) else f"{raw} {unit}"
            beyond = "above" if number > 0.0 else "below"
            raise QuantityError(f"{where}: {given} is {beyond} {limit}", hint=self._hint(raw))
        if abs(number) > self.most_bare and not written_unit(raw):
            raise QuantityError(
                f"{where}: {raw} without a unit is {raw} {si_unit(self.dimension)}",
                hint=f"{self._hint(raw)} Give the number with its unit.",
            )
        return number

    def _hint(self, raw: object) -> str:
        """Suggestion where a bare number was probably meant in another unit."""
        bare = not written_unit(raw)
        return f"Did you mean {raw}{self.likely}?" if bare and self.likely else ""


@dataclass(frozen=True)
class NamedQuantity(Quantity):
    """A quantity, or a word that stands for one, in any case.

    Attributes:
        words: value of each word [SI].
    """

    words: Mapping[str, float] = field(default_factory=dict, hash=False)

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return f"{', '.join(self.words)}, or {super().takes}"

    def read(self, raw: object, where: str) -> float:
        """Value that `raw` stands for (`Value.read`)."""
        word = raw.strip().casefold() if isinstance(raw, str) else ""
        if word.isalpha() and word not in self.words:
            raise QuantityError(
                f"{where}: {shortened(raw)} is neither a number nor one of {', '.join(self.words)}",
                hint=did_you_mean(word, tuple(self.words)),
            )
        return self.words[word] if word in self.words else super().read(raw, where)


def angle(sign: Sign, most: float, most_bare: float = math.inf) -> Quantity:
    """An angle of at most this magnitude [rad]; bare numbers are often meant in degrees."""
    return Quantity(Dimension.ANGLE, sign, most, most_bare, "deg")


_DECIMAL_COMMA = re.compile(r",0[0-9]")
"""A decimal comma: nobody starts a number with a zero and a digit, unless they are decimals."""


@dataclass(frozen=True)
class Quantities:
    """A row of quantities of one dimension: a TOML array, or text with commas.

    Attributes:
        dimension: of each.
        counts: numbers of entries allowed.
    """

    dimension: Dimension
    counts: tuple[int, ...]

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return f"{self._wanted} of {Quantity(self.dimension).takes}"

    @property
    def _wanted(self) -> str:
        few = (
            self.counts
            if len(self.counts) < 4
            else (f"{self.counts[0]}, {self.counts[1]}, ...", self.counts[-1])
        )
        return " or ".join(map(str, few))

    def read(self, raw: object, where: str) -> tuple[float, ...]:
        """Value that `raw` stands for (`Value.read`)."""
        entries = raw.split(",") if isinstance(raw, str) else raw
        if isinstance(raw, str) and _DECIMAL_COMMA.search(raw):
            raise QuantityError(
                f"{where}: commas separate values in {raw}",
                hint="Write decimals with a point, as in 0.03,0.05,0.07.",
            )
        if not isinstance(entries, (list, tuple)) or len(entries) not in self.counts:
            count = f", not {len(entries)}" if isinstance(entries, (list, tuple)) else ""
            raise QuantityError(f"{where}: needs {self._wanted} values{count}, as in 0.1,0,0")
        values = tuple(
            parse_quantity(entry, self.dimension, f"{where}[{index}]")
            for index, entry in enumerate(entries)
        )
        *others, unit = map(written_unit, entries)
        unit_at_end = isinstance(raw, str) and unit and any(values[:-1]) and not any(others)
        if unit_at_end and parse_quantity(f"1{unit}", self.dimension, where) != 1.0:
            meant = [*(f"{entry.strip()}{unit}" for entry in entries[:-1]), entries[-1].strip()]
            raise QuantityError(
                f"{where}: only the last value of {raw} has a unit",
                hint=f"Write {','.join(meant)}.",
            )
        return values


@dataclass(frozen=True)
class Several:
    """One value, or a list of them.

    Attributes:
        each: how one is read.
    """

    each: Value[Any]

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return f"{self.each.takes}; or a list of these"

    def read(self, raw: object, where: str) -> tuple[Any, ...]:
        """Value that `raw` stands for (`Value.read`), without duplicates."""
        entries = raw if isinstance(raw, list) else [raw]
        return tuple(dict.fromkeys(self.each.read(entry, where) for entry in entries))


@form("positive number")
def positive_number(raw: object, where: str) -> float:
    """A bare positive number."""
    return Quantity(Dimension.RATIO).read(raw, where)


@form("number from 0.5 to below 1, or 50% to below 100%")
def chance(raw: object, where: str) -> float:
    """A reliability from 0.5 to below 1, written as 0.99 or 99%."""
    share = parse_quantity(raw, Dimension.RATIO, where)
    if not 0.5 <= share < 1.0:
        meant = f"Did you mean {raw}%? " if 50.0 <= share < 100.0 else ""
        raise QuantityError(
            f"{where}: {raw} must be at least 0.5 and below 1",
            hint=f"{meant}0.5 sizes for a robot exactly as in its file; nothing is certain.",
        )
    return share


@form("whole number")
def whole_number(raw: object, where: str) -> int:
    """A whole number, zero or positive."""
    text = str(raw).strip() if isinstance(raw, (str, int)) else ""
    if isinstance(raw, bool) or not text.isascii() or not text.isdigit():
        raise QuantityError(f"{where}: {shortened(raw)} is not a whole number, zero or positive")
    return int(text)


def _as_written(raw: str, words: Sequence[str]) -> str:
    """The word that `raw` is, in any case; empty if it is none."""
    return next((word for word in words if word.casefold() == raw.strip().casefold()), "")


@dataclass(frozen=True)
class Text:
    """Any text but an empty one.

    Attributes:
        words: with a special meaning, accepted in any case.
    """

    words: tuple[str, ...] = ()

    takes = "text"

    def read(self, raw: object, where: str) -> str:
        """Value that `raw` stands for (`Value.read`)."""
        # A null character ends a path for the operating system.
        if not isinstance(raw, str) or not raw.strip() or "\0" in raw:
            what = "is empty" if raw == "" else f"{shortened(raw)} is not a text in quotes"
            raise SpecificationError(f"{where}: {what}")
        return _as_written(raw, self.words) or raw


@form("name, or several separated by commas")
def several_names(raw: object, where: str) -> str:
    """One name, or several: a list, or one text separated by commas; duplicates are dropped."""
    texts = [
        Text(("auto", "none")).read(part, where)
        for part in (raw if isinstance(raw, list) else [raw])
    ]
    named = dict.fromkeys(name for text in texts for name in names_in(text))
    return NAME_SEPARATOR.join(named)


NAME_SEPARATOR = ", "
"""Separator of the names in a result of `several_names`."""


def names_in(text: str) -> tuple[str, ...]:
    """Names in a result of `several_names`."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


@form("names, or none")
def link_names(raw: object, where: str) -> tuple[str, ...]:
    """Names: a TOML array, or text with commas; the word `none` means no names."""
    if raw == "none":
        return ()
    entries = raw.split(",") if isinstance(raw, str) else raw
    if not isinstance(entries, (list, tuple)):
        raise SpecificationError(f"{where}: {shortened(raw)} is not a list of names")
    names = tuple(Text().read(entry, where).strip() for entry in entries)
    if len(set(names)) < len(names):
        raise SpecificationError(f"{where}: {shortened(raw)} contains a name twice")
    return names


@dataclass(frozen=True)
class Choice:
    """One of a few words."""

    words: tuple[str, ...]

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return ", ".join(self.words)

    def read(self, raw: object, where: str) -> str:
        """Value that `raw` stands for (`Value.read`)."""
        if isinstance(raw, str) and (word := _as_written(raw, self.words)):
            return word
        # Choices of several words, as in 'any one motor', are quoted to keep them apart.
        quoted = any(" " in word for word in self.words)
        known = (f"{word!r}" if quoted else word for word in self.words)
        raise SpecificationError(
            f"{where}: {shortened(raw)} is not one of {', '.join(known)}",
            hint=did_you_mean(raw, self.words),
        )


@dataclass(frozen=True)
class WordOr:
    """One of a few words, in any case, or a quantity.

    Attributes:
        words: with a special meaning. quantity: parser of anything else.
    """

    words: tuple[str, ...]
    quantity: Quantity

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return f"{', '.join(self.words)}, or {self.quantity.takes}"

    def read(self, raw: object, where: str) -> float | str:
        """Value that `raw` stands for (`Value.read`)."""
        if not isinstance(raw, str) or any(map(str.isdigit, raw)) or not raw.strip():
            return self.quantity.read(raw, where)
        if word := _as_written(raw, self.words):
            return word
        raise QuantityError(
            f"{where}: {shortened(raw)} is neither a number nor one of {', '.join(self.words)}",
            hint=did_you_mean(raw.strip(), self.words),
        )


@form("true or false")
def true_or_false(raw: object, where: str) -> bool:
    """True or false."""
    if isinstance(raw, bool):
        return raw
    raise SpecificationError(f"{where}: {shortened(raw)} is neither true nor false")


class JointValue(float):
    """Value of a joint [rad or m].

    Attributes:
        dimension: of the unit with which it was written; None for a bare number.
    """

    dimension: Dimension | None

    def __new__(cls, value: float, dimension: Dimension | None = None) -> "JointValue":
        """A number with its dimension."""
        made = super().__new__(cls, value)
        made.dimension = dimension
        return made


@form("table of joint = angle or length")
def joint_values(raw: object, where: str) -> Mapping[str, JointValue]:
    """Values of joints by name: angles, or lengths if given with a unit of length.

    A table, or texts `NAME=VALUE` from the command line.
    """
    table = raw
    if isinstance(raw, list):
        pairs: dict[str, object] = {}
        for text in raw:
            name, separator, value = str(text).partition("=")
            if not (name and separator):
                raise SpecificationError(
                    f"{where}: {shortened(text)} is not NAME=VALUE", hint="Write hip=10deg."
                )
            pairs[name] = value
        table = pairs
    if not isinstance(table, Mapping):
        raise SpecificationError(
            f"{where}: {shortened(raw)} is not a table, as in {{ hip = '10deg' }}"
        )
    joints: dict[str, JointValue] = {}
    for name, value in table.items():
        place = f"{where}.{name}"
        try:
            length = parse_quantity(value, Dimension.LENGTH, place)
        except QuantityError:
            angle = parse_quantity(value, Dimension.ANGLE, place)
            joints[name] = JointValue(angle, Dimension.ANGLE)
        else:
            joints[name] = (
                JointValue(length, Dimension.LENGTH)
                if written_unit(value)
                else JointValue(_BARE_JOINT.read(value, place))
            )
    return joints


_BARE_JOINT = angle(Sign.ANY, math.inf, ONE_TURN)
"""A bare number is an angle, and no large one."""


def did_you_mean(word: object, known: tuple[str, ...]) -> str:
    """Question that suggests the closest of `known`; empty if none is close."""
    close = closest(word, known) if isinstance(word, str) else ()
    return f"Did you mean {close[0]!r}?" if close else ""


FASTEST_BARE = 4000.0
"""Largest wheel speed accepted without a unit [rad/s], 38,000 rpm: more was meant in rpm."""

FASTEST_TURN = 4.0 * pi
"""Largest rate accepted without a unit [rad/s], two turns a second: more was meant in degrees."""

MOST_BARE_TORQUE = 100.0
"""Largest wheel torque accepted without a unit [N m]: more was meant in mN m."""

HIGHEST_VOLTAGE = 1000.0
"""Highest supply voltage accepted [V], beyond any robot's."""

MOST_TURNS = 10
"""Most turns of a flip; no animal or machine comes near."""

LENGTH, MASS = Quantity(Dimension.LENGTH), Quantity(Dimension.MASS)
TIME = Quantity(Dimension.TIME)

HEIGHT = Quantity(Dimension.LENGTH, most_bare=20.0, likely="mm")
"""Height of a jump or a fall: nothing with legs lands from higher than a house."""

WHEEL_RATE = Quantity(Dimension.ANGULAR_SPEED, most_bare=FASTEST_BARE, likely="rpm")
TRUNK_RATE = Quantity(Dimension.ANGULAR_SPEED, most_bare=FASTEST_TURN, likely="deg/s")
TUMBLE = replace(TRUNK_RATE, sign=Sign.ANY)
WHEEL_TORQUE = Quantity(Dimension.TORQUE, most_bare=MOST_BARE_TORQUE, likely="mNm")
SUPPLY = Quantity(Dimension.VOLTAGE, most=HIGHEST_VOLTAGE, likely="mV")
INCIDENCE = angle(Sign.NOT_NEGATIVE, pi / 2)
TURN = angle(Sign.ANY, MOST_TURNS * 2.0 * pi, ONE_TURN)

TILT = angle(Sign.ANY, pi, pi / 2)
"""A tilt, upside down at most."""

YAW = angle(Sign.ANY, 2.0 * pi, ONE_TURN)
SPIN = Quantity(Dimension.ANGULAR_SPEED, Sign.ANY, most_bare=FASTEST_BARE, likely="rpm")

GRAVITY = NamedQuantity(
    Dimension.ACCELERATION,
    Sign.NOT_NEGATIVE,
    words={"earth": 9.81, "moon": 1.62, "mars": 3.71, "orbit": 0.0},
)
"""Gravity: of the Earth and the Moon as in the paper; of Mars, NASA, Mars Fact Sheet."""
