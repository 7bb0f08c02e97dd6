"""The reserve of a device for sampled deviations: its laws, and its effect in flights."""

from dataclasses import replace
from functools import cache
from statistics import NormalDist

import designed_devices
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.monte_carlo.campaign import fly_samples, make_campaign
from ocs_design.monte_carlo.summary import attitude_error
from ocs_design.monte_carlo.uncertainty import Uncertainty
from ocs_design.requirement.bound import roll_momentum_per_rate
from ocs_design.requirement.reading import parse_specification
from ocs_design.requirement.requirement import ManeuverReserve, Requirement
from ocs_design.requirement.specification import merge
from ocs_design.requirement.turns import Flip
from ocs_design.requirement.uncertainty import Constant
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.simulation.scenario import Flights
from ocs_design.sizing.design import design_device
from ocs_design.sizing.reserve import Reserve, ReserveNeeds
from ocs_design.sizing.selection.demand import ROLL_CANCELLED, roll_cancelling_momentum
from ocs_design.sizing.trajectory.plans import plan

FLIP = Flip(name="flip", gravity=1.62, jump_height=1.0, angle=-2.0 * np.pi, duration=2.0)
SOLO12 = """
[robot]
file = "examples/solo12.urdf"
[motor]
name = "AS2820 KV1050"
"""
THREE_MOTORS = """
[motor]
name = "Antigravity MN5006 KV450, AT2820 KV1050, AS2820 KV1050"
"""
LIGHTEST_MOTOR = """
[motor]
name = "Antigravity MN5006 KV450"
"""
WIDE = """
[reality]
mass_error = "normal(0, 6%)"
inertia_error = "normal(0, 15%)"
torque_constant_error = "normal(0, 6%)"
bus_voltage_error = "uniform(-25%, 20%)"
"""
VERY_WIDE = WIDE.replace("(-25%, 20%)", "(-35%, 15%)")
ONLY_FLIP = """
[[maneuver]]
kind = "flip"
name = "flip"
gravity = 1.62
jump_height = 1.0
angle = "-360deg"
duration = 2.0
"""

ONLY_DROP = """
[[maneuver]]
kind = "drop"
name = "drop"
height = 1.0
pitch = "30deg"
"""

YAWING_KICK = """
[[maneuver]]
kind = "disturbance"
name = "kick"
takeoff_velocity = [0.0, 2.4]
torque = [0.3, 0.4, 2.0]
onset = 0.1
duration = 0.05
"""

ON_AN_EDGE = """
[flywheel]
r_max = "80mm"
[[maneuver]]
kind = "balance"
name = "balance"
pivot = ["0mm", "0mm", "-240mm"]
edge = [0, 1, 0]
pitch = "3deg"
duration = "1.44s"
"""


def task_with(more):
    """Task for Solo12 with further lines of its specification."""
    specification = parse_specification(SOLO12, "test")
    if more:
        specification = merge(specification, parse_specification(more, "test"))
    return designed_devices.solo12().with_specification(specification)


@cache
def design_of(more="", reliability=None, scale=1.0):
    reserve = None if reliability is None else Reserve(reliability).raised(scale)
    return design_device(task_with(more), reserve=reserve, ranked=False)


def flights(more, time_after=0.1):
    """The lightest nominal design, its only maneuver, and a campaign of flights with seed 11.

    They end `time_after` [s] after touchdown.
    """
    more = f"{THREE_MOTORS}{more}"
    design, task = design_of(more, 0.5), task_with(more)
    robot, specification = task.robot, task.specification
    (maneuver,) = design.choice.problem.requirement.maneuvers
    plans = plan(robot.mass_properties, design.device, [maneuver])
    references = {name: each.trajectory for name, each in plans.items()}
    campaign = make_campaign(
        Flights(robot, design.device, [maneuver], references=references),
        can_stand=[True], uncertainty=Uncertainty.of(specification.reality, robot, design.device),
        seed=11,
    )  # fmt: skip
    (flight,) = campaign.flights
    world = replace(flight.world, duration=flight.world.flight_time + time_after)
    return design, maneuver, replace(campaign, flights=(replace(flight, world=world),))


def needs(factors, **values):
    count = factors.shape[1]
    defaults = {
        "achieved": np.ones(count),
        "remaining": np.ones(count),
        "roll_rates": np.zeros(factors.shape),
        "roll_rate_max": np.full(count, np.inf),
    }
    names = {f"m{index}": (0.0, 0.0) for index in range(count)}
    return ReserveNeeds(
        factors=factors,
        rates=names,
        drifts_off=np.zeros(factors.shape, bool),
        **(defaults | values),
    )


def test_each_of_two_maneuvers_must_be_more_reliable_than_both_together():
    """0.95 each is 0.9025 together: factors of exp(1.645 sigma)."""
    scores = np.random.default_rng(0).standard_normal((200_000, 2))
    factors, _ = needs(np.exp(scores * [0.05, 0.1])).at_reliability(0.95**2)
    expected = np.exp(NormalDist().inv_cdf(0.95) * np.array([0.05, 0.1]))
    np.testing.assert_allclose(factors, expected, rtol=2e-3)


def test_a_flip_and_its_roll_at_lift_off_must_each_be_more_reliable_than_both():
    """As above with |p| of a normal rate, whose 0.95 quantile is 1.960 sigma."""
    scores = np.random.default_rng(2).standard_normal((200_000, 2))
    factors, roll_rates = np.exp(0.1 * scores[:, :1]), 0.03 * np.abs(scores[:, 1:])
    tight = needs(factors, roll_rates=roll_rates, roll_rate_max=np.array([0.0]))
    factor, roll_rate = tight.at_reliability(0.95**2)
    np.testing.assert_allclose(factor, np.exp(0.1 * NormalDist().inv_cdf(0.95)), rtol=2e-3)
    np.testing.assert_allclose(roll_rate, 0.03 * NormalDist().inv_cdf(0.975), rtol=0.01)
    ample = replace(tight, roll_rate_max=np.array([1.0]))
    factor, _ = ample.at_reliability(0.95)
    np.testing.assert_allclose(factor, np.exp(0.1 * NormalDist().inv_cdf(0.95)), rtol=2e-3)
    achieving = replace(ample, achieved=factor, roll_rate_max=roll_rate)
    assert achieving.reliability == pytest.approx(0.95**2, abs=2e-3)


def test_the_log_factor_is_that_of_the_worst_maneuver_of_each_robot():
    """The median of the larger of two normal scores is 0.545, as Phi(0.545) = sqrt(0.5)."""
    scores = np.random.default_rng(1).standard_normal((200_000, 2))
    worst = needs(2.0 * np.exp(0.1 * scores), achieved=2.0 * np.ones(2)).log_factor(0.5)
    assert worst == pytest.approx(0.1 * NormalDist().inv_cdf(0.5**0.5), rel=0.02)


def test_a_maneuver_without_demand_is_not_the_worst():
    """NumPy once warned of the logarithm of zero."""
    idle = needs(np.array([[0.0], [0.0]]), achieved=np.array([np.inf]))
    assert np.isfinite(idle.log_factor(0.9))
    both = needs(np.array([[2.0, 0.0], [2.0, 0.0]]), achieved=np.array([1.0, np.inf]))
    assert both.log_factor(0.9) == pytest.approx(np.log(2.0))


def test_an_initial_rate_adds_momentum_until_the_end():
    """0.03 kg m^2 at 0.1 rad/s are 3 mN m s; the swept momentum of a turn is 2 pi I_yy."""
    reserves = {"flip": ManeuverReserve(1.1, (0.1, 0.02), 0.9)}
    requirement = Requirement((FLIP,), None, 1.0, None, reserves)
    inertia = TiltInertia.uncoupled([0.03, 0.055])
    plain = requirement.slew(FLIP, inertia)
    with_rate = requirement.slew(FLIP, inertia, with_rate=True)
    np.testing.assert_allclose(plain.swept, [0.0, -1.1 * 0.055 * 2.0 * np.pi], rtol=1e-12)
    np.testing.assert_allclose(plain.momentum, 0.0)
    np.testing.assert_allclose(with_rate.momentum, [0.9 * 0.003, 0.9 * 0.0011], rtol=1e-12)


@pytest.mark.slow
def test_no_reserve_is_kept_where_the_nominal_device_is_reliable_enough():
    """5 deg at touchdown and 5 % of the drive cover the default deviations."""
    nominal, reliable = design_of(LIGHTEST_MOTOR, 0.5), design_of(LIGHTEST_MOTOR)
    assert not nominal.reserve.maneuvers
    assert reliable.device.mass == nominal.device.mass
    assert reliable.kept.predicted >= 0.99
    assert all(each.needed < 1.0 for each in reliable.kept.maneuvers)


@pytest.mark.slow
def test_the_reserve_grows_with_reliability_and_deviations():
    designs = [design_of(WIDE, 0.8), design_of(WIDE, 0.99), design_of(WIDE, 0.99, 1.1)]
    demands = [[each.demand for each in one.reserve.maneuvers.values()] for one in designs]
    assert demands[0] < demands[1]
    assert np.all(np.diff(demands, axis=0) >= 0.0)
    masses = [one.device.mass for one in designs]
    assert masses[0] < masses[1] < masses[2]
    kept = designs[1].kept
    assert kept.predicted >= kept.reliability - 0.01
    # The plate's mass converges to 0.1 %, and changes the device's mass by 1 % of that.
    assert kept.nominal == pytest.approx(design_of(WIDE, 0.5).device.mass, rel=2e-4)
    curve = [mass for _, mass in kept.curve]
    assert curve == sorted(curve)


@pytest.mark.exhaustive
def test_a_supply_that_limits_braking_requires_a_larger_reserve():
    """It takes the wheels' energy back in more than the 0.2 s after the plan, 10 % of the time."""
    flip = f"{LIGHTEST_MOTOR}{ONLY_FLIP}"
    strong, weak = design_of(flip), design_of(f"{flip}\n[supply]\npower_max = 250.0\n")
    drive, wheel = weak.choice.chosen.line, weak.choice.chosen.spin_inertia
    energy = 0.5 * wheel * min(drive.no_load_speed, drive.speed_max) ** 2
    assert energy / drive.power_max > FLIP.flight_time - FLIP.duration
    assert weak.kept.maneuvers[0].needed > 1.05 * strong.kept.maneuvers[0].needed
    assert weak.kept.maneuvers[0].demand > 1.0


@pytest.mark.slow
def test_quantities_with_larger_shares_save_more_mass_when_known():
    """With 2048 robots, shares of 1 % are within sampling noise."""
    costs = design_of(WIDE, 0.99).kept.costs
    shares = [cost.share for cost in costs]
    saved = [cost.mass for cost in costs if cost.share > 0.05]
    assert len(saved) >= 3
    assert shares == sorted(shares, reverse=True)
    assert sum(shares) == pytest.approx(1.0)
    assert saved[0] > 3e-3
    np.testing.assert_allclose(saved, sorted(saved, reverse=True), atol=2e-4)


@pytest.mark.exhaustive
def test_an_incidence_without_roll_authority_is_not_chosen_where_roll_is_disturbed():
    more = f'{LIGHTEST_MOTOR}{ONLY_FLIP}\n[ocs]\nalpha_criterion = "lightest"\n'
    nominal, reliable = design_of(more, 0.5), design_of(more)
    assert nominal.device.incidence == pytest.approx(0.0, abs=1e-6)
    assert reliable.device.incidence > np.radians(2.0)
    # The plate, which converges last, costs one or two of 2048 robots.
    assert reliable.kept.predicted >= 0.99 - 2.0 / 2048


@pytest.mark.slow
def test_a_roll_rate_at_lift_off_requires_larger_wheels_or_another_incidence():
    """Up to 2.6 standard deviations of 0.5 rad/s: 99 % of a normal distribution, two-sided."""
    more = f'{ONLY_FLIP}\n[reality]\ntakeoff_rate = "normal(0, 0.5rad/s)"\n'
    calm, rolling = design_of(ONLY_FLIP), design_of(more)
    (flip,) = rolling.kept.maneuvers
    assert 1.2 < flip.undone < 1.5
    assert rolling.kept.predicted >= 0.99
    assert rolling.device.mass > calm.device.mass
    free = design_of(f'{more}[ocs]\nalpha_criterion = "lightest"\n')
    # The reserve was computed with another drive.
    assert free.device.mass < 1.02 * rolling.device.mass
    for design in (rolling, free):
        chosen = design.choice.chosen
        inertia, speed = chosen.total.inertia, 0.95 * chosen.line.no_load_speed
        capacity = 2.0 * chosen.spin_inertia * speed * np.sin(chosen.incidence)
        required = (
            roll_momentum_per_rate(inertia[0, 0], inertia[2, 2]) * flip.undone / ROLL_CANCELLED
        )
        assert capacity >= required * (1.0 - 1e-3)


def test_roll_momentum_is_required_only_of_wheels_that_control_roll_but_not_yaw():
    inertia, axes = TiltInertia.uncoupled([0.03, 0.05]), np.eye(3)
    requirement = Requirement((FLIP,), None, 1.0, None)
    assert roll_cancelling_momentum(0.1, inertia, 0.04, axes, requirement) == 0.0
    assert roll_cancelling_momentum(0.1, inertia, 0.04, axes[:, 1:2], requirement) == 0.0
    free = replace(requirement, incidence_is_free=True)
    assert roll_cancelling_momentum(0.1, inertia, 0.04, axes[:, 1:2], free) == np.inf
    along = np.array([[0.6, -0.6], [0.8, 0.8], [0.0, 0.0]])
    expected = 0.03 * (1.0 + 0.03 / 0.04) * 0.1 / ROLL_CANCELLED / 1.2
    momentum = roll_cancelling_momentum(0.1, inertia, 0.04, along, requirement)
    assert momentum == pytest.approx(expected, rel=1e-12)
    survives = replace(requirement, detection=0.02)
    assert roll_cancelling_momentum(0.1, inertia, 0.04, along, survives) == pytest.approx(
        2.0 * expected
    )


def test_the_momentum_that_cancels_a_roll_at_lift_off_agrees_with_the_closed_form():
    """Only roll and pitch are controlled, and the total momentum is constant in space.

    A uniform flip that rolls back at `p I_xx / I_zz cos t` ends level with at most
    `p I_xx (1 + I_xx / I_zz)` in its wheels; one that keeps zero roll rate ends off level by
    `T / 2` times the rate `p I_xx / I_zz`.
    """
    roll, yaw, rate, duration = 6.4, 1.4, 0.01, 3.5

    def flip(roll_back):
        """Final roll angle off level [rad], and largest roll momentum of the wheels [N m s]."""

        def slope(time, state):
            total = Rotation.from_quat(state).inv().apply([roll * rate, 0.0, 0.0])
            flip_rate = 2.0 * np.pi / duration
            omega = [-roll_back * np.cos(flip_rate * time), -flip_rate, total[2] / yaw]
            momenta.append(total[0] - roll * omega[0])
            x, y, z, w = state
            kinematics = np.array([[w, -z, y], [z, w, -x], [-y, x, w], [-x, -y, -z]])
            return 0.5 * kinematics @ omega

        momenta = []
        end = solve_ivp(slope, (0.0, duration), [0.0, 0.0, 0.0, 1.0], rtol=1e-9, atol=1e-12)
        up = Rotation.from_quat(end.y[:, -1]).inv().apply([0.0, 0.0, 1.0])
        return float(np.arcsin(up[1])), float(np.max(np.abs(momenta)))

    tilt, _ = flip(0.0)
    assert abs(tilt) == pytest.approx(rate * roll / yaw * duration / 2.0, rel=0.01)
    tilt, momentum = flip(rate * roll / yaw)
    assert abs(tilt) < 2e-4
    assert momentum == pytest.approx(rate * roll_momentum_per_rate(roll, yaw), rel=1e-3)


@pytest.mark.slow
def test_lost_reliability_of_a_flip_whose_roll_is_not_controlled():
    """A rate w over the time T is a tilt of w T, and 5 deg are allowed."""
    more = ONLY_FLIP + 'incidence = 0\n[reality]\ntakeoff_rate = "normal(0, 0.05rad/s)"\n'
    more += 'com_error = "0"\nattitude_bias = "0"\n'
    (flip,) = design_of(more).kept.maneuvers
    expected = 2.0 * NormalDist().cdf(-LANDING_TOLERANCE / (0.05 * FLIP.flight_time))
    assert flip.lost == pytest.approx(expected, abs=0.02)
    assert flip.roll_rate == flip.undone == 0.0
    free = f'{more}[ocs]\nalpha_criterion = "lightest"\n{ONLY_DROP}'
    design = design_of(free)
    assert [each.undone for each in design.kept.maneuvers] == [0.0, 0.0]
    assert all(np.isfinite(each.spin_inertia) for each in design.choice.chosen.demands)


@pytest.mark.slow
def test_as_many_drops_land_level_as_predicted():
    """With up to 70 % less k_t, within three standard deviations."""
    more = f'{ONLY_DROP}[reality]\ntorque_constant_error = "uniform(-70%, 0%)"\n'
    design, drop, campaign = flights(more)
    level = attitude_error(fly_samples(campaign, range(48)), drop, 0) <= LANDING_TOLERANCE
    expected = design.kept.predicted
    assert 0.2 < expected < 0.8
    assert level.mean() == pytest.approx(
        expected, abs=3.0 * np.sqrt(expected * (1 - expected) / 48)
    )


@pytest.mark.slow
def test_as_many_robots_balance_as_predicted():
    """Without their centre of mass and level in the reserve, all 48 were predicted."""
    design, _, campaign = flights(ON_AN_EDGE, time_after=1.0)
    upright = fly_samples(campaign, range(48)).passed
    expected = design.kept.predicted
    assert 0.4 < expected < 0.9
    assert upright.mean() == pytest.approx(
        expected, abs=3.0 * np.sqrt(expected * (1 - expected) / 48)
    )


@pytest.mark.slow
def test_wheels_that_act_about_the_vertical_stop_a_kick_that_yaws():
    """Sized for roll and pitch alone, those that ran up against the yaw were missing for these."""
    more = f'[ocs]\nlayout = "pyramid"\n{YAWING_KICK}'
    design, kick, campaign = flights(more)
    assert design.kept.predicted > 0.99
    level = attitude_error(fly_samples(campaign, range(16)), kick, 0) <= LANDING_TOLERANCE
    assert level.all()


def test_the_reserve_for_a_pivot_counts_the_centre_of_mass_and_the_level():
    design = design_of(f"{LIGHTEST_MOTOR}{ON_AN_EDGE}", 0.5)
    share = {cost.key: cost.share for cost in design.kept.costs}
    assert min(share["attitude_bias"], share["com_error"]) > 0.1
    (surer,) = design_of(f"{LIGHTEST_MOTOR}{ON_AN_EDGE}", 0.95).kept.maneuvers
    assert surer.needed > 1.05


@pytest.mark.exhaustive
def test_the_quantity_with_the_largest_share_rescues_the_most_flights_when_known():
    """Failed flights are repeated with one quantity at its mean and all others as sampled.

    Deviations are so large that a quarter fails. The quantity with the largest share in the closed
    forms rescues most of them; with smaller shares they end farther off level.
    """
    more = f"{ONLY_FLIP}[validation]\nballistic = true\n{VERY_WIDE}"
    design, maneuver, campaign = flights(more)

    def off_level(indices, key=None):
        spreads = dict(campaign.uncertainty.spreads)
        if key is not None:
            spreads[key] = Constant(spreads[key].at(0.5))
        uncertainty = replace(campaign.uncertainty, spreads=spreads)
        outcomes = fly_samples(replace(campaign, uncertainty=uncertainty), indices)
        return attitude_error(outcomes, maneuver, 0)

    failing = np.flatnonzero(off_level(range(28)) > LANDING_TOLERANCE).tolist()
    assert len(failing) >= 6
    share = {cost.key: cost.share for cost in design.kept.costs}
    order = ["bus_voltage_error", "inertia_error", "com_error"]
    assert share[order[0]] > 3.0 * share[order[1]] > 9.0 * share[order[2]]
    known = [off_level(failing, key) for key in order]
    assert (known[0] <= LANDING_TOLERANCE).mean() > 0.6
    assert all((each <= LANDING_TOLERANCE).mean() < 0.3 for each in known[1:])
    assert known[0].mean() < known[1].mean() < known[2].mean()
