"""Vibration modes of the supports of a device's modules, which the wheel speeds may pass."""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from ocs_design.device.device import Device
from ocs_design.device.joints import balance_of
from ocs_design.parts.carrier_plate import CarrierPlate
from ocs_design.parts.dog_bone import directions
from ocs_design.parts.foot import stem_frequency
from ocs_design.parts.pedestal import seat_compliance
from ocs_design.parts.plate_strength import plate_frequency, plate_sway, plate_tilt
from ocs_design.parts.printed import PETG

DAMPING = 0.01
"""Assumed damping ratio of feet and plates: bolted steelwork has 0.008 (EN 1991-1-4, table F.2,
logarithmic decrement 0.05), and printed parts have more."""


@dataclass(frozen=True)
class Resonance:
    """A vibration mode of a module's support, which its wheel's speed may pass.

    Attributes:
        name: what bends. frequency: [Hz].
        force: of the unbalance permitted by its balance grade, at this frequency [N].
        amplitude: of the module if the wheel stays at this frequency, limited only by `DAMPING`
            [m].
    """

    name: str
    frequency: float
    force: float
    amplitude: float

    @property
    def acceleration(self) -> float:
        """Acceleration of the module at that amplitude [m/s^2]."""
        return (2.0 * pi * self.frequency) ** 2 * self.amplitude

    def acceleration_at(self, speed: float) -> float:
        """Acceleration of the module [m/s^2] if its wheel stays at a speed [rad/s].

        The amplitude due to an unbalance is r^2 / sqrt((1 - r^2)^2 + (2 zeta r)^2) U / m, r = w /
        w_0.
        """
        ratio_squared = (speed / (2.0 * pi * self.frequency)) ** 2
        amplification = ratio_squared / sqrt(
            (1.0 - ratio_squared) ** 2 + 4.0 * DAMPING**2 * ratio_squared
        )
        return speed**2 * 2.0 * DAMPING * self.amplitude * amplification


def resonances_of(device: Device) -> tuple[Resonance, ...]:
    """First modes of a module's support that a wheel passes on its way to top speed.

    At resonance, a force U w^2 moves a mass m on a spring by U / (2 zeta m), regardless of the
    stiffness. The whole unbalance excites the plate, vertically in bending and across the wheel's
    axis in torsion; it excites the stem only by its moment: at the end of a cantilever of length L,
    a moment M acts like the force 3 M / 2 L. Gyroscopic moments of the turning wheel are neglected.
    A pedestal's seat is excited by the whole unbalance.
    """
    if device.wheels_alone:
        return ()
    foot, mass = device.foot, device.module_mass
    lever = 1.5 * (foot.back - device.foot_plate / 2.0) / (foot.wheel_height - foot.base)
    modes = [("foot", foot_frequency(device), lever)]
    if device.pedestals:
        compliance = max(seat_compliance(pedestal)[0] for pedestal in device.pedestals)
        modes.insert(0, ("pedestal", 1.0 / (2.0 * pi * sqrt(compliance * mass)), 1.0))
    if device.plate is not None:
        modes.insert(0, ("plate", plate_frequency(device.plate, mass), 1.0))
        modes.append(("twisted plate", _twisted_frequency(device, device.plate), 1.0))
        if device.plate.mast is None and device.plate.arms == 2:
            sleeved = plate_sway(device.plate, mass, foot.wheel_height)
            modes.insert(1, ("sleeve", sleeved, 1.0))
    unbalance = balance_of(device).unbalance
    return tuple(
        Resonance(
            name,
            frequency,
            share * unbalance * (2.0 * pi * frequency) ** 2,
            share * unbalance / (2.0 * DAMPING * mass),
        )
        for name, frequency, share in modes
        if 2.0 * pi * frequency < device.motor.top_speed
    )


def foot_frequency(device: Device, modulus: float = PETG.modulus) -> float:
    """First mode of a module along its wheel's axis, on its foot and the foot's support [Hz].

    The plate, or a pedestal's seat, turns under the stem: the inverse square of their common
    frequency is the sum of those of each alone (Dunkerley, a lower bound).

    Args:
        device: with modules. modulus: of the feet's material [Pa].
    """
    foot, carrier = device.foot, device.carrier
    mass = device.module_mass
    inertia = device.flywheel.transverse_inertia + float(carrier.inertia[0, 0])
    inverse_square = stem_frequency(foot, mass, inertia, modulus) ** -2
    if device.pedestals:
        along = max(seat_compliance(pedestal)[1] for pedestal in device.pedestals)
        inverse_square += (2.0 * pi) ** 2 * along * mass
    if device.plate is not None:
        tilt, _ = _foot_compliances(device, device.plate)
        arm = foot.wheel_height + device.plate.thickness / 2.0
        inverse_square += (2.0 * pi) ** 2 * tilt * (mass * arm**2 + inertia)
    return 1.0 / sqrt(inverse_square)


def _twisted_frequency(device: Device, plate: CarrierPlate) -> float:
    """First mode of a module across its wheel's axis, on a plate that turns under its foot [Hz].

    The wheel does not rotate with it about its own axis.
    """
    foot, carrier = device.foot, device.carrier
    mass, inertia = device.module_mass, float(carrier.inertia[1, 1])
    _, tilt = _foot_compliances(device, plate)
    arm = foot.wheel_height + plate.thickness / 2.0
    stem = stem_frequency(foot, mass, inertia, in_plane=True)
    return 1.0 / sqrt(stem**-2 + (2.0 * pi) ** 2 * tilt * (mass * arm**2 + inertia))


def _foot_compliances(device: Device, plate: CarrierPlate) -> tuple[float, float]:
    """Largest rotation of a foot on its plate per moment [rad/(N m)], about two axes.

    About the horizontal across its wheel's axis, as for a push along the axis, and about the axis
    itself; a moment partly bends and partly twists an arm.
    """
    bending, torsion = plate_tilt(plate)
    arms = np.resize(directions(plate.arms), (len(device.modules), 2))
    axes = np.array([module.axis[:2] for module in device.modules])
    along = (axes * arms).sum(axis=1) ** 2 / (axes**2).sum(axis=1)
    across, about_axis = bending * along, torsion * along
    return (
        float((across + torsion * (1.0 - along)).max()),
        float((about_axis + bending * (1.0 - along)).max()),
    )
