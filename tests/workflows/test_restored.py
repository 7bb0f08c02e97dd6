"""Robots, devices and maneuvers are restored from the records of a design to the last digit."""

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from designed_devices import MOTOR, design_with_motor, record_of
from exported import LEGGED_PATHS
from robots import ROBOTS, robot_parameters

from ocs_design.common.errors import OcsError, RobotError
from ocs_design.common.files import to_json
from ocs_design.device.checks import check_control
from ocs_design.device.device import Device
from ocs_design.device.records.design import read_design
from ocs_design.device.records.flights import ControlRecord
from ocs_design.device.records.requirement import ManeuverRecord, RobotRecord
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.posture import OUTSIDE
from ocs_design.robot.reader import read_robot
from ocs_design.workflows.flying import flown_hash
from ocs_design.workflows.restoring import RobotLocation, base_of, read_recorded_robot, robot_of

HUMAN = next(ROBOTS.rglob("human.urdf"))
MIMIC = """<robot name="gripper">
  <link name="base"><inertial><mass value="2"/>
    <inertia ixx="0.03" iyy="0.05" izz="0.07" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="a"><inertial><origin xyz="0.1 0 0"/><mass value="0.1"/>
    <inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="b"><inertial><origin xyz="0.2 0 0"/><mass value="0.1"/>
    <inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="lead" type="continuous"><parent link="base"/><child link="a"/></joint>
  <joint name="follow" type="continuous"><parent link="base"/><child link="b"/>
    <mimic joint="lead" multiplier="-2" offset="0.1"/></joint>
</robot>"""


def through_json(record):
    return msgspec.json.decode(msgspec.json.encode(record), type=RobotRecord)


def check_same(restored, robot):
    for name in ("posture", "trunk", "name", "sha256", "mass"):
        assert getattr(restored, name) == getattr(robot, name)
    ours, theirs = (
        [text for text in either.warnings if text.startswith(OUTSIDE)]
        for either in (restored, robot)
    )
    assert ours == theirs
    np.testing.assert_array_equal(restored.com, robot.com)
    np.testing.assert_array_equal(restored.inertia, robot.inertia)


@pytest.mark.parametrize("path", robot_parameters([*LEGGED_PATHS, HUMAN]))
def test_a_restored_robot_has_the_same_posture(path):
    robot = read_robot(path)
    restored = robot_of(through_json(RobotRecord.of(robot)), path, {})
    check_same(restored, robot)
    assert (restored.mount is None) == (robot.mount is None)


@pytest.mark.parametrize("path", [LEGGED_PATHS[0], HUMAN])
def test_the_base_frame_is_that_of_the_robot(path):
    robot = read_robot(path)
    base = base_of(through_json(RobotRecord.of(robot)))
    assert base.trunk == robot.trunk
    if robot.mount is None:
        assert base.mount is None
    else:
        assert base.mount.link == robot.mount.link
        for name in ("rotation", "position"):
            ours, theirs = (getattr(mount.placement, name) for mount in (base.mount, robot.mount))
            np.testing.assert_array_equal(ours, theirs)


def test_mimic_joints_are_restored(tmp_path):
    (tmp_path / "g.urdf").write_text(MIMIC)
    robot = read_robot(tmp_path / "g.urdf", joints={"lead": 0.3})
    assert robot.posture["follow"] == pytest.approx(-0.5)
    check_same(robot_of(RobotRecord.of(robot), tmp_path / "g.urdf", {}), robot)


def test_a_robot_by_hand_is_restored_from_its_record_alone():
    robot = robot_by_hand(2.5, (0.03, 0.05, 0.07, 1e-3, 2e-3, -3e-3), (0.01, 0.0, -0.02), "box")
    check_same(robot_of(through_json(RobotRecord.of(robot)), "nowhere", {}), robot)


def test_a_specified_trunk_is_restored():
    path = LEGGED_PATHS[0]
    robot = read_robot(path, trunk="FL_SHOULDER")
    check_same(robot_of(RobotRecord.of(robot), path, {}), robot)


def test_a_robot_that_lacks_a_joint_is_refused(tmp_path):
    (tmp_path / "g.urdf").write_text(MIMIC)
    record = RobotRecord.of(read_robot(tmp_path / "g.urdf"))
    (tmp_path / "g.urdf").write_text(MIMIC.replace("lead", "other"))
    with pytest.raises(RobotError, match="no joint or link 'lead'"):
        robot_of(record, tmp_path / "g.urdf", {})


def test_a_robot_whose_included_file_has_changed_is_refused(tmp_path):
    body = '<mujoco><worldbody><body name="trunk"><freejoint/>{}</body></worldbody></mujoco>'
    (tmp_path / "robot.xml").write_text('<mujoco><include file="trunk.xml"/></mujoco>')
    (tmp_path / "trunk.xml").write_text(body.format('<geom size="0.1" mass="2"/>'))
    record = RobotRecord.of(read_robot(tmp_path / "robot.xml"))
    where = RobotLocation(tmp_path / "out" / "design.json", None, {}, "")
    assert read_recorded_robot(record, where, strict=True)[0].mass == 2.0
    (tmp_path / "trunk.xml").write_text(body.format('<geom size="0.1" mass="3"/>'))
    with pytest.raises(RobotError, match=r"includes has changed.* differs by 50 % of the largest"):
        read_recorded_robot(record, where, strict=False)


@pytest.mark.parametrize("motor", [MOTOR, "none"])
def test_a_device_is_restored_to_the_last_digit(tmp_path, motor):
    task, sizing = design_with_motor(motor)
    design = record_of(task, sizing)
    (tmp_path / "design.json").write_bytes(to_json(design))
    read, device = read_design(tmp_path / "design.json"), sizing.device
    restored = Device.of_record(read.ocs, read.supply)
    for name in ("incidence", "flywheel", "motor", "carrier", "supply"):
        assert getattr(restored, name) == getattr(device, name)
    for ours, theirs in zip(restored.modules, device.modules, strict=True):
        assert ours.name == theirs.name
        np.testing.assert_array_equal(ours.axis, theirs.axis)
        np.testing.assert_array_equal(ours.position, theirs.position)


def test_package_paths_are_recorded(tmp_path):
    robot = read_robot(LEGGED_PATHS[0])
    record = through_json(RobotRecord.of(robot, {"parts": tmp_path}))
    assert record.package_paths == {"parts": str(tmp_path)}
    assert "package_paths" in json.loads(msgspec.json.encode(record))


DROP = {"height": 1.0, "roll": 0.0, "pitch": 0.5}


def recorded(kind, parameters):
    return ManeuverRecord(kind=kind, name="it", gravity=9.81, incidence=None, parameters=parameters)


def drop(**changes):
    parameters = (DROP | changes).items()
    return recorded("drop", {key: value for key, value in parameters if value is not None})


def test_a_maneuver_is_restored():
    maneuver = drop().maneuver()
    assert (maneuver.name, maneuver.height, maneuver.pitch) == ("it", 1.0, 0.5)


@pytest.mark.parametrize(
    "changes",
    [
        {"height": None},
        {"gravity": 9.81},
        {"speed": 1.0},
        {"pitch": (1.0, 2.0)},
        {"height": -1.0},
        {"pitch": 4.0},
    ],
    ids=["missing", "twice", "unknown", "several", "negative", "beyond half a turn"],
)
def test_a_maneuver_with_wrong_parameters_is_refused(changes):
    with pytest.raises(OcsError, match=r"maneuver 'it': .*drop"):
        drop(**changes).maneuver()


def test_a_maneuver_under_a_gravity_that_lifts_is_refused():
    """CasADi's own assertion was the message."""
    with pytest.raises(OcsError, match=r"gravity of a drop cannot be -3\.0"):
        replace(drop(), gravity=-3.0).maneuver()


def test_a_maneuver_that_contradicts_itself_is_refused():
    """A fall in orbit ended in a division by zero."""
    with pytest.raises(OcsError, match="it: nothing falls in orbit"):
        replace(drop(), gravity=0.0).maneuver()


def test_a_turn_in_orbit_is_restored_without_a_jump():
    floating = recorded("turn", {"jump_height": 0.0, "duration": 9.0, "yaw": 0.5})
    assert replace(floating, gravity=0.0).maneuver().jump_height == 0.0


@pytest.mark.parametrize(
    "change",
    [{"kp": -5.0}, {"kd": 0.0}, {"period": 0.0}, {"period": 0.0025}, {"projection": "foo"}],
    ids=str,
)
def test_a_wheel_law_that_cannot_be_flown_is_refused(change):
    """A period of 0 ended in a division by zero, and a negative gain was flown.

    With a period of 2.5 ms the law was called every 2 ms.
    """
    law = ControlRecord(projection="transpose", kp=60.0, kd=12.0)
    assert check_control(law) is None
    (figure,) = change
    with pytest.raises(OcsError, match=f"control.{figure} is"):
        check_control(replace(law, **change))


def test_a_vector_of_the_wrong_length_is_refused():
    push = {"takeoff_velocity": (0.5, 2.4), "torque": (0.2, 0.8), "onset": 0.1, "duration": 0.05}
    with pytest.raises(OcsError, match="torque of a disturbance cannot be"):
        recorded("disturbance", push).maneuver()


def test_a_turn_is_restored_with_its_end():
    parameters = {"jump_height": 1.9, "duration": 1.2, "yaw": 1.57, "rate": (0.1, 0.0, 0.0)}
    turn = recorded("turn", parameters | {"end": "at rest"}).maneuver()
    assert (turn.yaw, turn.rate, turn.end) == (1.57, (0.1, 0.0, 0.0), "at rest")
    for end in ("upright", 1.0):
        with pytest.raises(OcsError, match="end of a turn cannot be"):
            recorded("turn", parameters | {"end": end}).maneuver()
    with pytest.raises(OcsError, match="yaw of a turn cannot be 'far'"):
        recorded("turn", parameters | {"yaw": "far"}).maneuver()


def test_the_hash_of_a_design_does_not_depend_on_the_order_of_keys():
    design = read_design(Path(__file__).parents[1] / "data" / "design_1.json")
    flown = msgspec.to_builtins((design.ocs, design.requirement.maneuvers, design.control))
    expected = hashlib.sha256(msgspec.json.encode(flown, order="sorted")).hexdigest()
    assert flown_hash(design, design.control, None) == expected
