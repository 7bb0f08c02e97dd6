"""How a module's inertia is shared between the body that turns and the one that stands still.

Braked, a module is its wheel and its carrier, the rotor held still within the motor. Turning, the
wheel's body carries all momentum about the spin axis, the rotor's through the gear included: h =
I_rim + s N J_r. So the carrier's body gives up s N J_r, and the sum stays what the scales and a
pendulum would say of the braked module. For direct drive this is the rotor itself; behind a gear
the carrier keeps J_r - s N J_r of it, and the joint's armature holds the rest of its energy.
"""

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import Device, Module
from ocs_design.export.standing import standing_turn
from ocs_design.robot.mass_properties import MassProperties

_MOST = 0.99
"""Of its axial inertia that a carrier may give up: what is left must be a body that can exist.

Beyond that, with a light motor behind a high gear, the files have more inertia than the module.
"""

_DISC = np.diag([1.0, 0.0, 1.0])
"""What a rotor has its second moments about, in the module's frame."""

_FROM_MODULE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From the left module's frame (y along its axis, z up) to that of its wheel (z along, y down)."""


def flywheel_inertial(device: Device) -> MassProperties:
    """Of a wheel in its own frame, with what its rotor adds: a disc's, half as much across.

    Without that half a thin rim with a rotor would have more inertia about its axis than a flat
    body can have, and simulators refuse it.
    """
    wheel, rotor = device.flywheel, device.motor.rotor_inertia
    across = wheel.transverse_inertia + 0.5 * rotor
    inertia = np.diag([across, across, wheel.spin_inertia])
    return MassProperties(wheel.mass, np.zeros(3), inertia)


def carrier_inertial(device: Device, module: Module) -> MassProperties | None:
    """Of what stands still in the frame of the module's wheel; None if massless.

    Without what the wheel's body has of the rotor.
    """
    carrier = device.carrier
    if carrier.mass == 0.0:
        return None
    second = np.trace(carrier.inertia) / 2.0 * np.eye(3) - carrier.inertia
    # A motor of unknown length is a thin disc, which rounding must not make flatter than flat.
    second[1, 1] = max(second[1, 1], 0.0)
    second -= min(device.motor.rotor_inertia, _MOST * _spare(second)) / 2.0 * _DISC
    inertia = np.trace(second) * np.eye(3) - second
    left = MassProperties(carrier.mass, carrier.mass_properties().com, inertia)
    turn = standing_turn(module).rotation @ _FROM_MODULE
    return left.moved(turn, np.zeros(3))


def _spare(second: FloatArray) -> float:
    """Inertia of the largest rotor that may be taken off these second moments [kg m^2]."""
    tilt = second[1, 2] ** 2 / second[1, 1] if second[1, 1] > 0.0 else 0.0
    return float(2.0 * min(second[0, 0], second[2, 2] - tilt))
