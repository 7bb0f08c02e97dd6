"""Open points that keep a device from being built as designed, gathered from all checks."""

from collections.abc import Mapping, Sequence

from ocs_design.actuation.motor import Motor, build_gaps
from ocs_design.common.wording import listed, quantity, some_of
from ocs_design.device.joints import (
    FLOOR_SHOCK,
    FOOT_SHOCK,
    MOUNT_JOINT,
    RIM_JOINT,
    SCREWS_SHOCK,
    SHAFT_JOINT,
    WEB_SHOCK,
    WHEEL_STRESS,
    joints_of,
)
from ocs_design.device.records.flights import Buildable, Margin, OpenPoint
from ocs_design.parts.joints import EPOXY
from ocs_design.robot.meshes import lacks_mesh, unmeasured
from ocs_design.robot.robot import Robot
from ocs_design.sizing.margins import (
    BRAKED_RIM,
    BRAKED_SHAFT,
    BUS_CURRENT,
    BUS_POWER,
    FED_BACK,
    HOOP_STRESS,
    MOTOR_SPEED,
    MOTOR_TORQUE,
    WHEEL_SPEED,
)
from ocs_design.sizing.mounting import DeviceMounting, mounting_open_points
from ocs_design.sizing.sized import Designed

_SUPPLY = "give a stronger supply with --bus-power and --bus-current, or allow more time"
_DRIVE = "choose a stronger motor (--motor), or allow more time"
CURES: Mapping[str, str] = {
    WHEEL_SPEED: _DRIVE,
    MOTOR_SPEED: _DRIVE,
    MOTOR_TORQUE: _DRIVE,
    BUS_CURRENT: _SUPPLY,
    BUS_POWER: _SUPPLY,
    BUS_CURRENT + FED_BACK: _SUPPLY,
    BUS_POWER + FED_BACK: _SUPPLY,
    HOOP_STRESS: "choose a stronger material (--material), or a slower motor",
    BRAKED_SHAFT: "choose a motor with a lighter rotor or with threads in it (--motor)",
    BRAKED_RIM: "make the wheel in one piece (--web disc)",
}
"""Margins whose capacity must not be exceeded, by name, and the cure.

Others may be exceeded: a continuous current for a second, and a voltage, which then gives less
torque.
"""

_JOINT_CURES = {
    WHEEL_STRESS: "choose a stronger material (--material), or a slower motor",
    RIM_JOINT: "make the wheel in one piece, of a stronger material (--material), or choose a "
    "slower motor",
    SHAFT_JOINT: "choose a motor with threads in its rotor, more of them or deeper (--motor)",
    MOUNT_JOINT: "choose a motor with more or larger threads in its stator (--motor)",
    WEB_SHOCK: "make the wheel smaller (--r-max) or its web full (flywheel.lightening = 0)",
    SCREWS_SHOCK: "give a place where the plate's screws stand farther apart (--position)",
}
_BOND_CURE = "choose a slower motor, or a disc in place of the ring (--wheel disc)"
_NOT_CRITICAL = ("shaft joint, screws in shear", FOOT_SHOCK, FLOOR_SHOCK)
"""Joints that may fall short: friction carries the torque, and parts too weak in PETG can be
milled."""

TOLERANCE = 1e-3
"""Fraction by which a capacity may be exceeded: what a wheel gains within one control step beyond
the limit that its control law keeps."""


def buildable_of(
    robot: Robot, designed: Designed, margins: Sequence[Margin], mounting: DeviceMounting | None
) -> Buildable:
    """Whether a designed device can be built on its robot, and the open points."""
    motor = None if designed.choice is None else designed.choice.chosen.motor
    return buildable(motor, mounting, margins, joints_of(designed.device), robot)


def buildable(
    motor: Motor | None,
    mounting: DeviceMounting | None,
    margins: Sequence[Margin],
    joints: Sequence[Margin] = (),
    robot: Robot | None = None,
) -> Buildable:
    """Whether a device can be built as designed, and the open points.

    Args:
        motor: the chosen motor; None: none was chosen, and the answer is unknown.
        mounting: on the robot. Where the robot's shapes are unknown, so is whether it holds, and
            with it the answer, unless something else keeps the device from being built.
        robot: that carries the device; None: no meshes can be missing.
    """
    if motor is None:
        return Buildable(yes=None)
    points: list[OpenPoint] = []
    # Without meshes it is unknown what the device stands on and hits.
    mounted = () if mounting is None else mounting_open_points(mounting)
    bodies = () if robot is None else robot.tree.bodies
    trunk = None if robot is None else bodies[robot.tree.body_of_link[robot.trunk]]
    # A fault of the feet on the trunk may be due to a missing mesh.
    unknown = [
        body.name
        for body in bodies
        if unmeasured(body) or (mounted and body is trunk and lacks_mesh(body))
    ]
    cure = robot.mesh_cure if robot else ""
    if missing := bool(unknown and cure):
        what = f"meshes are missing: the shape of {some_of(unknown)} is not known"
        points.append(OpenPoint(what=what, cure=cure))
    if gaps := build_gaps(motor):
        points.append(
            OpenPoint(
                what=f"no source gives the {listed(gaps)} of {motor.name}",
                cure="add them to its row in a file of your own (--motors FILE), or leave the "
                "choice to the program, which takes a motor with all data needed to build",
            )
        )
    for joint in joints:
        shaft = SHAFT_JOINT if joint.name.startswith(SHAFT_JOINT) else RIM_JOINT
        cure = _JOINT_CURES.get(joint.name, _JOINT_CURES[shaft])
        if EPOXY in joint.note:
            cure = _BOND_CURE
        if joint.capacity is None:
            points.append(OpenPoint(what=f"{joint.name}: {joint.note}", cure=cure))
        elif joint.margin is not None and joint.margin < 1.0 and joint.name not in _NOT_CRITICAL:
            required, available = (
                quantity(value, joint.unit) for value in (joint.demand, joint.capacity)
            )
            what = f"{joint.name}: {required} required, {available} available"
            points.append(OpenPoint(what=what, cure=cure))
    points += mounted
    for margin in margins:
        falls_short = margin.margin is not None and margin.margin < 1.0 - TOLERANCE
        if falls_short and margin.name in CURES and margin.capacity is not None:
            required, available = (
                quantity(value, margin.unit) for value in (margin.demand, margin.capacity)
            )
            maneuver_text = f" by {margin.scenario}" if margin.scenario else ""
            what = f"{margin.name}: {required} required{maneuver_text}, {available} allowed"
            points.append(OpenPoint(what=what, cure=CURES[margin.name]))
    shape_known = missing or (mounting is not None and mounting.known)
    decided = shape_known or len(points) > len(mounted)
    return Buildable(yes=not points if decided else None, open=tuple(points))
