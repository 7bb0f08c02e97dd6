"""What exported files say of the motor."""

from ocs_design.design import Motor


def largest_torque(motor: Motor) -> float | None:
    """What the motor gives at rest [N m]; None if it is not limited."""
    limits = [limit for limit in (motor.torque_limit, motor.stall_torque) if limit is not None]
    return min(limits, default=None)


def highest_speed(motor: Motor) -> float:
    """That a wheel can have, by voltage or by its mechanics [rad/s]; inf: not limited."""
    if motor.speed_max is None:
        return motor.no_load_speed
    return min(motor.no_load_speed, motor.speed_max)
