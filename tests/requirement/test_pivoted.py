"""Standing up and balancing about a pivot: closed forms against published figures and ODEs."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.common.errors import SpecificationError
from ocs_design.requirement.bound import spin_demands
from ocs_design.requirement.pivoted import Balance, StandUp, swing
from ocs_design.requirement.reading import parse_specification
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.resolving import resolve
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.mass import MassProperties

ROBOT = robot_by_hand(1.0, (0.01, 0.01, 0.01))
ANY = TiltInertia.uncoupled([1.0, 1.0])
EDGE = {"pivot": (0.0, 0.0, -0.085), "edge": (1.0, 0.0, 0.0)}


def test_braking_from_the_speed_of_the_cubli():
    """Gajamohan et al. (IROS 2012): a plate of 0.419 kg at 75 mm, a wheel of 0.204 kg at 85 mm.

    `W^2 = (2 - sqrt 2) (I_w + I_b + m_w l^2) (m_b l_b + m_w l) g / I_w^2`, I_b about the edge.
    """
    m_b, l_b, i_b, m_w, l_w, i_w, g = 0.419, 0.075, 3.34e-3, 0.204, 0.085, 0.57e-3, 9.81
    speed = np.sqrt((2 - np.sqrt(2)) * (i_w + i_b + m_w * l_w**2) * (m_b * l_b + m_w * l_w) * g)
    mass, com = m_b + m_w, (m_b * l_b + m_w * l_w) / (m_b + m_w)
    about_com = i_w + i_b + m_w * l_w**2 - mass * com**2
    body = MassProperties(mass, np.array([0.0, 0.0, com]), np.eye(3) * about_com)
    edge = {"pivot": (0.0, 0.0, 0.0), "edge": (0.0, 2.0, 0.0)}
    jump = StandUp(name="up", **edge, pitch=-np.pi / 4.0, duration=1.0, actuation="brake").on(body)
    np.testing.assert_allclose(jump.momentum(ANY) / i_w, [0.0, speed / i_w], rtol=1e-12)
    # Right after braking the kinetic energy is that of the rise.
    rise = mass * g * com * (1.0 - np.cos(np.pi / 4.0))
    assert 0.5 * jump.initial_rate @ jump.inertia @ jump.initial_rate == pytest.approx(
        rise, rel=1e-12
    )
    assert jump.initial_rate[1] > 0.0
    np.testing.assert_array_equal(jump.least_torque(ANY), 0.0)
    # During braking, gravity takes 2 % of the momentum of a small tilt.
    pole = np.sqrt((m_b * l_b + m_w * l_w) * g / (i_w + i_b + m_w * l_w**2))
    assert jump.braking_time == pytest.approx(0.02 / pole, rel=1e-12)
    assert jump.braking_time == pytest.approx(2.1e-3, rel=0.02)


@pytest.mark.slow
@given(
    tilt=st.floats(-0.5, 0.5),
    rate=st.floats(-2.0, 2.0),
    time=st.floats(0.2, 1.0),
    stiffness=st.floats(0.5, 2.0),
)
def test_a_swing_ends_upright_and_at_rest(tilt, rate, time, stiffness):
    inertia = 0.02
    pole = np.sqrt(stiffness / inertia)
    diverging, converging = tilt + rate / pole, tilt - rate / pole
    # Too fast on its way up, it would need a first torque in the sense of the tilt.
    if abs(diverging) < 1e-3 or converging / diverging < -np.exp(-pole * time):
        diverging = max(abs(diverging), 1e-3)
        tilt, rate = diverging, 0.0
    plan = swing(stiffness, inertia, tilt, rate, time)
    sense = np.sign(tilt + rate / pole)

    def slope(torque):
        return lambda _, y: [y[1], (stiffness * y[0] - torque) / inertia]

    limits = {"rtol": 1e-10, "atol": 1e-12}
    up = solve_ivp(slope(sense * plan.torque), (0.0, plan.switch), [tilt, rate], **limits)
    span = (plan.switch, time)
    end = solve_ivp(slope(-sense * plan.torque), span, up.y[:, -1], **limits).y[:, -1]
    np.testing.assert_allclose(end, 0.0, atol=1e-6)


@pytest.mark.parametrize("pitch", [0.3, -0.3])
def test_a_wheel_that_starts_spinning_backwards_may_be_smaller(pitch):
    """Its speed may change by w + w_max."""
    body = MassProperties(2.0, np.array([0.0, 0.0, 0.015]), np.diag([0.01, 0.02, 0.03]))
    edge = {"pivot": (0.0, 0.0, -0.085), "edge": (0.0, 1.0, 0.0)}
    up = StandUp(name="up", **edge, pitch=pitch, duration=0.5)
    required = []
    for speed in (0.0, -50.0 * np.sign(pitch), 50.0 * np.sign(pitch)):
        climb = replace(up, wheel_speed=speed).on(body)
        requirement = Requirement((climb,), None, 200.0, None)
        required.append(spin_demands(requirement, lambda _: body.inertia, 0.6)[0].spin_inertia)
    assert required[0] / required[1] == pytest.approx(250.0 / 200.0)
    assert required[0] / required[2] == pytest.approx(150.0 / 200.0)


def test_an_impulse_turns_about_the_edge_by_the_inertia_there():
    body = MassProperties(2.0, np.array([0.0, 0.0, 0.015]), np.diag([0.01, 0.02, 0.03]))
    hit = Balance(name="hit", **EDGE, impulse=(0.3, -0.5, 0.0), point=(0.0, 0.0, 0.115), duration=1)
    rate = hit.on(body).rate_after_disturbance
    # 0.5 N s to the right at 0.2 m about 0.01 + 2 (0.1 m)^2.
    np.testing.assert_allclose(rate, [0.5 * 0.2 / 0.03, 0.0, 0.0], atol=1e-14)


def test_a_pivot_above_the_centre_of_mass_is_refused():
    body = MassProperties(1.0, np.array([0.0, 0.0, -0.1]), np.eye(3))
    with pytest.raises(SpecificationError, match="pivot is 15 mm above") as caught:
        Balance(name="b", **EDGE, roll=0.1, duration=1.0).on(body)
    assert "-100 mm" in caught.value.hint
    with pytest.raises(SpecificationError, match="edge is vertical"):
        Balance(name="b", edge=(0.0, 0.0, 1.0), pivot=EDGE["pivot"], duration=1.0).on(body)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ('pitch = "5deg"', "axis other than the edge, which is along (1, 0, 0)"),
        ('roll = "120deg"', "below its pivot: 90 deg at most"),
        ('end = "at rest"', "one of level, attitude"),
        ("edge = [1, 0, 1]", "edge: must be level"),
        ("edge = [0, 0, 0]", "give the edge that it stands on"),
        ('actuation = "spring"', "one of motor, brake"),
    ],
)
def test_invalid_pivoted_maneuvers_are_refused(changed, message):
    text = """
        [robot]
        mass = 1.0
        inertia = [0.01, 0.01, 0.01]
        [ocs]
        axes = [1, 0, 0]
        [[maneuver]]
        kind = "stand-up"
        name = "up"
        pivot = [0, 0, -0.1]
        edge = [1, 0, 0]
        roll = 0.2
        duration = 0.5
        """
    key = changed.split(" ")[0]
    lines = [line for line in text.splitlines() if line.split() and line.split()[0] != key]
    with pytest.raises(SpecificationError) as error:
        resolve(parse_specification("\n".join([*lines, changed]), "spec"), ROBOT, 1.0)
    assert any(message in each for each in error.value.problems), error.value.problems
