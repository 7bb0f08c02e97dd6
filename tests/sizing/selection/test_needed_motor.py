"""The motor that a refusal recommends: it makes a device feasible, and a weaker one does not."""

import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scripts import script_at
from selections import random_problem

from ocs_design.actuation.motor import DIRECT
from ocs_design.requirement.bound import spin_demands
from ocs_design.requirement.pivoted import Balance
from ocs_design.sizing.advice import NeededMotor, advice_on, needed_motor
from ocs_design.sizing.selection.rejections import Refused
from ocs_design.sizing.selection.select import select

BENCHMARKS = Path(__file__).parents[3] / "benchmarks"
SEEDS = (0, 3, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in (9, 12, 17, 21)))


def weak_problem(seed):
    """A problem with motors of a tenth of the torque, and the first of them."""
    problem = replace(random_problem(seed, motors=2, mounted=False), incidence=0.6)
    weak = tuple(
        replace(motor, peak_torque=0.1 * motor.peak_torque, mass=0.1 * motor.mass)
        for motor in problem.motors
    )
    return replace(problem, motors=weak), weak[0]


def motor_as_needed(need, model, share=1.0):
    """The recommended motor, or one with a share of its torque, similar in shape to a model."""
    peak = share * need.peak_torque
    ratio = peak / model.peak_torque
    stall = model.rated_voltage * model.torque_constant / model.resistance / model.peak_torque
    constant = need.voltage / need.no_load_speed
    return replace(
        model,
        peak_torque=peak,
        mass=share * need.mass,
        diameter=model.diameter * np.cbrt(ratio),
        length=model.length * np.cbrt(ratio),
        rotor_inertia=model.rotor_inertia * ratio * np.cbrt(ratio) ** 2,
        torque_constant=constant,
        resistance=need.voltage * constant / (np.clip(stall, 2.0, 10.0) * peak),
        rated_voltage=need.voltage,
        no_load_speed=need.no_load_speed,
        speed_max=None,
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_the_needed_motor_is_feasible_and_a_weaker_one_is_not(seed):
    problem, model = weak_problem(seed)
    with pytest.raises(Refused):
        select(problem)
    need = needed_motor(problem, model)
    alone = replace(problem, gears=(DIRECT,))
    device = select(replace(alone, motors=(motor_as_needed(need, model),))).best
    assert device.motor.mass == need.mass
    with pytest.raises(Refused):
        select(replace(alone, motors=(motor_as_needed(need, model, 0.93),)))
    # At least as strong as the robot alone requires: 4 I theta / T^2 over both wheels and their
    # axes (docs/theory.md, What a motor can do).
    requirement = replace(problem.requirement, wheel_speed_max=1.0)
    demands = spin_demands(requirement, lambda _: problem.robot.inertia, problem.incidence)
    assert need.peak_torque > max(demand.torque for demand in demands)


@pytest.mark.slow
def test_a_higher_torque_density_is_named_where_no_size_is_enough():
    """A motor 20 times as heavy is infeasible at any size, but not with 2 or 4 times the torque."""
    problem, model = weak_problem(0)
    heavy = replace(model, mass=20.0 * model.mass)
    need = needed_motor(problem, heavy)
    others = f"Motors with the torque-to-mass ratio of {model.name} would not do at any size."
    assert need.text.endswith(f"would do. {others}")
    density_ratio = need.peak_torque / need.mass / (heavy.peak_torque / heavy.mass)
    assert round(density_ratio, 6) in {2.0, 4.0}
    model = replace(heavy, peak_torque=density_ratio * heavy.peak_torque)
    select(replace(problem, gears=(DIRECT,), motors=(motor_as_needed(need, model),)))


@pytest.mark.slow
def test_with_a_free_incidence_the_needed_motor_is_feasible_at_some_incidence():
    problem, model = weak_problem(0)
    free = replace(problem, incidence=None)
    need = needed_motor(free, model)
    select(replace(free, gears=(DIRECT,), motors=(motor_as_needed(need, model),)))


@pytest.mark.slow
def test_the_refusal_names_the_needed_motor():
    problem, _ = weak_problem(0)
    with pytest.raises(Refused) as caught:
        select(problem)
    nearest = next(each for each in problem.motors if each.name == caught.value.nearest.motor)
    assert needed_motor(problem, nearest).text in advice_on(caught.value).hint


def test_an_incidence_that_was_tried_is_not_recommended():
    """With wheels about pitch no motor can roll the robot; at another incidence one can."""
    problem = random_problem(0, motors=2, mounted=False)
    with pytest.raises(Refused) as caught:
        select(replace(problem, incidence=0.0))
    cure = "choose --alpha-criterion lightest"
    assert cure in advice_on(caught.value).hint
    assert cure not in advice_on(caught.value, lightest=False).hint


def test_without_a_time_limit_no_torque_is_needed():
    problem, model = weak_problem(0)
    rate_only = replace(problem.requirement, maneuvers=(), rate_change=1.0)
    assert needed_motor(replace(problem, requirement=rate_only), model) is None


def test_text_of_a_needed_motor():
    need = NeededMotor(peak_torque=21.3, no_load_speed=303.7, mass=2.11, voltage=48.0)
    assert need.text == (
        "A motor with about 22 N m peak torque and 2,900 rpm no-load speed at 48 V, weighing at "
        "most 2.2 kg, would do."
    )


def test_the_benchmark_of_legged_robots_parses_a_refusal(monkeypatch):
    """Its table splits the printed message, so both must change together."""
    monkeypatch.syspath_prepend(BENCHMARKS)
    refusal = script_at(BENCHMARKS / "legged_samples.py").refusal
    problem, _ = weak_problem(0)
    with pytest.raises(Refused) as caught:
        select(problem)
    refused = advice_on(caught.value)
    error = {"kind": "infeasible", "message": str(refused), "hint": refused.hint}
    closest, would_do, lightest = refusal(SimpleNamespace(sized={"error": error}))
    assert closest == f"{refused.nearest.motor}, {refused.nearest.detail}"
    assert re.fullmatch(r"[\d.]+ N m peak torque .* weighing at most [\d.]+ kg", would_do)
    assert lightest == "-"


@pytest.mark.slow
def test_an_infeasible_balance_names_a_feasible_tilt():
    """The named tilt is feasible, and one larger by more than the precision is not."""
    problem, _ = weak_problem(0)
    edge = {"pivot": (0.0, 0.0, -0.2), "edge": (0.0, 1.0, 0.0)}
    balance = Balance(name="held", **edge, pitch=0.1, duration=1.0).on(problem.robot)

    def tilted(share):
        milder = replace(problem.requirement, maneuvers=(balance.milder(share),), rate_change=None)
        return replace(problem, requirement=milder)

    with pytest.raises(Refused) as caught:
        select(tilted(1.0))
    recovers = r"held recovers from pitch [0-9.]+ deg at best, pitch 5.73 deg given"
    assert re.search(recovers, str(caught.value))
    hint = advice_on(caught.value).hint
    degrees = re.search(r"A device exists with pitch ([0-9.]+) deg for held", hint).group(1)
    share = np.radians(float(degrees)) / balance.pitch
    assert 0.1 < share < 1.0
    select(tilted(0.99 * share))
    with pytest.raises(Refused):
        select(tilted(1.05 * share))
