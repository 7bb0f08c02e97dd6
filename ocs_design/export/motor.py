"""What exported files say of the motor."""

from ocs_design.design import Motor


def largest_torque(motor: Motor) -> float | None:
    """What the motor gives at rest [N m]; None if it is not limited."""
    limits = [limit for limit in (motor.torque_limit, motor.stall_torque) if limit is not None]
    return min(limits, default=None)
