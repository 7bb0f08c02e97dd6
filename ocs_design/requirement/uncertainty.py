"""The section `[reality]`: how what is built and met differs from what was designed, key by key.

Drawn by the inverse of its distribution function from one number between 0 and 1: then another
distribution of one quantity leaves what is drawn of the others as it was. What holds where nothing
is stated, and what it rests on, is data: `reality.toml`.
"""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import inf, isfinite, pi, sqrt
from pathlib import Path
from statistics import NormalDist
from types import MappingProxyType
from typing import Any, Self

from ocs_design.actuation.drive import Drive
from ocs_design.common.errors import QuantityError, SpecificationError
from ocs_design.common.files import TextKind
from ocs_design.common.units import STANDARD_GRAVITY, Dimension, format_quantity, parse_quantity
from ocs_design.requirement.keys import Faults, keyed, keys_of
from ocs_design.requirement.values import Quantity, Text

CUT = 3.0
"""Standard deviations at which a normal distribution ends: no part is off by ten."""

_STANDARD = NormalDist()
_TAIL = _STANDARD.cdf(-CUT)


@dataclass(frozen=True)
class Distribution(ABC):
    """Distribution of one quantity; its fields are in the quantity's unit (SI)."""

    @abstractmethod
    def at(self, part: float) -> float:
        """The value that a `part` of all, 0..1, lie below."""

    def times(self, factor: float) -> Self:
        """The distribution of `factor` > 0 times the quantity."""
        return replace(self, **{name: factor * value for name, value in vars(self).items()})

    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """Text such as `normal(0.0, 0.01)`, each number as `quantity` writes it."""
        return f"{type(self).__name__.lower()}({', '.join(map(quantity, vars(self).values()))})"


@dataclass(frozen=True)
class Constant(Distribution):
    """A quantity that is always the same."""

    value: float

    def at(self, part: float) -> float:
        """The value."""
        del part
        return self.value

    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """The bare quantity."""
        return quantity(self.value)


@dataclass(frozen=True)
class Uniform(Distribution):
    """Uniform between two ends, `low <= high`."""

    low: float
    high: float

    def at(self, part: float) -> float:
        """Linear."""
        return self.low + part * (self.high - self.low)


@dataclass(frozen=True)
class Normal(Distribution):
    """Normal distribution, cut off at `CUT` standard deviations."""

    mean: float
    deviation: float

    def at(self, part: float) -> float:
        """The inverse of the cut normal distribution function."""
        return self.mean + self.deviation * _STANDARD.inv_cdf(_TAIL + part * (1.0 - 2.0 * _TAIL))


_FORM = re.compile(r"\s*(normal|uniform)\s*\(([^,()]*),([^,()]*)\)\s*")


@dataclass(frozen=True)
class Spread:
    """A quantity, or how it is spread.

    Attributes:
        dimension: what it measures.
        unit: that people think in.
        least, most: that it can be at all (SI).
    """

    dimension: Dimension
    unit: str
    least: float = -math.inf
    most: float = math.inf

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return f"{Quantity(self.dimension).takes}; or how it is spread"

    def read(self, raw: object, where: str) -> Distribution:
        """Value that `raw` stands for (`Value.read`)."""
        found: Distribution
        match = _FORM.fullmatch(raw) if isinstance(raw, str) else None
        if match is not None:
            first, second = (
                parse_quantity(text.strip(), self.dimension, where) for text in match.groups()[1:]
            )
            found = Normal(first, second) if match[1] == "normal" else Uniform(first, second)
            if isinstance(found, Normal) and found.deviation < 0.0:
                raise QuantityError(f"{where}: {raw}: the deviation must be zero or positive")
            if isinstance(found, Uniform) and found.high < found.low:
                raise QuantityError(f"{where}: {raw}: the low end comes first")
        elif isinstance(raw, str) and "(" in raw:
            raise QuantityError(
                f"{where}: {raw!r} is no distribution",
                hint="Write normal(MEAN, DEVIATION), uniform(LOW, HIGH) or one quantity.",
            )
        else:
            found = Constant(parse_quantity(raw, self.dimension, where))
        for end, limit, sense in (
            (found.at(0.0), self.least, -1.0),
            (found.at(1.0), self.most, 1.0),
        ):
            if sense * (end - limit) > 0.0:
                reached, bound = (format_quantity(value, self.unit) for value in (end, limit))
                raise QuantityError(
                    f"{where}: {raw} reaches {reached}, beyond {bound}",
                    hint="Make it narrower; a normal distribution ends at three deviations.",
                )
        return found


_MOST_OFF = 0.9
"""Largest relative error that leaves anything of a mass or a motor."""

_MOST_ASKEW = pi / 4
"""[rad], of a mount or a sensor; more is a number in degrees without its unit."""

_RELATIVE = Spread(Dimension.RATIO, "%", -_MOST_OFF, _MOST_OFF)
_ANGLE = Spread(Dimension.ANGLE, "deg", -_MOST_ASKEW, _MOST_ASKEW)
_RATE = Spread(Dimension.ANGULAR_SPEED, "deg/s")
_ANGLE_SPREAD = Spread(Dimension.ANGLE, "deg", 0.0, _MOST_ASKEW)
_RATE_SPREAD = Spread(Dimension.ANGULAR_SPEED, "deg/s", 0.0)


@dataclass(frozen=True, kw_only=True)
class UncertaintySection:
    """`[reality]`: distributions that `validate --samples` draws from; None: the default."""

    file: str | None = keyed(
        Text(),
        "file of distributions in place of the defaults, TOML",
        option="reality",
        why="Your own distributions; `size -v` lists the package's.",
        default="the package's",
        example='"my_reality.toml"',
    )
    mass_error: Distribution | None = keyed(
        _RELATIVE,
        "relative, of all of the robot's masses alike",
        why="After weighing the robot: the balance's error.",
    )
    inertia_error: Distribution | None = keyed(
        _RELATIVE,
        "relative, of the trunk's second moments of mass along x, y and z",
        why="From CAD 5 % is common, from a pendulum 1 %.",
    )
    com_error: Distribution | None = keyed(
        Spread(Dimension.LENGTH, "mm"),
        "of the trunk's centre of mass along x, y and z",
        why="Batteries and cables are seldom where CAD has them.",
    )
    incidence_error: Distribution | None = keyed(
        _ANGLE,
        "of each wheel's incidence angle",
        why="Play and tolerance of the mounts.",
    )
    torque_constant_error: Distribution | None = keyed(
        _RELATIVE,
        "relative, of each motor's torque constant",
        why="Makers state 5 to 10 % at most.",
    )
    resistance_error: Distribution | None = keyed(
        _RELATIVE,
        "relative, of each motor's resistance",
        why="A warm winding has 0.4 % more for each degree.",
    )
    bus_voltage_error: Distribution | None = keyed(
        _RELATIVE,
        "relative, of the supply's voltage",
        why="From a full battery to one that is to be charged.",
    )
    coulomb_friction: Distribution | None = keyed(
        Spread(Dimension.TORQUE, "mN m", 0.0),
        "of each wheel at any speed",
        why="Measure it: run the wheel down.",
        default="half of the motor's no-load torque",
        example='"5 mN m"',
    )
    viscous_friction: Distribution | None = keyed(
        Spread(Dimension.DAMPING, "uN m s/rad", 0.0),
        "of each wheel, over its speed",
        why="The same at speed.",
        default="the other half at the speed it is stated for",
        example='"3 uN m s/rad"',
    )
    air_drag: Distribution | None = keyed(
        Spread(Dimension.RATIO, "%", 0.0),
        "of the wheels, over what the formulas say",
        why="0: a vacuum, as on the Moon.",
    )
    torque_delay: Distribution | None = keyed(
        Spread(Dimension.TIME, "ms", 0.0, 0.1),
        "from measurement to torque, whole milliseconds",
        why="Bus, filters and the motor's own controller.",
    )
    attitude_noise: Distribution | None = keyed(
        _ANGLE_SPREAD,
        "standard deviation of each measurement of attitude",
        why="The data sheet of your inertial sensor has it.",
    )
    attitude_bias: Distribution | None = keyed(
        _ANGLE,
        "constant error of measured roll and pitch",
        why="Most of what a flight is off level by.",
    )
    gyro_noise: Distribution | None = keyed(
        _RATE_SPREAD,
        "standard deviation of each measured rate",
        why="Noise density times the root of the bandwidth.",
    )
    gyro_bias: Distribution | None = keyed(
        _RATE,
        "constant error of the measured rates about x, y and z",
        why="What is left after it was calibrated.",
    )
    contact_friction: Distribution | None = keyed(
        Spread(Dimension.RATIO, "%", 0.01),
        "coefficient between feet and floor",
        why="Of your feet on your floor.",
    )
    takeoff_rate: Distribution | None = keyed(
        _RATE,
        "that a push-off leaves about roll and pitch beyond what it was planned to",
        why="Film jumps without the device; 0: legs as planned.",
    )


_SPACE, _TILT = ("x", "y", "z"), ("roll", "pitch")

_PARTS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "inertia_error": _SPACE,
        "com_error": _SPACE,
        "attitude_bias": _TILT,
        "gyro_bias": _SPACE,
        "takeoff_rate": _TILT,
    }
)

_OF_EACH_WHEEL = frozenset(
    {
        "incidence_error",
        "torque_constant_error",
        "resistance_error",
        "coulomb_friction",
        "viscous_friction",
    }
)


def parts_of(key: str, wheels: Sequence[str]) -> tuple[str, ...]:
    """What a key is drawn for, each by itself; `("",)` where it is drawn once.

    Args:
        key: of `[reality]`. wheels: names of the device's modules.
    """
    return tuple(wheels) if key in _OF_EACH_WHEEL else _PARTS.get(key, ("",))


DEFAULTS = Path(__file__).with_name("reality.toml")
"""What holds where nothing is stated."""

_FILE = TextKind(
    "file of distributions", 1 << 16, 1000, "check --reality", 'mass_error = "normal(0, 2%)"'
)

FRICTION_SHARE = 0.01
"""No-load torque over the torque limit of a motor whose maker does not state its current."""


@dataclass(frozen=True)
class Entry:
    """One distribution of a file.

    Attributes:
        value: the distribution, of a share where `of` says what it is a share of.
        of: one of `_SCALES`, or empty. source: what it rests on.
    """

    value: Distribution
    of: str = ""
    source: str = ""

    def words(self, spread: Spread) -> str:
        """Text such as `normal(0%, 1%) of standing height`."""
        unit = "%" if self.of else spread.unit
        told = self.value.written(lambda number: format_quantity(number, unit))
        return f"{told} of {self.of}" if self.of else told


def entries(file: Path = DEFAULTS) -> Mapping[str, Entry]:
    """Every key's entry: of `file`, and of the package's own where that has none.

    Raises:
        SpecificationError: the file cannot be read, or has faults, all of which are listed.
    """
    own = _entries_once(DEFAULTS)
    if file == DEFAULTS:
        return own
    try:
        plain = file.is_file()
    except OSError:
        plain = False
    # A file may be edited between two calls, and a pipe can be read but once.
    return MappingProxyType({**own, **(_read_entries(file) if plain else _entries_once(file))})


@cache
def _entries_once(file: Path) -> Mapping[str, Entry]:
    """Entries of a file that is read on the first call alone."""
    return _read_entries(file)


def _read_entries(file: Path) -> Mapping[str, Entry]:
    """Entries that a file states, by key; see `entries`."""
    content = _FILE.parse_toml(_FILE.read(file), str(file))
    faults, found = Faults(), {}
    for name in sorted(content.keys() - {"reality"}):
        faults.unknown(name, name, ("reality",))
    for name, raw in faults.table(content.get("reality", {}), "reality").items():
        where, spread = f"reality.{name}", spreads().get(name)
        stated = raw if isinstance(raw, dict) else {"value": raw, "source": str(file)}
        if spread is None:
            faults.unknown(where, name, tuple(spreads()))
            continue
        for key in sorted(stated.keys() - _ENTRY_KEYS):
            faults.unknown(f"{where}.{key}", key, _ENTRY_KEYS)
        texts = {key: str(stated.get(key, "")) for key in _ENTRY_KEYS[1:]}
        if texts["of"] and texts["of"] not in _SCALES:
            faults.unknown(f"{where}.of", texts["of"], _SCALES)
        how = Spread(Dimension.RATIO, "%") if texts["of"] else spread
        if "value" not in stated:
            faults.append(f"{where}.value: is missing")
            continue
        value = faults.read(how, stated["value"], where)
        if value is not None:
            found[name] = Entry(value, **texts)
    if faults:
        raise SpecificationError(f"{file} has faults:", problems=faults)
    return MappingProxyType(found)


_ENTRY_KEYS = ("value", "of", "source")
_SCALES = ("standing height", "pendulum rate", "no-load torque", "no-load friction")


def no_load_torque(motor: Drive) -> float:
    """Torque that a motor takes to turn freely, at its wheel [N m]; 0 where it is not known."""
    if motor.no_load_current is not None and motor.torque_constant is not None:
        return motor.gear_ratio * motor.torque_constant * motor.no_load_current
    return FRICTION_SHARE * (motor.torque_limit or 0.0)


def default_uncertainty(
    standing_height: float, motor: Drive | None = None, file: str | None = None
) -> UncertaintySection:
    """Distributions that hold where nothing is stated.

    Args:
        standing_height: of the robot [m].
        motor: that turns the wheels; None: its friction is left open.
        file: in place of the package's own; None: that.

    Raises:
        SpecificationError: see `entries`; or a distribution goes beyond what there can be.
    """
    scales = {
        "standing height": standing_height,
        "pendulum rate": sqrt(STANDARD_GRAVITY / standing_height) if standing_height else 0.0,
    }
    if motor is not None:
        speed = motor.no_load_speed if isfinite(motor.no_load_speed) else inf
        if motor.rated_voltage and motor.bus_voltage:
            speed *= motor.rated_voltage / motor.bus_voltage
        torque = no_load_torque(motor)
        scales |= {"no-load torque": torque, "no-load friction": torque / speed}
    faults = Faults()
    found: dict[str, Any] = {}
    for name, entry in entries(DEFAULTS if file is None else Path(file)).items():
        if not entry.of:
            found[name] = entry.value
        elif entry.of in scales:
            text = entry.value.times(scales[entry.of]).written()
            found[name] = faults.read(spreads()[name], text, f"reality.{name}")
    if faults:
        raise SpecificationError(f"{file or DEFAULTS} has faults:", problems=faults)
    return UncertaintySection(**found)


def complete_uncertainty(
    stated: UncertaintySection, standing_height: float, motor: Drive
) -> UncertaintySection:
    """Distributions that are stated, and in place of the rest those of its file or of the package.

    Args:
        stated: by a user. standing_height: of the robot [m]. motor: that turns the wheels.

    Raises:
        SpecificationError: see `default_uncertainty`.
    """
    default = default_uncertainty(standing_height, motor, stated.file)
    return replace(
        default, **{name: getattr(stated, name) or getattr(default, name) for name in spreads()}
    )


def uncertainty_texts(section: UncertaintySection) -> Mapping[str, str]:
    """Every distribution that is stated, by key, as `design.json` keeps it: SI, to the last bit."""
    stated = {name: getattr(section, name) for name in spreads()}
    return {name: spread.written() for name, spread in stated.items() if spread is not None}


def uncertainty_of_texts(texts: Mapping[str, str], where: str) -> UncertaintySection:
    """The section that texts say; `where` says whose they are.

    Raises:
        OcsError: one is no distribution, or of no key.
    """
    faults = Faults()
    read = faults.fields(texts, spreads(), f"{where}: reality")
    if faults:
        raise SpecificationError(f"{where} states what cannot be read:", problems=faults)
    return UncertaintySection(**read)


@cache
def spreads() -> Mapping[str, Spread]:
    """How each distribution is read, by its key."""
    how = {name: key.value for name, key in keys_of(UncertaintySection).items()}
    return {name: value for name, value in how.items() if isinstance(value, Spread)}
