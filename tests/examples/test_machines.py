"""The machines of docs/machines.md: what is asked for follows from what was published of them."""

import importlib.util
import sys
from functools import cache
from math import cos, degrees, pi, sqrt
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ocs_design.actuation.drive import DriveLine
from ocs_design.actuation.slew import slew_time
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import WheelTask, smallest_spin_inertia
from ocs_design.device.layout import module_axes
from ocs_design.parts.rim import cylinder_spin_inertia, cylinder_transverse_inertia
from ocs_design.requirement.froude import standing_height
from ocs_design.requirement.reading import read_specification
from ocs_design.requirement.resolving import read_specified_robot

ROOT = Path(__file__).parents[2]
MACHINES = ROOT / "examples" / "machines"
HEAVIER = 10.0
"""How much more inert, and how much less turned, the specifications have the bodies on a foot."""


def load(name):
    """A script beside the specifications."""
    spec = importlib.util.spec_from_file_location(f"machines_{name}", MACHINES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


standing = load("standing")
ROLL, PITCH = standing.REX_HOPPER_INERTIA
STANDING = {
    "wheelbot": standing.wheelbot(),
    "aalborg_cubli": standing.aalborg_cubli(),
    "rex_hopper, roll": standing.rex_hopper(ROLL),
    "rex_hopper, pitch": standing.rex_hopper(PITCH),
}


@pytest.mark.parametrize("machine", STANDING.values(), ids=list(STANDING))
def test_the_push_brings_the_machine_up_to_where_it_coasts_upright(machine):
    def motion(_, state):
        gravity = machine.gravity_moment * np.sin(state[0])
        return [state[1], (gravity - machine.torque) / machine.inertia]

    end = (0.0, machine.push_time)
    pushed = solve_ivp(motion, end, [machine.tilt, 0.0], rtol=1e-11, atol=1e-12).y[:, -1]
    energy = machine.inertia * pushed[1] ** 2 / 2.0
    assert pushed[1] < 0.0
    assert energy == pytest.approx(machine.gravity_moment * (1.0 - cos(pushed[0])), rel=1e-7)


@pytest.mark.parametrize("machine", STANDING.values(), ids=list(STANDING))
def test_the_turn_without_gravity_takes_the_same_torque_and_momentum(machine):
    angle, duration = machine.turn
    # One wheel with an inertia far below the machine's, torque alone.
    wheel = 1e-6 * machine.inertia
    line = DriveLine(np.inf, 1e12, machine.torque, np.inf)
    time = float(slew_time(machine.inertia * angle / wheel, wheel, line))
    assert time == pytest.approx(duration, rel=1e-9)
    assert machine.torque * time / 2.0 == pytest.approx(machine.momentum, rel=1e-9)


def test_a_wheel_weaker_than_gravity_does_not_stand_up():
    weak = standing.Standing("weak", inertia=1.0, gravity_moment=1.0, tilt=0.5, torque=0.4)
    with pytest.raises(ValueError, match="gravity is stronger"):
        _ = weak.push_time


def specification(name):
    return read_specification(MACHINES / f"{name}.toml")


@pytest.mark.parametrize(
    ("name", "axis", "machine", "copies"),
    [
        ("wheelbot", 1, "wheelbot", 2),
        ("aalborg_cubli", 1, "aalborg_cubli", 2),
        ("rex_hopper", 0, "rex_hopper, roll", 1),
        ("rex_hopper", 1, "rex_hopper, pitch", 1),
    ],
)
def test_the_specifications_ask_for_these_turns(name, axis, machine, copies):
    stated = specification(name)
    robot = read_specified_robot(stated)
    wanted = STANDING[machine]
    angle, duration = wanted.turn
    inertia = np.diag(robot.inertia)[:2]
    assert inertia[axis] == pytest.approx(copies * wanted.inertia * HEAVIER, rel=5e-4)
    slews = [
        one.slew(TiltInertia.uncoupled(inertia), standing_height(robot)) for one in stated.maneuvers
    ]
    (slew,) = [one for one in slews if one.swept[axis] > 0.0]
    assert slew.swept[axis] == pytest.approx(copies * wanted.inertia * angle, rel=5e-4)
    assert slew.duration == pytest.approx(duration, rel=2e-4)


def test_rex_hopper_aims_its_leg_within_its_jump():
    stated = specification("rex_hopper_flight")
    robot = read_specified_robot(stated)
    flight = 2.0 * sqrt(2.0 * 0.5 / 9.807)  # actuator_calc.ipynb
    for maneuver in stated.maneuvers:
        slew = maneuver.slew(TiltInertia.uncoupled(np.ones(2)), standing_height(robot))
        assert slew.duration == pytest.approx(flight, rel=2e-3)
        assert degrees(slew.swept.max()) == pytest.approx(degrees(np.arctan(0.5)), rel=1e-4)


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
"""Mass properties and places of the links, as hopper_rev10_mjcf.xml has them."""


def test_rex_hopper_is_the_sum_of_its_links():
    model = mujoco.MjModel.from_xml_string(REX_HOPPER_LINKS)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    com, inertia = data.subtree_com[0], np.zeros((3, 3))
    for body in range(1, model.nbody):
        turn = data.ximat[body].reshape(3, 3)
        arm = data.xipos[body] - com
        inertia += turn @ np.diag(model.body_inertia[body]) @ turn.T
        inertia += model.body_mass[body] * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    robot = read_specified_robot(specification("rex_hopper_flight"))
    assert robot.mass == pytest.approx(model.body_mass.sum(), abs=5e-5)
    np.testing.assert_allclose(robot.inertia, inertia, atol=1e-6)
    assert np.diag(inertia)[:2] == pytest.approx(standing.REX_HOPPER_INERTIA, abs=1e-6)
    assert com[2] == pytest.approx(0.0057, abs=5e-5)


@pytest.mark.parametrize(
    ("name", "mass", "spin", "across"),
    [("wheelbot", 0.3, 5.03e-4, 2.59e-4), ("rex_hopper", 0.78203, 6.60959e-3, 3.3873e-3)],
)
def test_the_room_for_a_rim_is_that_of_the_wheel_as_built(name, mass, spin, across):
    """The hollow cylinder with the stated mass and both stated inertias."""
    room = specification(name).flywheel
    height = sqrt(12.0 / mass * (across - spin / 2.0))
    assert room.h_max == pytest.approx(height, rel=0.02)
    gyration = sqrt(spin / mass)
    assert room.r_max >= gyration * (1.0 - 2e-3)
    outer = max(room.r_max, gyration)
    inner = sqrt(max(2.0 * spin / mass - outer**2, 0.0))
    if outer - inner > 1e-3:
        density = mass / (pi * height * (outer**2 - inner**2))
        assert cylinder_spin_inertia(inner, outer, height, density) == pytest.approx(spin)
        assert cylinder_transverse_inertia(inner, outer, height, density) == pytest.approx(across)


def test_the_wheelbots_own_motor_line_asks_for_nearly_its_own_wheel():
    """Figures of docs/machines.md: 1.6 N m at rest and 2,700 rpm without load."""
    line = DriveLine(1.6, 2700.0 * pi / 30.0, np.inf, np.inf)
    machine = STANDING["wheelbot"]
    angle, duration = machine.turn
    inertia = 2.0 * machine.inertia * HEAVIER
    task = WheelTask(
        swept=np.array([0.0, inertia * angle / HEAVIER]),
        momentum=np.zeros(2),
        duration=duration,
        inertia=TiltInertia.uncoupled([inertia, inertia]),
        axes=module_axes(0.0)[:2],
    )
    assert float(smallest_spin_inertia(task, line)) == pytest.approx(0.545e-3, rel=1e-3)
    reserved = float(smallest_spin_inertia(task, line.reserved()))
    assert reserved == pytest.approx(0.603e-3, rel=1e-3)


def test_a_machine_comes_out_as_it_was_built(comparison):
    """What docs/machines.md claims of REx Hopper, and the same for Wheelbot's wheel."""
    stated = specification("rex_hopper")
    free = comparison.lightest(comparison.with_any_motor(stated), None)
    assert free.motor.name == "R100 KV90"
    assert free.gear.name == "direct"
    assert degrees(free.incidence) == pytest.approx(45.0, abs=1.5)
    built = {one.specification: one for one in comparison.MACHINES}
    for name, share in (("rex_hopper", 0.69), ("wheelbot", 1.01)):
        same = comparison.lightest(specification(name), built[name].incidence)
        assert same.spin_inertia / built[name].spin_inertia == pytest.approx(share, abs=0.01)


@pytest.mark.exhaustive
def test_the_page_shows_what_the_script_prints(comparison, capsys):
    comparison.main()
    printed = [line.rstrip() for line in capsys.readouterr().out.rstrip().splitlines()]
    page = (ROOT / "docs" / "machines.md").read_text()
    assert "\n".join(printed) in page


@pytest.fixture(scope="module")
def comparison():
    script = load("compare")
    # Each device takes seconds.
    script.lightest = cache(script.lightest)
    return script
