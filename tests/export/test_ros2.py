"""The ROS 2 package, read back by xacro, Pinocchio, catkin_pkg and Python's compiler."""

from xml.etree import ElementTree as ET

import numpy as np
import pinocchio as pin
import pytest
import xacro
import yaml
from catkin_pkg.package import parse_package
from exported import LEGGED_PATHS, MJCF, check_wheels_in_pinocchio, pinocchio_model
from robots import SOLO12, robot_parameters
from wheels import driven_device

from ocs_design.export.formats import Subject
from ocs_design.export.ros2 import package_name, write
from ocs_design.robot.reader import read_robot


def exported(path, folder):
    """Robot, folder of the package, and its xacro expanded as in a launch file."""
    robot = read_robot(path)
    (note,) = write(Subject.of(robot, driven_device(), "a-1"), folder)
    assert "no maintainer" in note
    (package,) = folder.iterdir()
    xml = package / "urdf" / "a-1_ocs.urdf.xacro"
    text = xacro.process_file(str(xml), mappings={"hardware_plugin": "own/Plugin"}).toxml()
    return robot, package, text


@pytest.mark.parametrize("path", robot_parameters(LEGGED_PATHS))
def test_an_independent_reader_finds_mass_inertia_axes_limits_and_meshes(path, tmp_path):
    robot, package, text = exported(path, tmp_path)
    device, model = driven_device(), pinocchio_model(text)
    assert pin.computeTotalMass(model) == pytest.approx(robot.mass + device.mass, rel=1e-12)
    check_wheels_in_pinocchio(model, device, robot.trunk)
    names = [name for name in model.names if name in robot.tree.joints]
    # Pinocchio keeps joints that follow others as joints of their own.
    assert set(names) == set(robot.tree.joints)
    before = pinocchio_model(robot.content.decode())
    for name in names:
        joint, original = (part.joints[part.getJointId(name)] for part in (model, before))
        assert joint.shortname() == original.shortname()
        if joint.nq == 1:
            for field in ("lowerPositionLimit", "upperPositionLimit"):
                assert getattr(model, field)[joint.idx_q] == getattr(before, field)[original.idx_q]
        assert model.effortLimit[joint.idx_v] == before.effortLimit[original.idx_v]
        inertias = [part.inertias[part.getJointId(name)].matrix() for part in (model, before)]
        np.testing.assert_allclose(*inertias, rtol=0.0, atol=1e-12 * robot.mass)
    wheel = model.joints[model.getJointId("ocs_left")].idx_v
    assert (model.effortLimit[wheel], model.velocityLimit[wheel]) == (1.0, 650.4)
    meshes = {mesh.get("filename") for mesh in ET.fromstring(text).iter("mesh")}
    address = f"package://{package.name}/"
    assert all((package / mesh.removeprefix(address)).is_file() for mesh in meshes)
    assert len(meshes) == len(list((package / "meshes").iterdir()))


def test_every_moving_joint_is_in_ros2_control_and_in_a_controller(tmp_path):
    robot, package, text = exported(SOLO12, tmp_path)
    (system,) = ET.fromstring(text).iter("ros2_control")
    assert system.findtext("hardware/plugin") == "own/Plugin"
    declared = {joint.get("name"): joint for joint in system.iter("joint")}
    assert list(declared) == [*robot.tree.joints, "ocs_left", "ocs_right"]
    for name, joint in robot.tree.joints.items():
        (command,) = declared[name].iter("command_interface")
        assert command.get("name") == "position"
        assert [float(limit.text) for limit in command] == [joint.lower, joint.upper]
        start = declared[name].findtext("state_interface[@name='position']/param")
        assert float(start) == robot.posture[name]
    (command,) = declared["ocs_left"].iter("command_interface")
    assert command.get("name") == "effort"
    assert [float(limit.text) for limit in command] == [-1.0, 1.0]
    controllers = yaml.safe_load((package / "config" / "controllers.yaml").read_text())
    parameters = {name: controllers[name]["ros__parameters"] for name in controllers}
    moved = [*parameters["joint_controller"]["joints"], *parameters["ocs_controller"]["joints"]]
    assert moved == list(declared)
    manager = parameters["controller_manager"]
    assert set(manager) - {"update_rate", "joint_state_broadcaster"} == set(controllers) - {
        "controller_manager"
    }


def test_joints_that_follow_others_take_no_commands(tmp_path):
    robot, package, text = exported(LEGGED_PATHS[-1], tmp_path)
    followers = {name for name, joint in robot.tree.joints.items() if joint.mimic is not None}
    commands = {
        joint.get("name"): joint.find("command_interface")
        for joint in ET.fromstring(text).find("ros2_control").iter("joint")
    }
    assert followers
    assert {name for name, command in commands.items() if command is None} == followers
    controllers = yaml.safe_load((package / "config" / "controllers.yaml").read_text())
    assert followers.isdisjoint(controllers["joint_controller"]["ros__parameters"]["joints"])


def test_joints_that_the_robot_declares_are_not_declared_again(tmp_path):
    own = '<ros2_control name="own" type="system"><joint name="FL_HAA"/></ros2_control>'
    path = tmp_path / "robot.urdf"
    path.write_text(SOLO12.read_text().replace("</robot>", own + "</robot>"))
    (tmp_path / "out").mkdir()
    write(Subject.of(read_robot(path), driven_device(), "a"), tmp_path / "out")
    (xml,) = (tmp_path / "out").rglob("a_ocs.urdf.xacro")
    systems = ET.fromstring(xacro.process_file(str(xml)).toxml()).iter("ros2_control")
    named = [joint.get("name") for system in systems for joint in system.iter("joint")]
    assert len(named) == len(set(named)) == 14


def test_the_manifest_is_valid_and_lists_the_dependencies(tmp_path):
    _, package, _ = exported(SOLO12, tmp_path)
    manifest = parse_package(str(package))
    manifest.validate()
    assert manifest.name == package.name == "a_1_ocs_description"
    assert f"project({package.name})" in (package / "CMakeLists.txt").read_text()
    launch = (package / "launch" / "display.launch.py").read_text()
    compile(launch, "display.launch.py", "exec")
    assert f"'{package.name}'" in launch
    dependencies = {dependency.name for dependency in manifest.exec_depends}
    assert {part.split("'")[1] for part in launch.split("package=")[1:]} <= dependencies
    view = yaml.safe_load((package / "rviz" / "display.rviz").read_text())
    assert view["Visualization Manager"]["Global Options"]["Fixed Frame"] == "base_link"
    assert {path.name for path in package.iterdir() if path.is_dir()} <= set(
        (package / "CMakeLists.txt").read_text().split()
    )


def test_meshes_of_one_name_from_two_folders_stay_two(tmp_path):
    for folder, size in (("a", 1), ("b", 2)):
        (tmp_path / folder).mkdir()
        corners = f"v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nv 0 0 {size}\n"
        faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
        (tmp_path / folder / "part.obj").write_text(corners + faces)
    shapes = "".join(
        f'<visual><geometry><mesh filename="{folder}/part.obj"/></geometry></visual>'
        for folder in "ab"
    )
    missing = '<visual><geometry><mesh filename="no/such.stl"/></geometry></visual>'
    (tmp_path / "r.urdf").write_text(
        '<robot name="r"><link name="trunk"><inertial><mass value="1"/><inertia ixx="1" iyy="1" '
        f'izz="1" ixy="0" ixz="0" iyz="0"/></inertial>{shapes}{missing}</link></robot>'
    )
    (tmp_path / "out").mkdir()
    subject = Subject.of(read_robot(tmp_path / "r.urdf"), driven_device(), "r")
    (_, note) = write(subject, tmp_path / "out")
    assert "no/such.stl" in note
    (urdf,) = (tmp_path / "out").rglob("r_ocs.urdf")
    first, second, *_ = (mesh.get("filename") for mesh in ET.parse(urdf).getroot().iter("mesh"))
    for address, folder in ((first, "a"), (second, "b")):
        copy = urdf.parents[1] / "meshes" / address.rpartition("/")[2]
        assert copy.read_bytes() == (tmp_path / folder / "part.obj").read_bytes()


def test_an_mjcf_robot_gets_a_package_too(tmp_path):
    (tmp_path / "in.xml").write_text(MJCF)
    (tmp_path / "out").mkdir()
    robot, package, text = exported(tmp_path / "in.xml", tmp_path / "out")
    total = robot.mass + driven_device().mass
    assert pin.computeTotalMass(pinocchio_model(text)) == pytest.approx(total, rel=1e-12)
    assert parse_package(str(package)).name == package.name


@pytest.mark.parametrize(
    ("robot", "name"),
    [
        ("solo12", "solo12_ocs_description"),
        ("ANYmal-C.v2", "anymal_c_v2_ocs_description"),
        ("3dog__x", "robot_3dog_x_ocs_description"),
        ("_", "robot_ocs_description"),
    ],
)
def test_names_of_packages_follow_rep_144(robot, name):
    assert package_name(robot) == name
