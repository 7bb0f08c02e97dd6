"""The other construction of a wheel: a ring around the bell of an outrunner, bonded on.

No web, no hub, no joint on a shaft, and a flat module, as Mini Wheelbot has it with brass around an
MN4006 (github.com/wheelbot/Mini-Wheelbot, hardware/how-to-assemble-motors.md). A ring as tall as
the straight part of the bell stands nearer to the axis than a rim on a web, and is heavier:

    R^4 = r^4 + 2 I / (pi rho h),    m = 2 I / (R^2 + r^2).
"""

from dataclasses import dataclass
from math import pi

from ocs_design.actuation.motor import DIRECT, Face
from ocs_design.device.device import Device

GLUE_GAP = 0.1e-3
"""Gap between bell and ring [m]: what epoxy fills and a printed fixture keeps even."""

BELL_SHARE = 0.45
"""Straight part of a bell over its motor's length: 11 of the 25 mm of an MN5006."""


@dataclass(frozen=True)
class BellRing:
    """A ring around a bell, with the spin inertia of a wheel.

    Attributes:
        inner_radius, outer_radius, height: [m].
        mass: [kg].
        beyond: mass more than that of the wheel that it stands for [kg].
    """

    inner_radius: float
    outer_radius: float
    height: float
    mass: float
    beyond: float


def ring_size(
    spin_inertia: float, density: float, inner_radius: float, height: float
) -> tuple[float, float]:
    """Outer radius [m] and mass [kg] of a ring of that spin inertia [kg m^2]."""
    fourth = inner_radius**4 + 2.0 * spin_inertia / (pi * density * height)
    outer: float = fourth**0.25
    return outer, 2.0 * spin_inertia / (outer**2 + inner_radius**2)


def ring_on_bell(device: Device) -> BellRing | None:
    """Ring in place of each wheel; None: no bell turns outside, or its size is not known.

    Of the same material and spin inertia; housing and foot are not designed for it.
    """
    wheel, drive = device.flywheel, device.motor
    mounting, across, long = drive.mounting, drive.diameter, drive.length
    outside = mounting is not None and mounting.stator_face is Face.BACK
    if drive.gear != DIRECT.name or not outside or across is None or long is None:
        return None
    inner, height = across / 2.0 + GLUE_GAP, BELL_SHARE * long
    outer, mass = ring_size(wheel.spin_inertia - drive.rotor_inertia, wheel.density, inner, height)
    return BellRing(inner, outer, height, mass, beyond=mass - wheel.mass)
