"""The section `[reality]`: how what is built and met differs from what was designed, key by key.

Drawn by the inverse of its distribution function from one number between 0 and 1: then another
distribution of one quantity leaves what is drawn of the others as it was.
"""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from functools import cache
from math import pi
from statistics import NormalDist
from types import MappingProxyType
from typing import Annotated, get_args, get_type_hints

from ocs_design.common.errors import QuantityError, SpecificationError
from ocs_design.common.units import Dimension, format_quantity, parse_quantity
from ocs_design.requirement.values import Faults, Key, Quantity, Value

CUT = 3.0
"""Standard deviations at which a normal distribution ends: no part is off by ten."""

_STANDARD = NormalDist()
_TAIL = _STANDARD.cdf(-CUT)


class Distribution(ABC):
    """Distribution of one quantity (SI)."""

    @abstractmethod
    def at(self, part: float) -> float:
        """The value that a `part` of all, 0..1, lie below."""

    @abstractmethod
    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """Text such as `normal(0.0, 0.01)`, each number as `quantity` writes it."""


@dataclass(frozen=True)
class Constant(Distribution):
    """Always the same."""

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
    """Between two ends, `low <= high`."""

    low: float
    high: float

    def at(self, part: float) -> float:
        """Linear."""
        return self.low + part * (self.high - self.low)

    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """Text of the distribution (`Distribution.written`)."""
        return f"uniform({quantity(self.low)}, {quantity(self.high)})"


@dataclass(frozen=True)
class Normal(Distribution):
    """Normal distribution, cut off at `CUT` standard deviations."""

    mean: float
    deviation: float

    def at(self, part: float) -> float:
        """The inverse of the cut normal distribution function."""
        return self.mean + self.deviation * _STANDARD.inv_cdf(_TAIL + part * (1.0 - 2.0 * _TAIL))

    def written(self, quantity: Callable[[float], str] = repr) -> str:
        """Text of the distribution (`Distribution.written`)."""
        return f"normal({quantity(self.mean)}, {quantity(self.deviation)})"


_FORM = re.compile(r"\s*(normal|uniform)\s*\(([^,()]*),([^,()]*)\)\s*")


@dataclass(frozen=True)
class Spread(Value[Distribution]):
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

    mass_error: Annotated[
        Distribution | None, Key(_RELATIVE, "relative, of all of the robot's masses alike")
    ] = None
    inertia_error: Annotated[
        Distribution | None,
        Key(_RELATIVE, "relative, of the trunk's second moments of mass along x, y and z"),
    ] = None
    com_error: Annotated[
        Distribution | None,
        Key(Spread(Dimension.LENGTH, "mm"), "of the trunk's centre of mass along x, y and z"),
    ] = None
    incidence_error: Annotated[
        Distribution | None, Key(_ANGLE, "of each wheel's incidence angle")
    ] = None
    torque_constant_error: Annotated[
        Distribution | None, Key(_RELATIVE, "relative, of each motor's torque constant")
    ] = None
    resistance_error: Annotated[
        Distribution | None, Key(_RELATIVE, "relative, of each motor's resistance")
    ] = None
    bus_voltage_error: Annotated[
        Distribution | None, Key(_RELATIVE, "relative, of the supply's voltage")
    ] = None
    coulomb_friction: Annotated[
        Distribution | None,
        Key(Spread(Dimension.TORQUE, "mN m", 0.0), "of each wheel at any speed"),
    ] = None
    viscous_friction: Annotated[
        Distribution | None,
        Key(Spread(Dimension.DAMPING, "uN m s/rad", 0.0), "of each wheel, over its speed"),
    ] = None
    air_drag: Annotated[
        Distribution | None,
        Key(Spread(Dimension.RATIO, "%", 0.0), "of the wheels, over what the formulas say"),
    ] = None
    torque_delay: Annotated[
        Distribution | None,
        Key(
            Spread(Dimension.TIME, "ms", 0.0, 0.1), "from measurement to torque, whole milliseconds"
        ),
    ] = None
    attitude_noise: Annotated[
        Distribution | None,
        Key(_ANGLE_SPREAD, "standard deviation of each measurement of attitude"),
    ] = None
    attitude_bias: Annotated[
        Distribution | None, Key(_ANGLE, "constant error of measured roll and pitch")
    ] = None
    gyro_noise: Annotated[
        Distribution | None,
        Key(_RATE_SPREAD, "standard deviation of each measured rate"),
    ] = None
    gyro_bias: Annotated[
        Distribution | None, Key(_RATE, "constant error of the measured rates about x, y and z")
    ] = None
    contact_friction: Annotated[
        Distribution | None,
        Key(Spread(Dimension.RATIO, "%", 0.01), "coefficient between feet and floor"),
    ] = None


_COM_SHARE = 0.01
"""Standard deviation of the trunk's centre of mass over the standing height."""


_DEFAULTS: Mapping[str, str] = MappingProxyType(
    {
        "mass_error": "normal(0, 2%)",
        "inertia_error": "normal(0, 5%)",
        "incidence_error": "normal(0, 0.5deg)",
        "torque_constant_error": "normal(0, 3%)",
        "resistance_error": "normal(0, 5%)",
        "bus_voltage_error": "uniform(-5%, 10%)",
        "air_drag": "uniform(80%, 120%)",
        "torque_delay": "uniform(1ms, 3ms)",
        "attitude_noise": "0.1deg",
        "attitude_bias": "normal(0, 0.4deg)",
        "gyro_noise": "0.05deg/s",
        "gyro_bias": "normal(0, 0.04deg/s)",
        "contact_friction": "uniform(0.5, 1)",
    }
)
"""Those that depend on neither robot nor motor (docs/monte_carlo.md, What is drawn)."""


def default_uncertainty(standing_height: float) -> UncertaintySection:
    """What holds where nothing is stated; friction is left open, for it is the motor's.

    Args:
        standing_height: of the robot [m].
    """
    given = uncertainty_of_texts(_DEFAULTS, "default")
    return replace(given, com_error=Normal(0.0, _COM_SHARE * standing_height))


def uncertainty_texts(section: UncertaintySection) -> Mapping[str, str]:
    """What is stated, by key, as `design.json` keeps it: SI, to the last bit."""
    stated = {name: getattr(section, name) for name in spreads()}
    return {name: spread.written() for name, spread in stated.items() if spread is not None}


def uncertainty_of_texts(texts: Mapping[str, str], where: str) -> UncertaintySection:
    """The section that texts say; `where` says whose they are.

    Raises:
        OcsError: one is no distribution, or of no key.
    """
    known, faults = spreads(), Faults()
    for name in sorted(texts.keys() - known.keys()):
        faults.unknown(f"{where}: reality.{name}", name, tuple(known))
    read = {
        name: faults.read(known[name], text, f"{where}: reality.{name}")
        for name, text in texts.items()
        if name in known
    }
    if faults:
        raise SpecificationError(f"{where} states what cannot be read:", problems=faults)
    return UncertaintySection(**read)


@cache
def spreads() -> Mapping[str, Spread]:
    """How each key is read."""
    hints = get_type_hints(UncertaintySection, include_extras=True)
    return {item.name: get_args(hints[item.name])[1].value for item in fields(UncertaintySection)}
