"""How a module's inertia is shared between the body that turns and the one that stands still.

Braked, a module is its rim and its carrier, the rotor held still within the motor. Turning, the
wheel's body carries all momentum about the spin axis, the rotor's through the gear included: h =
I_rim + s N J_r. So the carrier's body gives up s N J_r, and the sum stays what the scales and a
pendulum would say of the braked module. For direct drive this is the rotor itself; behind a gear
the carrier keeps J_r - s N J_r of it, and the joint's armature holds the rest of its energy.
"""

from dataclasses import dataclass

from ocs_design.design import Device

_MOST = 0.99
"""Of its axial inertia that a carrier may give up: what is left must be a body that can exist.

Beyond that, with a light motor behind a high gear, the files have more inertia than the module.
"""


@dataclass(frozen=True)
class Inertial:
    """A body of revolution about z, its centre of mass at the origin.

    Attributes:
        mass: [kg]. axial_inertia, transverse_inertia: about z and across it [kg m^2].
    """

    mass: float
    axial_inertia: float
    transverse_inertia: float


def flywheel_inertial(device: Device) -> Inertial:
    """Of a wheel with what its rotor adds: a disc's, half as much across the axis as about it.

    Without that half a thin rim with a rotor would have more inertia about its axis than a flat
    body can have, and simulators refuse it.
    """
    wheel, rotor = device.flywheel, device.motor.rotor_inertia
    return Inertial(wheel.mass, wheel.spin_inertia, wheel.transverse_inertia + 0.5 * rotor)


def carrier_inertial(device: Device) -> Inertial | None:
    """Of what stands still, without what the wheel's body has of the rotor; None if massless."""
    carrier = device.carrier
    if carrier.mass == 0.0:
        return None
    rotor = min(device.motor.rotor_inertia, _MOST * carrier.axial_inertia)
    axial, transverse = carrier.axial_inertia - rotor, carrier.transverse_inertia - 0.5 * rotor
    # A motor of unknown length is a thin disc, which rounding must not make flatter than flat.
    return Inertial(carrier.mass, axial, max(transverse, 0.5 * axial))
