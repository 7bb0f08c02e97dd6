"""What stands between a motor and its wheel."""

from dataclasses import dataclass


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
)
"""No gear."""
