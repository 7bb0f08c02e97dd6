"""Bodies of the device in robot files: names, placements, inertia, and limits of motors.

With wheels braked, a module is its wheel and its carrier, the rotor at rest within the motor. With
wheels turning, the wheel's body carries all momentum about the spin axis, including the rotor's
through the gear: h = I_rim + s N J_r. So s N J_r is taken off the carrier's body, and the sum stays
that of the braked module, as scales and a pendulum would measure it. For direct drive this is the
rotor itself; with a gear the carrier keeps J_r - s N J_r of it, and the joint's armature accounts
for the rest of its energy.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ocs_design.actuation.drive import Drive
from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import RobotError
from ocs_design.common.frames import Placement, rotation_from_rpy
from ocs_design.device.device import Device, Module
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.robot.mass import MassProperties, combine

PREFIX = "ocs_"
PLATE = f"{PREFIX}plate"
"""Name of the plate that the feet stand on: link and fixed joint in URDF, body in MJCF."""

IMU = f"{PREFIX}imu"
"""Name of the site in MJCF at the base frame B."""

IMU_SENSORS = f"{IMU}_attitude", f"{IMU}_rate"
"""Names of the sensors in MJCF of B's attitude as a quaternion and of its rate [rad/s]."""

_FLYWHEEL = "_flywheel"

STEEL = (0.55, 0.57, 0.6, 1.0)
"""Colour of wheels: red, green, blue and opacity, 0..1."""

WHEEL_CONTACT_BIT = 1 << 16
"""`conaffinity` of the wheels in MJCF: a floor with this bit in its `contype` collides with
them."""

_LARGEST_SHARE = 0.99
"""Largest fraction of a carrier's axial inertia to take off: the rest must be physically possible.

Beyond that, with a light motor and a high gear ratio, the files have more inertia than the module.
"""

_DISC = np.diag([1.0, 0.0, 1.0])
"""Axes of the module's frame along which a rotor has second moments."""

_ROUNDING = 1e-12

_FROM_MODULE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Rotation from the left module's frame (axis along y) to its wheel's (axis along z)."""


def flywheel_name(module: Module) -> str:
    """Name of a module's wheel: link in URDF, body in MJCF."""
    return f"{PREFIX}{module.name}{_FLYWHEEL}"


def flywheels_among(bodies: Iterable[str]) -> list[str]:
    """Bodies of a robot that are wheels of the device, in their order."""
    return [name for name in bodies if name.startswith(PREFIX) and name.endswith(_FLYWHEEL)]


def joint_name(module: Module) -> str:
    """Name of a wheel's joint, and in MJCF also of its motor."""
    return f"{PREFIX}{module.name}"


def wheel_sensors(module: Module) -> tuple[str, str]:
    """Names of the sensors in MJCF of a wheel's speed [rad/s] and of its motor's torque [N m]."""
    return f"{joint_name(module)}_velocity", f"{joint_name(module)}_torque"


def require_free(kind: str, taken: Iterable[str], wanted: Iterable[str]) -> None:
    """Refuse a robot that already uses one of the device's names.

    Args:
        kind: kind of named element, for the message: link, joint, actuator.
        taken: the robot's own names.
        wanted: the device's.
    """
    clash = sorted(set(taken) & set(wanted))
    if clash:
        raise RobotError(
            f"the robot already has a {kind} named {clash[0]!r}, which the device needs",
            hint=f"rename that {kind} in the robot's file, or give the file without a device in it",
        )


def require_no_device(joints: Iterable[str]) -> None:
    """Refuse a robot that already has a device, judged by its joints, before another is sized."""
    names = (name for layout in LayoutName for name in Layout(layout).names)
    require_free("joint", joints, (f"{PREFIX}{name}" for name in names))


def flywheel_names(device: Device) -> tuple[str, ...]:
    """Names of the wheels, in the modules' order."""
    return tuple(flywheel_name(module) for module in device.modules)


def joint_names(device: Device) -> tuple[str, ...]:
    """Names of the wheels' joints, in the modules' order."""
    return tuple(joint_name(module) for module in device.modules)


def wheel_rpy(axis: FloatArray) -> tuple[float, float, float]:
    """Roll, pitch and yaw [rad] of the frame whose z axis is the unit vector `axis`.

    Of all such frames, the one without pitch: `z = Rz(yaw) Rx(roll) e_z = (sin(yaw) sin(roll),
    -cos(yaw) sin(roll), cos(roll))`, with roll in -pi..0. For the paper's axes roll is -90 degrees,
    and yaw is the incidence angle, negative on the left.
    """
    x, y, z = (float(value) for value in axis)
    return -float(np.arctan2(np.hypot(x, y), z)), 0.0, float(np.arctan2(-x, y))


def wheel_placement(module: Module) -> Placement:
    """Frame of the flywheel in the base frame B: at its centre, z along the spin axis."""
    return Placement(rotation_from_rpy(*wheel_rpy(module.axis)), module.position)


def carrier_placement(module: Module) -> Placement:
    """Frame of the carrier in the wheel's, the motor on the inner side.

    All modules have the same parts. In a pair the carrier's frame is the left wheel's own; in the
    right module it is rotated by half a turn about the vertical.
    """
    turn = wheel_placement(module).rotation.T @ module.frame @ _FROM_MODULE.T
    # Round half turns to the last digit.
    whole = np.round(turn)
    return Placement(np.where(np.abs(turn - whole) < _ROUNDING, whole, turn), np.zeros(3))


def largest_torque(motor: Drive) -> float | None:
    """Torque of the motor at rest [N m]; None if not limited."""
    limits = [limit for limit in (motor.torque_limit, motor.stall_torque) if limit is not None]
    return min(limits, default=None)


def flywheel_inertial(device: Device) -> MassProperties:
    """Wheel in its own frame, including its rotor as a disc, with half its inertia transversely.

    Without that half, a thin rim with a rotor would have more inertia about its axis than a flat
    body can have, and simulators would refuse it.
    """
    wheel, rotor = device.flywheel, device.motor.rotor_inertia
    transverse = wheel.transverse_inertia + 0.5 * rotor
    inertia = np.diag([transverse, transverse, wheel.spin_inertia])
    return MassProperties(wheel.mass, np.zeros(3), inertia)


def carrier_inertial(device: Device, module: Module) -> MassProperties | None:
    """Carrier (all stationary parts) in the frame of the module's wheel; None if massless.

    The part of the rotor's inertia that the wheel's body has is taken off.
    """
    carrier = device.carrier
    if carrier.mass == 0.0:
        return None
    second = np.trace(carrier.inertia) / 2.0 * np.eye(3) - carrier.inertia
    # A motor of unknown length is a thin disc, whose second moment must not become negative by
    # rounding.
    second[1, 1] = max(second[1, 1], 0.0)
    # Inertia of the largest rotor that may be taken off.
    tilt = second[1, 2] ** 2 / second[1, 1] if second[1, 1] > 0.0 else 0.0
    largest_rotor = float(2.0 * min(second[0, 0], second[2, 2] - tilt))
    second -= min(device.motor.rotor_inertia, _LARGEST_SHARE * largest_rotor) / 2.0 * _DISC
    inertia = np.trace(second) * np.eye(3) - second
    left = MassProperties(carrier.mass, carrier.mass_properties().com, inertia)
    turn = carrier_placement(module).rotation @ _FROM_MODULE
    return left.moved(turn, np.zeros(3))


@dataclass(frozen=True, eq=False)
class DeviceBody:
    """A body of the device in robot files.

    Attributes:
        name: of its link or body.
        own: mass properties in its own frame.
        position, rpy: of that frame in the base frame B [m], [rad].
        module: module that it belongs to; None: the plate or pedestals under all feet.
        joint: joint about its z axis; empty: fixed to the trunk.
    """

    name: str
    mass_properties: MassProperties
    position: FloatArray
    rpy: tuple[float, float, float]
    module: Module | None
    joint: str = ""

    @property
    def place(self) -> Placement:
        """Frame of the body in the base frame B."""
        return Placement(rotation_from_rpy(*self.rpy), self.position)


def device_bodies(device: Device) -> Iterator[DeviceBody]:
    """Wheel and carrier of each module, then plate or pedestals; massless bodies are omitted."""
    for module in device.modules:
        at, turn = module.position, wheel_rpy(module.axis)
        wheel = flywheel_inertial(device)
        yield DeviceBody(flywheel_name(module), wheel, at, turn, module, joint_name(module))
        carrier = carrier_inertial(device, module)
        if carrier is not None:
            yield DeviceBody(f"{joint_name(module)}_motor", carrier, at, turn, module)
    plate, level = device.plate, (0.0, 0.0, 0.0)
    if plate is not None:
        at = np.array(plate.position)
        yield DeviceBody(PLATE, plate.own_mass_properties(), at, level, None)
    elif device.pedestals:
        combined = combine(pedestal.mass_properties() for pedestal in device.pedestals)
        yield DeviceBody(PLATE, combined, np.zeros(3), level, None)
