"""The section `[reality]`: how robot and surroundings differ from the design, key by key.

Each quantity is sampled by the inverse of its distribution function, from one number between 0 and
1: another distribution of one quantity then leaves the samples of all others unchanged. The
defaults and their sources are data: `reality.toml`.
"""

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import inf, pi, sqrt
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

TRUNCATION = 3.0
"""Standard deviations at which a normal distribution is cut off: no part is off by ten."""

_STANDARD = NormalDist()
_TAIL = _STANDARD.cdf(-TRUNCATION)


@dataclass(frozen=True)
class Distribution(ABC):
    """Distribution of one quantity; its fields are in the quantity's unit (SI)."""

    @abstractmethod
    def at(self, part: float) -> float:
        """Value below which a `part` of all samples, 0..1, lie."""

    def times(self, factor: float) -> Self:
        """Distribution of the quantity times `factor` > 0."""
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
    """Normal distribution, cut off at `TRUNCATION` standard deviations."""

    mean: float
    deviation: float

    def at(self, part: float) -> float:
        """The inverse of the cut normal distribution function."""
        return self.mean + self.deviation * _STANDARD.inv_cdf(_TAIL + part * (1.0 - 2.0 * _TAIL))


_FORM = re.compile(r"\s*(normal|uniform)\s*\(([^,()]*),([^,()]*)\)\s*")


@dataclass(frozen=True)
class Spread:
    """A quantity, or its distribution.

    Attributes:
        dimension: what it measures.
        unit: for display.
        least, most: limits of what is possible (SI).
        parts: components that are sampled independently, or `EACH_WHEEL`.
    """

    dimension: Dimension
    unit: str
    least: float = -inf
    most: float = inf
    parts: tuple[str, ...] = ("",)

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return f"{Quantity(self.dimension).takes}; or a distribution"

    def read(self, raw: object, where: str) -> Distribution:
        """Value that `raw` stands for (`Value.read`)."""
        distribution: Distribution
        match = _FORM.fullmatch(raw) if isinstance(raw, str) else None
        if match is not None:
            first, second = (
                parse_quantity(text.strip(), self.dimension, where) for text in match.groups()[1:]
            )
            distribution = Normal(first, second) if match[1] == "normal" else Uniform(first, second)
            if isinstance(distribution, Normal) and distribution.deviation < 0.0:
                raise QuantityError(f"{where}: {raw}: the deviation must be zero or positive")
            if isinstance(distribution, Uniform) and distribution.high < distribution.low:
                raise QuantityError(f"{where}: {raw}: the lower end comes first")
        elif isinstance(raw, str) and "(" in raw:
            raise QuantityError(
                f"{where}: {raw!r} is not a distribution",
                hint="Write normal(MEAN, DEVIATION), uniform(LOW, HIGH) or one quantity.",
            )
        else:
            distribution = Constant(parse_quantity(raw, self.dimension, where))
        for end, limit, sense in (
            (distribution.at(0.0), self.least, -1.0),
            (distribution.at(1.0), self.most, 1.0),
        ):
            if sense * (end - limit) > 0.0:
                reached, bound = (format_quantity(value, self.unit) for value in (end, limit))
                raise QuantityError(
                    f"{where}: {raw} reaches {reached}, beyond {bound}",
                    hint="Make it narrower; a normal distribution is cut off at three deviations.",
                )
        return distribution


_RELATIVE_MAX = 0.9
"""Largest relative error; a larger one could leave nothing of a mass or a motor."""

_ANGLE_MAX = pi / 4
"""Largest misalignment of a mount or a sensor [rad]; more was meant in degrees."""

_RELATIVE = Spread(Dimension.RATIO, "%", -_RELATIVE_MAX, _RELATIVE_MAX)
_ANGLE = Spread(Dimension.ANGLE, "deg", -_ANGLE_MAX, _ANGLE_MAX)
_RATE = Spread(Dimension.ANGULAR_SPEED, "deg/s")

EACH_WHEEL = ("wheel",)
"""Parts of a quantity that is sampled once for each wheel."""

_SPACE, _TILT = ("x", "y", "z"), ("roll", "pitch")


@dataclass(frozen=True, kw_only=True)
class UncertaintySection:
    """`[reality]`: distributions that `validate --samples` samples from; None: the default."""

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
        "relative error of all of the robot's masses, the same for each",
        why="If you weighed the robot: the error of the scales.",
    )
    inertia_error: Distribution | None = keyed(
        replace(_RELATIVE, parts=_SPACE),
        "relative error of the trunk's second moments of mass along x, y and z",
        why="Typically 5 % from CAD, 1 % from a pendulum test.",
    )
    com_error: Distribution | None = keyed(
        Spread(Dimension.LENGTH, "mm", parts=_SPACE),
        "error of the trunk's centre of mass along x, y and z",
        why="Batteries and cables are seldom where CAD has them.",
    )
    incidence_error: Distribution | None = keyed(
        replace(_ANGLE, parts=EACH_WHEEL),
        "error of each wheel's incidence angle",
        why="Play and tolerance of the mounts.",
    )
    torque_constant_error: Distribution | None = keyed(
        replace(_RELATIVE, parts=EACH_WHEEL),
        "relative error of each motor's torque constant",
        why="Makers specify 5 to 10 % at most.",
    )
    resistance_error: Distribution | None = keyed(
        replace(_RELATIVE, parts=EACH_WHEEL),
        "relative error of each motor's resistance",
        why="It rises by 0.4 % for each degree of the winding.",
    )
    bus_voltage_error: Distribution | None = keyed(
        _RELATIVE,
        "relative error of the supply voltage",
        why="From a full battery to one that needs charging.",
    )
    coulomb_friction: Distribution | None = keyed(
        Spread(Dimension.TORQUE, "mN m", 0.0, parts=EACH_WHEEL),
        "friction torque of each wheel at any speed",
        why="Measure it: run the wheel down.",
        default="half of the motor's no-load torque",
        example='"5 mN m"',
    )
    viscous_friction: Distribution | None = keyed(
        Spread(Dimension.DAMPING, "uN m s/rad", 0.0, parts=EACH_WHEEL),
        "friction torque of each wheel over its speed",
        why="Measure it in the same run, at speed.",
        default="the other half of the no-load torque, at no-load speed",
        example='"3 uN m s/rad"',
    )
    air_drag: Distribution | None = keyed(
        Spread(Dimension.RATIO, "%", 0.0),
        "air drag of the wheels, relative to the formulas",
        why="0: a vacuum, as on the Moon.",
    )
    torque_delay: Distribution | None = keyed(
        Spread(Dimension.TIME, "ms", 0.0, 0.1),
        "delay from measurement to torque, whole milliseconds",
        why="Bus, filters and the motor's own controller.",
    )
    attitude_noise: Distribution | None = keyed(
        Spread(Dimension.ANGLE, "deg", 0.0, _ANGLE_MAX),
        "standard deviation of each measurement of attitude",
        why="See the data sheet of your inertial sensor.",
    )
    attitude_bias: Distribution | None = keyed(
        replace(_ANGLE, parts=_TILT),
        "constant error of measured roll and pitch",
        why="The main cause of landings off level.",
    )
    gyro_noise: Distribution | None = keyed(
        Spread(Dimension.ANGULAR_SPEED, "deg/s", 0.0),
        "standard deviation of each measured rate",
        why="Noise density times the square root of the bandwidth.",
    )
    gyro_bias: Distribution | None = keyed(
        replace(_RATE, parts=_SPACE),
        "constant error of the measured rates about x, y and z",
        why="The residual after calibration.",
    )
    contact_friction: Distribution | None = keyed(
        Spread(Dimension.RATIO, "%", 0.01),
        "friction coefficient between feet and floor",
        why="Of your feet on your floor.",
    )
    takeoff_rate: Distribution | None = keyed(
        replace(_RATE, parts=_TILT),
        "rates about roll and pitch after a push-off, beyond the planned ones",
        why="Film jumps without the device to measure it; 0: legs as planned.",
    )


def parts_of(key: str, wheels: Sequence[str]) -> tuple[str, ...]:
    """Components for which a key is sampled independently; `("",)` where it is sampled once.

    Args:
        key: of `[reality]`. wheels: names of the device's modules.
    """
    parts = spreads()[key].parts
    return tuple(wheels) if parts == EACH_WHEEL else parts


DEFAULTS = Path(__file__).with_name("reality.toml")
"""File of the default distributions."""

_FILE = TextKind(
    "file of distributions", 1 << 16, 1000, "check --reality", 'mass_error = "normal(0, 2%)"'
)

FRICTION_SHARE = 0.01
"""No-load torque over torque limit of a motor without a published no-load current."""


@dataclass(frozen=True)
class Entry:
    """One distribution of a file.

    Attributes:
        value: the distribution, relative to `of` unless that is empty.
        of: one of `_SCALES`, or empty. source: of the value.
    """

    value: Distribution
    of: str = ""
    source: str = ""

    def words(self, spread: Spread) -> str:
        """Text such as `normal(0%, 1%) of standing height`."""
        unit = "%" if self.of else spread.unit
        text = self.value.written(lambda number: format_quantity(number, unit))
        return f"{text} of {self.of}" if self.of else text


def entries(file: Path = DEFAULTS) -> Mapping[str, Entry]:
    """Entry of every key: from `file`, or from the package's own where that has none.

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
    # A file may be edited between two calls, but a pipe can be read only once.
    return MappingProxyType({**own, **(_read_entries(file) if plain else _entries_once(file))})


@cache
def _entries_once(file: Path) -> Mapping[str, Entry]:
    """Entries of a file, which is read on the first call only."""
    return _read_entries(file)


def _read_entries(file: Path) -> Mapping[str, Entry]:
    """Entries in a file, by key; see `entries`."""
    content = _FILE.parse_toml(_FILE.read(file), str(file))
    faults, entry_of_key = Faults(), {}
    for name in sorted(content.keys() - {"reality"}):
        faults.unknown(name, name, ("reality",))
    for name, raw in faults.table(content.get("reality", {}), "reality").items():
        where, spread = f"reality.{name}", spreads().get(name)
        specified = raw if isinstance(raw, dict) else {"value": raw, "source": str(file)}
        if spread is None:
            faults.unknown(where, name, tuple(spreads()))
            continue
        for key in sorted(specified.keys() - _ENTRY_KEYS):
            faults.unknown(f"{where}.{key}", key, _ENTRY_KEYS)
        texts = {key: str(specified.get(key, "")) for key in _ENTRY_KEYS[1:]}
        if texts["of"] and texts["of"] not in _SCALES:
            faults.unknown(f"{where}.of", texts["of"], _SCALES)
        how = Spread(Dimension.RATIO, "%") if texts["of"] else spread
        if "value" not in specified:
            faults.append(f"{where}.value: is missing")
            continue
        value = faults.read(how, specified["value"], where)
        if value is not None:
            entry_of_key[name] = Entry(value, **texts)
    if faults:
        raise SpecificationError(f"{file} has faults:", problems=faults)
    return MappingProxyType(entry_of_key)


_ENTRY_KEYS = ("value", "of", "source")
_SCALES = ("standing height", "pendulum rate", "no-load torque", "no-load friction")


def no_load_torque(motor: Drive) -> float:
    """Torque that a motor needs to turn freely, at its wheel [N m]; 0 if not known."""
    if motor.no_load_current is not None and motor.torque_constant is not None:
        return motor.gear_ratio * motor.torque_constant * motor.no_load_current
    return FRICTION_SHARE * (motor.torque_limit or 0.0)


def default_uncertainty(
    standing_height: float, motor: Drive | None = None, file: str | None = None
) -> UncertaintySection:
    """Distributions that apply by default.

    Args:
        standing_height: of the robot [m].
        motor: that turns the wheels; None: their friction is left open.
        file: in place of the package's own; None: the package's own.

    Raises:
        SpecificationError: see `entries`; or a distribution exceeds its limits.
    """
    scales = {
        "standing height": standing_height,
        "pendulum rate": sqrt(STANDARD_GRAVITY / standing_height) if standing_height else 0.0,
    }
    if motor is not None:
        speed = motor.no_load_speed
        if motor.rated_voltage and motor.bus_voltage:
            speed *= motor.rated_voltage / motor.bus_voltage
        torque = no_load_torque(motor)
        scales |= {"no-load torque": torque, "no-load friction": torque / speed}
    faults = Faults()
    distributions: dict[str, Any] = {}
    for name, entry in entries(DEFAULTS if file is None else Path(file)).items():
        if not entry.of:
            distributions[name] = entry.value
        elif entry.of in scales:
            text = entry.value.times(scales[entry.of]).written()
            distributions[name] = faults.read(spreads()[name], text, f"reality.{name}")
    if faults:
        raise SpecificationError(f"{file or DEFAULTS} has faults:", problems=faults)
    return UncertaintySection(**distributions)


def complete_uncertainty(
    specified: UncertaintySection, standing_height: float, motor: Drive
) -> UncertaintySection:
    """Specified distributions, and for the rest those of their file or of the package.

    Args:
        specified: by the user. standing_height: of the robot [m]. motor: that turns the wheels.

    Raises:
        SpecificationError: see `default_uncertainty`.
    """
    default = default_uncertainty(standing_height, motor, specified.file)
    return replace(
        default, **{name: getattr(specified, name) or getattr(default, name) for name in spreads()}
    )


def uncertainty_texts(section: UncertaintySection) -> Mapping[str, str]:
    """Specified distributions by key, as in `design.json`: SI, with full precision."""
    specified = {name: getattr(section, name) for name in spreads()}
    return {name: spread.written() for name, spread in specified.items() if spread is not None}


def uncertainty_of_texts(texts: Mapping[str, str], where: str) -> UncertaintySection:
    """The section of these texts; messages call their source `where`.

    Raises:
        OcsError: one is not a distribution, or its key is unknown.
    """
    faults = Faults()
    read = faults.fields(texts, spreads(), f"{where}: reality")
    if faults:
        raise SpecificationError(f"{where} has distributions that cannot be read:", problems=faults)
    return UncertaintySection(**read)


@cache
def spreads() -> Mapping[str, Spread]:
    """Parser of each distribution, by key."""
    how = {name: key.value for name, key in keys_of(UncertaintySection).items()}
    return {name: value for name, value in how.items() if isinstance(value, Spread)}
