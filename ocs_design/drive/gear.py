"""What stands between a motor and its wheel."""

from dataclasses import dataclass


@dataclass(frozen=True)
class GearRoom:
    """What a stage takes between the plate behind a wheel and the motor; 0: not known.

    Attributes:
        depth: along the wheel's axis [m].
        offset: of the motor's axis from the wheel's [m].
        wheel_radius, motor_radius: of what turns with the wheel and with the motor [m]; of a stage
            on one axis the same.
        center: of its mass, from the wheel's axis towards the motor's [m].
    """

    depth: float = 0.0
    offset: float = 0.0
    wheel_radius: float = 0.0
    motor_radius: float = 0.0
    center: float = 0.0


@dataclass(frozen=True)
class Gear:
    """One stage with a fixed ratio; a stage that may have any ratio is one `Gear` per ratio.

    Attributes:
        name: in the catalogue; "direct" for none.
        ratio: N, motor speed over wheel speed; below 1 the wheel turns faster than the motor.
        efficiency: of the torque, 0..1, taken as a loss in both directions.
        mass: of the whole stage [kg].
        inertia: of its turning parts, seen at the wheel [kg m^2].
        motor_speed_max, wheel_speed_max: of its input and its output [rad/s]; inf: not limited.
        torque_max: at its output, short-term [N m]; inf: not limited.
        reverses: whether the wheel turns against the motor, as behind a pair of spur gears.
        source: where the figures come from.
        room: that it takes; None: there is no gear.
    """

    name: str
    ratio: float
    efficiency: float
    mass: float
    inertia: float
    motor_speed_max: float
    wheel_speed_max: float
    torque_max: float
    reverses: bool
    source: str
    room: GearRoom | None = GearRoom()


DIRECT = Gear(
    name="direct",
    ratio=1.0,
    efficiency=1.0,
    mass=0.0,
    inertia=0.0,
    motor_speed_max=float("inf"),
    wheel_speed_max=float("inf"),
    torque_max=float("inf"),
    reverses=False,
    source="the wheel sits on the motor's shaft",
    room=None,
)
"""No gear."""
