"""A device with real motors in every file: inertia of the whole robot, armature, limits, names."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from exported import (
    LEGGED,
    LEGGED_PATHS,
    check_total,
    mujoco_model,
    pinocchio_model,
    robot_at,
    total_by_mujoco,
    total_by_pinocchio,
)
from robots import SOLO12
from seats import TRUNK, TrunkOnly, expand_macro
from subsets import fast_subset
from wheels import EC45, EC45_BODY, driven_device, geared, layout_device

from ocs_design.device.bodies import carrier_inertial, flywheel_inertial
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.export.snippets import snippet_mjcf, snippet_xacro
from ocs_design.export.urdf import robot_urdf
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.mass import physical_defect

DEVICES = {
    "direct": driven_device(),
    "reducing": driven_device(drive=geared(1.5)),
    "reversing": driven_device(drive=geared(1.5, reverses=True)),
    "speeding up": driven_device(drive=geared(0.5, inertia=0.0)),
}
LAYOUTS = [name.value for name in LayoutName if name.value not in {"pair", "by-hand"}]
DEVICES |= {name: layout_device(Layout(LayoutName(name))) for name in LAYOUTS}
BLOCK = robot_by_hand(2.5, (0.03, 0.05, 0.07, 0.001, 0.002, -0.003), com=(0.01, 0.0, -0.02))


@pytest.fixture(params=DEVICES)
def device(request):
    return DEVICES[request.param]


ROBOTS_AND_DEVICES = {name: (SOLO12, device) for name, device in DEVICES.items()} | {
    name: (path, driven_device()) for name, path in zip(LEGGED[1:7], LEGGED_PATHS[1:7], strict=True)
}


@pytest.mark.parametrize("case", fast_subset(3, ROBOTS_AND_DEVICES))
def test_mujoco_and_pinocchio_see_the_whole_robot(case, tmp_path):
    path, device = ROBOTS_AND_DEVICES[case]
    robot = robot_at(path)
    text = robot_urdf(robot, device).decode()
    check_total(total_by_pinocchio(text, robot), robot, device)
    check_total(total_by_mujoco(mujoco_model(robot, device, tmp_path), robot), robot, device)


def test_the_wheel_has_its_momentum_and_the_joint_its_armature(device, tmp_path):
    model = mujoco_model(BLOCK, device, tmp_path)
    mass_matrix = np.empty((model.nv, model.nv))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass_matrix)
    for module in device.modules:
        dof = int(model.joint(f"ocs_{module.name}").dofadr[0])
        h = device.flywheel.spin_inertia
        assert mass_matrix[dof, dof] == pytest.approx(h + device.motor.armature, rel=1e-12)
        np.testing.assert_allclose(mass_matrix[dof, 3:6], h * module.axis, rtol=0, atol=1e-12 * h)


@pytest.mark.parametrize("rotor_inertia", [0.0, 1e-5, 3e-5, 1e-4, -1e-4])
def test_bodies_are_physical_for_any_rotor(rotor_inertia):
    """Moments of inertia are positive and fulfil the triangle inequality."""
    drive = replace(EC45, rotor_inertia=rotor_inertia)
    device = driven_device(drive=drive)
    device = replace(device, flywheel=replace(device.flywheel, spin_inertia=1.5e-4 + rotor_inertia))
    device = replace(device, flywheel=replace(device.flywheel, transverse_inertia=0.76e-4))
    for body in (flywheel_inertial(device), carrier_inertial(device, device.modules[0])):
        assert physical_defect(body) is None
        low, middle, high = np.linalg.eigvalsh(body.inertia)
        assert 0.0 < low <= middle <= high <= low + middle


def test_a_carrier_keeps_a_hundredth_beside_a_larger_rotor_inertia():
    """The only case in which the files have more inertia than the module."""
    rotor = 3.0 * EC45_BODY.axial_inertia
    device = driven_device(drive=replace(EC45, rotor_inertia=rotor))
    left = carrier_inertial(device, device.modules[0]).inertia[2, 2]
    assert left == pytest.approx(0.01 * EC45_BODY.axial_inertia)


RENAMED = ' prefix="front_" incidence="0.25"'
MACROS = {name: (DEVICES[name], "", DEVICES[name]) for name in ("direct", *LAYOUTS)}
MACROS |= {"with a prefix at another angle": (driven_device(), RENAMED, driven_device(0.25))}


@pytest.mark.parametrize(("written", "arguments", "expected"), MACROS.values(), ids=MACROS)
def test_the_xacro_macro_makes_every_layout_at_any_angle(written, arguments, expected, tmp_path):
    (tmp_path / "ocs.urdf.xacro").write_text(snippet_xacro(written, TrunkOnly()))
    text = expand_macro(tmp_path, f'<xacro:ocs parent="{TRUNK}"{arguments}/>')
    assert ('link name="front_ocs_left_motor"' in text) == bool(arguments)
    trunk = replace(robot_by_hand(1.0, (1.0, 1.0, 1.0)), trunk=TRUNK)
    check_total(total_by_pinocchio(text, trunk), trunk, expected)


def test_the_mjcf_snippet_has_the_whole_inertia_and_armature(device, tmp_path):
    (tmp_path / "ocs.xml").write_text(snippet_mjcf(device, replace(BLOCK, trunk="base_link")))
    (tmp_path / "robot.xml").write_text(
        '<mujoco><asset><model name="ocs" file="ocs.xml"/></asset><worldbody>'
        f'<body name="base"><freejoint/><inertial pos="0.01 0 -0.02" mass="2.5" fullinertia="'
        f'{" ".join(map(repr, [0.03, 0.05, 0.07, 0.001, 0.002, -0.003]))}"/>'
        '<attach model="ocs" body="mount" prefix="ocs_"/></body></worldbody></mujoco>'
    )
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    check_total(total_by_mujoco(model, replace(BLOCK, trunk="base")), BLOCK, device)
    for module in device.modules:
        assert model.joint(f"ocs_{module.name}").armature[0] == device.motor.armature
        assert model.body(f"ocs_{module.name}_motor").name


def test_urdf_has_the_armature_as_a_comment():
    drive = geared(3.0)
    text = robot_urdf(BLOCK, driven_device(drive=drive)).decode()
    comments = re.findall(r"<!-- armature (\S+) kg m\^2, which URDF cannot state -->", text)
    assert [float(value) for value in comments] == [drive.armature] * 2
    direct = robot_urdf(BLOCK, driven_device()).decode()
    assert "armature" not in direct


@pytest.mark.parametrize(
    ("speed_max", "velocity"), [(400.0, 400.0), (None, 650.4), (1047.2, 650.4)]
)
def test_the_velocity_limit_is_the_lower_of_motor_and_mechanics(speed_max, velocity):
    device = driven_device(drive=replace(EC45, speed_max=speed_max))
    model = pinocchio_model(robot_urdf(BLOCK, device).decode())
    index = model.idx_vs[model.getJointId("ocs_left")]
    assert model.upperVelocityLimit[index] == velocity
    assert model.upperEffortLimit[index] == 1.0
