"""The paper's three experiments on Solo12 (docs/validation.md), and scaled to other robots."""

from dataclasses import replace

import numpy as np
import pytest
from robots import ROBOTS
from subsets import slow_subset
from wheels import motor, paper_device, paper_maneuvers, scaled_device

from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scenario import Flights, Options, run_scenarios
from ocs_design.simulation.wheel_law import Allocation

pytestmark = pytest.mark.slow

RPM = np.pi / 30.0


@pytest.fixture(scope="module")
def maneuvers(solo12):
    """The numbers of the paper; scaled defaults of Solo12 deviate by 0.1 %."""
    jump, drop, flip = paper_maneuvers(solo12)
    jump = replace(jump, torque=(0.2, 0.8, 0.0), onset=0.1, duration=0.05)
    high = replace(jump, name="high jump", takeoff_velocity=(jump.takeoff_velocity[0], 4.5))
    return jump, replace(drop, height=1.0), replace(flip, jump_height=1.0, duration=2.0), high


@pytest.fixture(scope="module")
def runs(solo12, maneuvers):
    flown = run_scenarios(Flights(solo12, paper_device(), maneuvers))
    return {(run.scenario, run.ocs): run for run in flown}


def test_after_a_jump_at_4_5_m_s_the_bare_robot_turns_over(runs):
    assert not runs["high jump", False].metrics.upright_at_end


def test_the_papers_step_needs_the_torque_of_the_theory(solo12, maneuvers):
    options = Options(drop_at_once=True)
    run, _ = run_scenarios(Flights(solo12, paper_device(), maneuvers[1:2], options=options))
    assert run.passed is True, run.reason
    assert run.metrics.peak_wheel_torque == pytest.approx(1.06, rel=0.1)
    assert run.metrics.peak_wheel_speed / RPM == pytest.approx(8200, rel=0.1)


def test_the_papers_transpose_passes_too(solo12, maneuvers):
    options = Options(allocation=Allocation.TRANSPOSE)
    runs = run_scenarios(Flights(solo12, paper_device(), maneuvers[:3], options=options))
    assert [run.passed for run in runs] == [True, False] * 3


def test_a_motor_that_is_too_weak_fails_with_a_reason(solo12, maneuvers):
    """docs/theory.md, What a motor can do: 0.30 N m are too little for the drop with any wheel."""
    device = paper_device(drive=motor(1000.0, None, 0.2))
    run, _ = run_scenarios(Flights(solo12, device, maneuvers[1:2]))
    assert run.passed is False
    assert "more than 5 deg off level" in run.reason
    assert "step" in run.note
    assert run.metrics.peak_wheel_torque <= 0.2


def test_an_unstable_simulation_is_not_judged(solo12, maneuvers, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    runs = run_scenarios(Flights(solo12, paper_device(), [replace(maneuvers[1], gravity=1e200)]))
    assert [run.passed for run in runs] == [None, None]
    assert all("became unstable" in run.reason for run in runs)
    assert not list(tmp_path.iterdir()), "MuJoCo left its log behind"


QUADRUPEDS = [
    "a1_description/urdf/a1",
    "anymal_c_simple_description/urdf/anymal",
    "hyq_description/robots/hyq_no_sensors",
]
BIPEDS = [
    "bolt_description/robots/bolt",
    "icub_description/robots/icub",
    "talos_data/robots/talos_full_v2",
]


def fly(path):
    robot = read_robot(ROBOTS / f"{path}.urdf")
    return run_scenarios(Flights(robot, scaled_device(robot), paper_maneuvers(robot)))


@pytest.mark.parametrize("path", slow_subset(3, [*QUADRUPEDS, *BIPEDS]))
def test_flights_conserve_momentum_and_land_level_with_the_device(path):
    runs = fly(path)
    if path in QUADRUPEDS:
        assert [run.passed for run in runs] == [True, False] * 3
    for run in runs:
        assert run.metrics.momentum_error < 1e-7
        tilt = max(abs(run.metrics.touchdown_roll), abs(run.metrics.touchdown_pitch))
        flipped = abs(run.metrics.turned_angle) > np.radians(355.0)
        if run.ocs:
            assert tilt < np.radians(5.0), run.reason
            assert flipped == (run.scenario == "back-flip")
        else:
            assert run.passed is False


def test_a_biped_without_balance_is_judged_on_touchdown_alone():
    """On Earth it falls over on its joint drives; with a sixth of the weight it stands."""
    runs = fly("bolt_description/robots/bolt")
    assert [run.passed for run in runs] == [True, False] * 3
    jump, drop, flip = (run.reason for run in runs if run.ocs)
    assert "standing is not judged" in jump
    assert "standing is not judged" in drop
    assert "and stands" in flip
