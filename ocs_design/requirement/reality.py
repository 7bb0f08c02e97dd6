"""`[reality]`: how what is built and met differs from what was designed, key by key."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cache
from math import pi
from types import MappingProxyType
from typing import Annotated, get_args, get_type_hints

from ocs_design.exceptions import SpecificationError
from ocs_design.requirement.distributions import Distribution, Normal
from ocs_design.requirement.faults import Faults
from ocs_design.requirement.key import Key
from ocs_design.requirement.spread import Spread
from ocs_design.units import Dimension

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
class RealitySection:
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
        Key(
            _ANGLE_SPREAD,
            "standard deviation of each measurement of attitude",
        ),
    ] = None
    attitude_bias: Annotated[
        Distribution | None, Key(_ANGLE, "constant error of measured roll and pitch")
    ] = None
    gyro_noise: Annotated[
        Distribution | None,
        Key(
            Spread(Dimension.ANGULAR_SPEED, "deg/s", 0.0),
            "standard deviation of each measured rate",
        ),
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


def default_reality(standing_height: float) -> RealitySection:
    """What holds where nothing is stated; friction is left open, for it is the motor's.

    Args:
        standing_height: of the robot [m].
    """
    given = reality_of_texts(_DEFAULTS, "default")
    return replace(given, com_error=Normal(0.0, _COM_SHARE * standing_height))


def reality_texts(section: RealitySection) -> Mapping[str, str]:
    """What is stated, by key, as `design.json` keeps it: SI, to the last bit."""
    stated = {name: getattr(section, name) for name in spreads()}
    return {name: spread.written() for name, spread in stated.items() if spread is not None}


def reality_of_texts(texts: Mapping[str, str], where: str) -> RealitySection:
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
    return RealitySection(**read)


@cache
def spreads() -> Mapping[str, Spread]:
    """How each key is read."""
    hints = get_type_hints(RealitySection, include_extras=True)
    return {item.name: get_args(hints[item.name])[1].value for item in fields(RealitySection)}
