"""The machines of docs/machines.md: their specifications follow from published data."""

import re
from dataclasses import replace
from math import sqrt
from pathlib import Path

import mujoco
import numpy as np
import pytest
from mass_oracles import mujoco_mass_properties
from scripts import script_at

from ocs_design.parts.rim import cylinder_spin_inertia, cylinder_transverse_inertia
from ocs_design.requirement.reading import read_specification
from ocs_design.requirement.resolving import read_specified_robot, resolve
from ocs_design.robot.mass import MassProperties
from ocs_design.sizing.design import design_device
from ocs_design.sizing.trajectory.gyrostat import Gyrostat
from ocs_design.sizing.trajectory.plans import drive_line_of, least_power_turn
from ocs_design.workflows.pareto import read_task

ROOT = Path(__file__).parents[2]
MACHINES = ROOT / "examples" / "machines"


def load(name):
    """A script in the folder of the specifications."""
    return script_at(MACHINES / f"{name}.py")


standing = load("standing")


def specification(name):
    return read_specification(MACHINES / f"{name}.toml")


@pytest.mark.parametrize("name", standing.MACHINES)
def test_a_specification_has_the_machine_without_its_wheels(name):
    specified, machine = specification(name), standing.MACHINES[name]
    robot = read_specified_robot(specified)
    assert robot.mass == pytest.approx(machine.body.mass, abs=1e-4)
    largest = np.abs(machine.body.inertia).max()
    np.testing.assert_allclose(robot.inertia, machine.body.inertia, atol=5e-4 * largest)
    # For a pair only the place of the left wheel is specified.
    positions = np.reshape(specified.ocs.position, (-1, 3))
    np.testing.assert_allclose(positions, machine.positions[: len(positions)], atol=6e-5)
    for maneuver in specified.maneuvers:
        np.testing.assert_allclose(maneuver.pivot, machine.pivot, atol=6e-5)


def test_subtracting_and_adding_a_part_restores_the_body():
    body, part = standing.REX_HOPPER, standing.Body.of(0.7, (0.1, -0.2, 0.3), (1e-3, 2e-3, 2e-3))
    restored = body - part + part
    assert restored.mass == pytest.approx(body.mass)
    np.testing.assert_allclose(restored.com, body.com, atol=1e-12)
    np.testing.assert_allclose(restored.inertia, body.inertia, atol=1e-12)


REX_HOPPER_LINKS = """
<mujoco><compiler angle="radian"/><worldbody><body name="base"><freejoint/>
<inertial pos="-0.00418136 0.00001975 0.01669539" mass="4.74662308"
 diaginertia="0.03772045 0.01927139 0.03899715"/>
<body quat="0.965926 0 0.258819 0"><inertial pos="0.00533299 0.0313631 0.000493209" mass="0.585808"
 quat="0.530362 0.492963 0.467911 0.506717" diaginertia="0.00042296 0.00083894 0.00063126"/>
<body pos="0.1 0 0" quat="0.5 0 0.866025 0"><inertial pos="0.135392 0.0069372 0" mass="0.0809766"
 quat="0.5 0.5 0.5 0.5" diaginertia="0.00000391 0.00068989 0.00068741"/></body></body>
<body quat="0.258819 0 0.965926 0"><inertial pos="0.0385294 -0.0274403 -7.28007e-05" mass="0.734902"
 quat="0.493035 0.506138 0.50707 0.49358" diaginertia="0.00048837 0.00511568 0.0049324"/>
<body pos="0.27 0 0" quat="0.5 0 -0.866025 0">
<inertial pos="0.125791 8.30702e-06 -0.0172728" quat="0.00267744 0.722948 -0.00161976 0.690896"
 mass="0.155003" diaginertia="0.00019365 0.00158853 0.00173031"/></body></body>
<body pos="0.056569 -0.1372 0" quat="0.923879 0 0 -0.382684"><inertial pos="-0.0112089 0 0"
 quat="0.617191 0.786813 0 0" mass="0.78203" diaginertia="0.00660959 0.0033873 0.0033873"/></body>
<body pos="0.056569 0.1372 0" quat="0.923879 0 0 0.382684"><inertial pos="-0.0112089 0 0"
 quat="0.616123 0.78765 0 0" mass="0.78203" diaginertia="0.00660959 0.0033873 0.0033873"/></body>
<body pos="-0.076 0 0.086" quat="-2.59734e-06 0.707105 2.59735e-06 0.707108">
<inertial pos="-0.0085979 0 0" mass="0.329528" diaginertia="0.00082888 0.00043238 0.00043238"/>
</body></body></worldbody></mujoco>
"""
"""Mass properties and places of the links from hopper_rev10_mjcf.xml."""


def test_rex_hopper_is_the_sum_of_its_links():
    model = mujoco.MjModel.from_xml_string(REX_HOPPER_LINKS)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    links, total = mujoco_mass_properties(model, data), standing.REX_HOPPER
    assert total.mass == pytest.approx(links.mass, abs=5e-5)
    np.testing.assert_allclose(total.inertia, links.inertia, atol=1e-6)
    np.testing.assert_allclose(total.com - [0.0, 0.0, 0.45], links.com, atol=2e-3)


@pytest.mark.parametrize(
    ("name", "mass", "spin", "transverse"),
    [("wheelbot", 0.3, 5.03e-4, 2.59e-4), ("rex_hopper", 0.78203, 6.60959e-3, 3.3873e-3)],
)
def test_the_limits_of_the_rim_are_those_of_the_wheel_as_built(name, mass, spin, transverse):
    """The hollow cylinder with the published mass and both published inertias."""
    limits = specification(name).flywheel
    height = sqrt(12.0 / mass * (transverse - spin / 2.0))
    assert limits.h_max == pytest.approx(height, rel=0.02)
    gyration = sqrt(spin / mass)
    assert limits.r_max >= gyration
    inner = sqrt(max(2.0 * spin / mass - limits.r_max**2, 0.0))
    if inner > 0.0:
        density = mass / (np.pi * height * (limits.r_max**2 - inner**2))
        cylinder = inner, limits.r_max, height, density
        assert cylinder_spin_inertia(*cylinder) == pytest.approx(spin)
        assert cylinder_transverse_inertia(*cylinder) == pytest.approx(transverse)


@pytest.fixture(scope="module")
def hopper():
    """Specification of REx Hopper, and its device without reserve."""
    specified = specification("rex_hopper")
    nominal = replace(specified, requirement=replace(specified.requirement, reliability=0.5))
    return specified, design_device(read_task(nominal), ranked=False).device


@pytest.mark.slow
@pytest.mark.parametrize("axis", ["roll", "pitch"])
def test_rex_hopper_as_built_recovers_from_16_degrees(axis, hopper):
    """A plan with the full torque of its motors, for the machine as published."""
    specified, device = hopper
    machine = standing.REX_HOPPER
    body = MassProperties(machine.mass, machine.com, machine.inertia)
    for degrees, feasible in ((16.0, True), (17.0, False)):
        start = {"roll": 0.0, "pitch": 0.0, axis: np.radians(degrees)}
        maneuver = replace(specified.maneuvers[0], pivot=(0.0, 0.0, 0.0), **start).on(body)
        built = Gyrostat(
            maneuver.inertia, device.axes, 6.60959e-3, 0.0, maneuver.gravity_moment, maneuver.axis
        )
        planned = least_power_turn(maneuver.boundary(), built, drive_line_of(device))
        assert (not planned.failure) == feasible


BUS = (180.0, np.array([18.0, 28.0, 22.0]))
"""Mass and inertia of the satellite in the sizing table."""

SLEWS = [(10.0, 20.0), (30.0, 30.0), (60.0, 60.0), (90.0, 60.0), (45.0, 10.0)]
"""Its slews: angle [deg] and time [s]."""


def test_the_satellite_is_that_of_the_table_scaled_down():
    specified = specification("satellite")
    robot = read_specified_robot(specified)
    mass, inertia = BUS
    np.testing.assert_allclose(
        np.diag(robot.inertia), inertia * (robot.mass / mass) ** (5.0 / 3.0), rtol=5e-4
    )
    maneuvers = resolve(specified, robot, 1.0).requirement.maneuvers
    angles = np.degrees([maneuver.roll + maneuver.pitch + maneuver.yaw for maneuver in maneuvers])
    slews = set(
        zip(angles.round(6).tolist(), [maneuver.duration for maneuver in maneuvers], strict=True)
    )
    assert slews == {(90.0, 60.0), (45.0, 10.0)}
    # The other slews need less torque, 4 I theta / T^2, and less momentum, 2 I theta / T.
    hardest = 45.0 / 10.0**2, 45.0 / 10.0
    assert all(angle / time**2 <= hardest[0] for angle, time in SLEWS)
    assert all(angle / time <= hardest[1] for angle, time in SLEWS)


def test_the_push_is_that_which_an_ankle_balances():
    """75 kg with the centre of mass at 0.559 of 1.75 m: 4.75 N s at 2 cm."""
    push = standing.Push(75.0, 0.559 * 1.75)
    assert push.impulse == pytest.approx(4.75, abs=0.01)
    (maneuver,) = specification("backpack").maneuvers
    assert np.linalg.norm(maneuver.impulse) == pytest.approx(push.impulse, rel=1e-2)


def test_on_the_page_every_device_passes_but_not_the_mini_wheelbots_own_motor():
    """A slow test of the docs runs the script again and compares what it prints with the page."""
    page = (ROOT / "docs" / "machines.md").read_text()
    flown = re.findall(r"^flown +(.+)$", page, re.MULTILINE)
    assert len(flown) == len(load("compare").MACHINES)
    for passed, total in re.findall(r"(\d+) of (\d+)", " ".join(flown)):
        assert passed == total
    assert re.search(r"^same motor: .* MN4006 .*, and no rim of that size fits", page, re.MULTILINE)
