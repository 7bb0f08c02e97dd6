"""The specification that holds for a robot where nothing at all is stated."""

from ocs_design.requirement.envelope import LIMIT_OF_KEY
from ocs_design.requirement.froude import (
    default_bus_voltage,
    default_envelope,
    default_maneuvers,
    standing_height,
)
from ocs_design.requirement.maneuver import STANDARD_GRAVITY
from ocs_design.requirement.reality import default_reality
from ocs_design.requirement.specification import (
    AUTO,
    BALANCING_DEPTH,
    BALANCING_DIAMETER,
    CHAMFER,
    CONTROL_PERIOD,
    DISC,
    LIGHTEST,
    PROJECTIONS,
    FlywheelSection,
    MotorSection,
    OcsSection,
    RequirementSection,
    RobotSection,
    Specification,
    ValidationSection,
)
from ocs_design.robot.robot import Robot


def default_specification(
    robot: Robot, *, kp: float, kd: float, gravity: float = STANDARD_GRAVITY
) -> Specification:
    """What `resolve` fills in for `robot`, as if a user had stated it.

    Keys that have no default, or whose default is found while sizing, are None.

    Args:
        robot: to scale to.
        kp, kd: gains of the wheel law [1/s^2, 1/s].
        gravity: of the maneuvers on Earth [m/s^2].
    """
    envelope = default_envelope(robot)
    return Specification(
        robot=RobotSection(posture=robot.posture_name),
        requirement=RequirementSection(gravity=STANDARD_GRAVITY, maneuvers="paper"),
        ocs=OcsSection(alpha_criterion=LIGHTEST, co_design=False),
        flywheel=FlywheelSection(
            material=AUTO,
            web=DISC,
            chamfer=CHAMFER,
            balancing_holes=0,
            balancing_hole_diameter=BALANCING_DIAMETER,
            balancing_hole_depth=BALANCING_DEPTH,
            **{key: getattr(envelope, limit) for key, limit in LIMIT_OF_KEY.items()},
        ),
        motor=MotorSection(name=AUTO, gear=AUTO, bus_voltage=default_bus_voltage(robot)),
        validation=ValidationSection(
            enabled=True,
            projection=PROJECTIONS[0],
            kp=kp,
            kd=kd,
            ballistic=False,
            seed=0,
            control_period=CONTROL_PERIOD,
            desaturate=False,
            video=False,
        ),
        reality=default_reality(standing_height(robot)),
        maneuvers=default_maneuvers(robot, gravity),
    )
