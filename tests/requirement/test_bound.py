"""The bound on the spin inertia: worked examples, MuJoCo, and the rhombus of two wheels."""

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.requirement.bound import (
    bound_curve,
    corrected_bound,
    elroy_beanie_bound,
    per_wheel,
    spin_demands,
)
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.turns import Drop, Flip

INERTIA, RATE_CHANGE, WHEEL_SPEED = 0.0515, 2.0, 750.0
TOTAL = np.diag([0.03, 0.0535, 0.068])

FREE_WHEELS = """
<mujoco>
  <option gravity="0 0 0" timestep="1e-4" integrator="RK4"/>
  <worldbody>
    <body name="trunk">
      <freejoint/>
      <inertial pos="0 0 0" mass="2.5" diaginertia="{trunk}"/>
      {wheels}
    </body>
  </worldbody>
  <actuator>{motors}</actuator>
</mujoco>
"""


def spun_up(trunk: list[float], wheels: list[tuple], speed: float) -> tuple:
    """Trunk rates [rad/s] once MuJoCo's servos hold the wheels' speed, and total braked inertia.

    Each wheel is (position, axis, spin inertia, transverse inertia, mass, sign of its speed).
    """
    bodies, motors = [], []
    for index, (position, axis, spin, transverse, mass, _) in enumerate(wheels):
        bodies.append(
            f'<body pos="{position}" zaxis="{axis}"><joint name="w{index}" axis="0 0 1"/>'
            f'<inertial pos="0 0 0" mass="{mass}" diaginertia="{transverse} {transverse} {spin}"/>'
            "</body>"
        )
        # A time constant of 5 ms is fast, and slow enough for the time step.
        motors.append(f'<velocity joint="w{index}" kv="{spin / 5e-3}"/>')
    model = mujoco.MjModel.from_xml_string(
        FREE_WHEELS.format(
            trunk=" ".join(map(str, trunk)), wheels="".join(bodies), motors="".join(motors)
        )
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    braked = total_inertia(model, data)
    data.ctrl[:] = [speed * wheel[-1] for wheel in wheels]
    mujoco.mj_step(model, data, 2000)
    np.testing.assert_allclose(data.qvel[6:], data.ctrl, rtol=1e-9)
    return data.qvel[3:6].copy(), braked


def total_inertia(model, data) -> np.ndarray:
    """MuJoCo's total inertia about the centre of mass, joints locked."""
    mass_matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass_matrix)
    lever = mass_matrix[:3, 3:6]
    return mass_matrix[3:6, 3:6] - lever.T @ lever / mass_matrix[0, 0]


def elroy_beanie_rate(spin_inertia: float) -> float:
    """Rate change of the trunk about y in the paper's two-body model [rad/s]."""
    wheel = ("0 0 0", "0 1 0", spin_inertia, spin_inertia, 1e-3, 1.0)
    rates, _ = spun_up([0.03, INERTIA, 0.068], [wheel], WHEEL_SPEED)
    assert rates[[0, 2]] == pytest.approx(0.0, abs=1e-9)
    return abs(rates[1])


def test_worked_example_of_the_paper():
    printed = elroy_beanie_bound(INERTIA, RATE_CHANGE, WHEEL_SPEED)
    assert printed == pytest.approx(1.36968e-4, rel=1e-5)
    one_of_two = per_wheel(np.array([0.0, printed]), np.radians(40.0))
    assert one_of_two == pytest.approx(8.9399e-5, rel=1e-5)


def test_the_printed_bound_is_too_low_by_twice_the_ratio_of_rates():
    required = corrected_bound(INERTIA, RATE_CHANGE, WHEEL_SPEED)
    assert required == pytest.approx(1.3770e-4, rel=1e-4)
    shortfall = 1.0 - elroy_beanie_bound(INERTIA, RATE_CHANGE, WHEEL_SPEED) / required
    assert shortfall == pytest.approx(2 * RATE_CHANGE / WHEEL_SPEED, rel=5e-3)


def test_mujoco_confirms_the_corrected_bound_and_not_the_printed_one():
    required = corrected_bound(INERTIA, RATE_CHANGE, WHEEL_SPEED)
    assert elroy_beanie_rate(required) == pytest.approx(RATE_CHANGE, rel=1e-6)
    printed = elroy_beanie_bound(INERTIA, RATE_CHANGE, WHEEL_SPEED)
    shortfall = 1.0 - elroy_beanie_rate(printed) / RATE_CHANGE
    assert shortfall == pytest.approx(2 * RATE_CHANGE / WHEEL_SPEED, rel=1e-2)


@pytest.mark.parametrize(("axis", "signs"), [(1, (1.0, 1.0)), (0, (1.0, -1.0))])
def test_mujoco_confirms_the_demand_of_two_wheels_beside_the_trunk(axis, signs):
    """The total inertia includes masses, levers and transverse inertias of the wheels."""
    alpha, trunk = np.radians(40.0), [0.03, INERTIA, 0.068]
    sine, cosine = np.sin(alpha), np.cos(alpha)

    def pair(spin: float) -> list[tuple]:
        return [
            ("0 0.1 0.05", f"{sine} {cosine} 0", spin, 6e-5, 0.1, signs[0]),
            ("0 -0.1 0.05", f"{-sine} {cosine} 0", spin, 6e-5, 0.1, signs[1]),
        ]

    requirement = Requirement((), RATE_CHANGE, WHEEL_SPEED, None)
    spin = 1e-4
    for _ in range(8):  # the total includes the wheels' own inertia
        _, total = spun_up(trunk, pair(spin), 0.0)
        spin = spin_demands(requirement, lambda _, total=total: total, alpha)[axis].spin_inertia
    rates, _ = spun_up(trunk, pair(spin), WHEEL_SPEED)
    assert abs(rates[axis]) == pytest.approx(RATE_CHANGE, rel=1e-6)


def test_a_rate_change_beyond_the_wheel_speed_is_infeasible():
    assert corrected_bound(INERTIA, 750.0, 750.0) == np.inf
    assert corrected_bound(INERTIA, 800.0, 750.0) == np.inf
    assert per_wheel(np.array([0.0, 1e-4]), np.pi / 2) == np.inf


def test_curve_is_the_bound_at_each_point():
    changes, speeds = np.array([0.5, 2.0, 700.0]), np.array([300.0, 750.0])
    curve = bound_curve(changes, speeds)
    expected = [[corrected_bound(1.0, d, gamma) for d in changes] for gamma in speeds]
    np.testing.assert_allclose(curve, expected, rtol=1e-15)
    assert curve.shape == (2, 3)
    assert np.isinf(curve[0, 2])


@given(
    roll=st.floats(0, 1),
    pitch=st.floats(0, 1),
    incidence=st.floats(0.05, 1.5),
    speed=st.floats(10, 1e4),
)
def test_spin_inertia_per_wheel_is_the_smallest_sufficient_one(roll, pitch, incidence, speed):
    """The larger momentum of both wheels, which solve C h = L."""
    axes = [[np.sin(incidence), -np.sin(incidence)], [np.cos(incidence), np.cos(incidence)]]
    momenta = np.linalg.solve(axes, [roll, pitch])
    least = per_wheel(np.array([roll, pitch]), incidence) / speed
    assert least == pytest.approx(np.abs(momenta).max() / speed, rel=1e-9, abs=1e-300)


def test_zero_momentum_about_an_uncontrolled_axis_is_feasible():
    assert per_wheel(np.array([0.0, 2.0]), 0.0) == pytest.approx(1.0)
    assert per_wheel(np.array([2.0, 0.0]), np.pi / 2) == pytest.approx(1.0)
    assert per_wheel(np.zeros(2), 0.0) == 0.0


def test_momentum_about_an_uncontrolled_axis_is_an_infinite_demand_that_names_it():
    requirement = Requirement((), 2.0, 750.0, None)
    roll, pitch = spin_demands(requirement, lambda _: TOTAL, 0.0)
    assert (roll.source, roll.unreachable_axes) == ("rate change, roll", ("roll",))
    assert roll.spin_inertia == np.inf
    assert pitch.unreachable_axes == ()
    assert pitch.spin_inertia == pytest.approx(0.0535 * 2.0 / (2 * 750.0))
    *_, pitch = spin_demands(requirement, lambda _: TOTAL, np.pi / 2)
    assert pitch.unreachable_axes == ("pitch",)


def test_each_maneuver_has_its_own_incidence():
    maneuvers = (
        Disturbance(
            name="push",
            takeoff_velocity=(0.0, 2.0),
            torque=(0.2, -0.8, 5.0),
            onset=0.1,
            duration=0.05,
        ),
        Drop(name="drop", standing_height=0.25, height=1.0, pitch=np.radians(30.0)),
        Flip(name="flip", gravity=1.62, incidence=0.0, jump_height=1.0, angle=-6.28, duration=2.0),
    )
    alpha = np.radians(40.0)
    push, drop, flip = spin_demands(
        Requirement(maneuvers, None, 750.0, None), lambda _: TOTAL, alpha
    )
    np.testing.assert_allclose(push.momentum, [0.01, 0.04])
    assert push.spin_inertia == pytest.approx(
        (0.01 / np.sin(alpha) + 0.04 / np.cos(alpha)) / (2 * 750.0)
    )
    assert drop.incidence == alpha
    assert flip.incidence == 0.0
    assert flip.spin_inertia == pytest.approx(0.0535 * 6.28 / (2 * 750.0))


def test_the_demand_of_a_braked_total_is_the_corrected_bound():
    """(I_r + I_f) d = I_f gamma, with the wheel included in the total."""
    required = corrected_bound(INERTIA, RATE_CHANGE, WHEEL_SPEED)
    requirement = Requirement((), RATE_CHANGE, WHEEL_SPEED, None)
    total = np.diag([0.03, INERTIA + required, 0.068])
    _, pitch = spin_demands(requirement, lambda _: total, 0.0)
    assert 2 * pitch.spin_inertia == pytest.approx(required, rel=1e-14)
