"""Everything that is drawn: which quantities, how they are spread where nothing is stated."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import inf, isfinite
from types import MappingProxyType

from ocs_design.design import SIDES, Device, Motor
from ocs_design.requirement.distributions import Distribution, Uniform
from ocs_design.requirement.froude import standing_height
from ocs_design.requirement.reality import RealitySection, default_reality
from ocs_design.robot.robot import Robot

PARTS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "inertia_error": ("x", "y", "z"),
        "com_error": ("x", "y", "z"),
        "incidence_error": SIDES,
        "torque_constant_error": SIDES,
        "resistance_error": SIDES,
        "coulomb_friction": SIDES,
        "viscous_friction": SIDES,
        "attitude_bias": ("roll", "pitch"),
        "gyro_bias": ("x", "y", "z"),
    }
)
"""Keys of `[reality]` that are drawn more than once."""

KEYS = tuple(field.name for field in fields(RealitySection))
NAMES = tuple(f"{key}.{part}" if part else key for key in KEYS for part in PARTS.get(key, ("",)))
"""Every number that is drawn for a sample, in order."""

FRICTION_SHARE = 0.01
"""No-load torque over the torque limit of a motor whose maker does not state its current."""


@dataclass(frozen=True)
class Reality:
    """The distribution of every key of `[reality]`, nothing left open."""

    spreads: Mapping[str, Distribution]

    @classmethod
    def of(cls, stated: RealitySection, robot: Robot, device: Device) -> "Reality":
        """What is stated, and the defaults in place of the rest."""
        coulomb, viscous = _friction(device.motor)
        default = replace(
            default_reality(standing_height(robot)),
            coulomb_friction=coulomb,
            viscous_friction=viscous,
        )
        return cls({key: getattr(stated, key) or getattr(default, key) for key in KEYS})

    @property
    def by_name(self) -> Mapping[str, Distribution]:
        """Of every number that is drawn, in the order of `NAMES`."""
        return {name: self.spreads[key_of(name)] for name in NAMES}

    def written(self) -> Mapping[str, str]:
        """As text that tells any two apart, SI."""
        return {key: spread.written() for key, spread in self.spreads.items()}


def key_of(name: str) -> str:
    """The key of `[reality]` that one of `NAMES` is drawn from."""
    return name.partition(".")[0]


def no_load_torque(motor: Motor) -> float:
    """What a motor gives to turn freely, at its wheel [N m]; 0 where nothing is known of it."""
    if motor.no_load_current is not None and motor.torque_constant is not None:
        return motor.gear_ratio * motor.torque_constant * motor.no_load_current
    return FRICTION_SHARE * (motor.torque_limit or 0.0)


def _friction(motor: Motor) -> tuple[Distribution, Distribution]:
    """Coulomb and viscous: half of the no-load torque each, at the speed that it is stated for.

    How it divides is not in any data sheet; half to one and a half times that is drawn of each.
    """
    half = 0.5 * no_load_torque(motor)
    speed = motor.no_load_speed if isfinite(motor.no_load_speed) else inf
    if motor.rated_voltage and motor.bus_voltage:
        speed *= motor.rated_voltage / motor.bus_voltage
    return Uniform(0.5 * half, 1.5 * half), Uniform(0.5 * half / speed, 1.5 * half / speed)
