"""Jumps from the ground and shoves of a standing robot in MuJoCo."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from energy import energy_balance
from wheels import paper_device

from ocs_design.export.physics import STEP
from ocs_design.jumping.jump import JumpPlan, JumpPlans
from ocs_design.jumping.planning import plan_jumps
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.pushes import Shove
from ocs_design.simulation.metrics import measure, series_of
from ocs_design.simulation.scenario import Flights, run_scenarios
from ocs_design.simulation.scene import JUMP_STEP, Wheels
from ocs_design.simulation.schedule import FlightClock, LegReferences
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.verdict import MOMENTUM_GATE


@pytest.fixture(scope="module")
def disturbance(solo12):
    return default_maneuvers(solo12)[0]


@pytest.fixture(scope="module")
def jumps(solo12, disturbance):
    return plan_jumps(solo12, paper_device(), [disturbance])


@pytest.fixture(scope="module")
def world(builder, disturbance, jumps):
    return builder.flight(disturbance, Wheels.ACTIVE, None, jumps["disturbance"].carrying)


@pytest.fixture(scope="module")
def runs(solo12, disturbance, jumps):
    return run_scenarios(Flights(solo12, paper_device(), [disturbance], jumps=jumps))


def test_only_with_the_device_the_disturbed_jump_from_the_ground_passes(runs):
    assert [run.passed for run in runs] == [True, False]
    assert not any(run.note for run in runs)


def test_the_jump_leaves_the_ground_when_and_as_fast_as_planned(runs, disturbance, jumps):
    for run, plan in zip(runs, jumps["disturbance"], strict=True):
        assert run.metrics.lift_off_time == pytest.approx(plan.legs.lift_off, abs=0.015)
        start = np.searchsorted(run.series.time, run.metrics.lift_off_time)
        velocity = np.gradient(run.series.com, run.series.time, axis=0)[start + 1]
        forward, up = disturbance.takeoff_velocity
        assert velocity[2] == pytest.approx(up, rel=0.08)
        assert velocity[0] == pytest.approx(forward, rel=0.25)
        assert run.metrics.rise == pytest.approx(up**2 / (2.0 * 9.81), rel=0.12)


def test_momentum_is_conserved_relative_to_wheels_and_trunk(runs):
    """Braking legs turn at 20 rad/s and need smaller steps than flights with legs at rest."""
    assert max(run.metrics.momentum_error for run in runs) < 3e-7


@pytest.mark.slow
def test_a_flight_with_a_momentum_error_is_repeated_with_half_the_step(
    solo12, disturbance, jumps, runs, monkeypatch
):
    """Solo12's braking legs at 1 ms; runs that conserve momentum are not repeated."""
    monkeypatch.setattr("ocs_design.simulation.world_builder.JUMP_STEP", STEP)
    monkeypatch.setattr("ocs_design.simulation.scenario.MOST_HALVINGS", 0)
    coarse = run_scenarios(Flights(solo12, paper_device(), [disturbance], jumps=jumps))
    monkeypatch.undo()
    monkeypatch.setattr("ocs_design.simulation.world_builder.JUMP_STEP", STEP)
    refined = run_scenarios(Flights(solo12, paper_device(), [disturbance], jumps=jumps))
    inaccurate = [run.metrics.momentum_error > MOMENTUM_GATE for run in coarse]
    assert any(inaccurate)
    for before, after, expected, wrong in zip(coarse, refined, runs, inaccurate, strict=True):
        if wrong:
            assert before.passed is None
            assert "with steps of 0.5 ms: at 1 ms its angular momentum was off by" in after.note
            assert after.metrics == expected.metrics
            assert after.series.com == pytest.approx(expected.series.com, abs=0.0)
        else:
            assert (after.metrics, after.note) == (before.metrics, before.note)


@pytest.mark.slow
def test_a_jump_balances_its_energy(world):
    """By an independent loop, which agrees with the centre of mass of the simulation."""
    recording = simulate([world])
    metrics = measure(recording, 0, world)
    energies = energy_balance(world, recording, 0, period=5e-3, until=metrics.touchdown_time)
    instants = len(energies.height)
    assert energies.height == pytest.approx(recording.com[:instants, 0, 2], abs=1e-9)
    assert energies.relative_residual(slice(round(metrics.lift_off_time / 5e-3), instants)) < 1e-4
    assert energies.relative_residual(slice(0, instants)) < 1e-3


def test_worlds_with_different_steps_do_not_affect_each_other(solo12, builder, world):
    _, drop, _ = default_maneuvers(solo12)
    flights = world, builder.flight(drop, Wheels.ACTIVE)
    short = [replace(flight, duration=0.4) for flight in flights]
    assert [flight.model.opt.timestep for flight in short] == [JUMP_STEP, STEP]
    progress: list[float] = []
    together = simulate(short, progress=progress.append)
    for index, flight in enumerate(short):
        alone = simulate([flight])
        np.testing.assert_array_equal(together.momentum[:, index], alone.momentum[:, 0])
        np.testing.assert_array_equal(together.contact[:, index], alone.contact[:, 0])
    assert progress == sorted(progress)
    assert (progress[0], progress[-1]) == (0.0, 1.0)


def test_wheels_wait_for_the_lift_off(runs):
    run = runs[0]
    pushing = run.series.time < run.metrics.lift_off_time
    assert np.abs(run.series.wheel_torque[pushing]).max() == 0.0
    assert run.metrics.peak_wheel_torque > 0.1


def test_the_push_starts_at_its_onset_after_lift_off(builder, disturbance, jumps):
    bare = builder.flight(disturbance, Wheels.ABSENT, None, jumps["disturbance"].bare)
    recording = simulate([bare])
    metrics = measure(recording, 0, bare)
    impulse = np.linalg.norm(recording.impulse[:, 0], axis=1)
    onset = recording.time[np.flatnonzero(impulse)[0] - 1] - metrics.lift_off_time
    assert onset == pytest.approx(disturbance.onset, abs=0.005)


def test_the_device_reduces_swing_and_settling_time_after_landing(runs):
    carrying, bare = (run.metrics for run in runs)
    assert carrying.pitch_swing < 0.3 * bare.pitch_swing
    assert carrying.roll_swing < 0.3 * bare.roll_swing
    assert carrying.settling_time < bare.settling_time


def test_drives_follow_the_control_law_of_the_paper(world):
    """K_p (q_ref - q) + K_d (q_dot_ref - q_dot) + tau_ref, in the middle of the push-off."""
    model, legs = world.model, world.legs
    data, k = mujoco.MjData(model), 150
    data.qpos[:], data.qvel[:] = world.qpos, world.qvel
    data.qvel[6:18] = np.linspace(-1.0, 1.0, 12)
    control = np.zeros((1, 1, model.nu))
    LegReferences([world], 1).write(k, control, np.zeros(1, dtype=bool))
    data.ctrl[:] = control[0, 0]
    mujoco.mj_forward(model, data)
    for j, name in enumerate(legs.joints):
        actuator = model.actuator(name).id
        stiffness = model.actuator_gainprm[actuator, 0]
        damping = -model.actuator_biasprm[actuator, 2]
        position, velocity, torque = (
            np.interp(k * model.opt.timestep, legs.time, values[:, j])
            for values in (legs.position, legs.velocity, legs.torque)
        )
        state = data.joint(name)
        expected = (
            stiffness * (position - state.qpos[0]) + damping * (velocity - state.qvel[0]) + torque
        )
        assert data.actuator_force[actuator] == pytest.approx(expected, abs=1e-9)


def test_after_the_jump_drives_hold_the_posture(world):
    control = np.zeros((1, 5, world.model.nu))
    LegReferences([world], 5).write(100_000, control, np.zeros(1, dtype=bool))
    np.testing.assert_allclose(control, np.broadcast_to(world.ctrl, control.shape), atol=1e-12)


@pytest.mark.parametrize(
    ("period", "contacts", "steps"), [(1e-3, "00001000000", 5), (5e-3, "0100000001", 2)]
)
def test_lift_off_takes_five_milliseconds_without_a_contact(world, period, contacts, steps):
    """With control steps of 1 ms bouncing feet do not count as lift-off, nor scraping as landing.

    Aliengo's sample 253 scraped after 5 ms, and the flight was measured to end there.
    """
    clock, planned = FlightClock([world], period), int(world.legs.lift_off / period)
    for k, contact in enumerate(contacts, start=planned):
        clock.update(k, np.array([[contact == "1"]]))
    assert clock.lift_off[0] == planned + steps
    assert clock.steps(planned + steps + 2, 1)[0] == 2


def test_feet_that_lift_early_in_the_push_off_are_no_lift_off(world):
    clock = FlightClock([world], 5e-3)
    clock.update(3, np.zeros((1, 5), dtype=bool))
    assert clock.steps(4, 1)[0] < 0


@pytest.mark.slow
def test_legs_too_weak_to_jump_are_not_judged(solo12, disturbance, jumps):
    plan = jumps["disturbance"].bare
    still = replace(
        plan.legs,
        position=np.tile(plan.legs.position[:1], (len(plan.legs.time), 1)),
        velocity=0.0 * plan.legs.velocity,
        torque=0.0 * plan.legs.torque,
    )
    no_jump = JumpPlan(still, "")
    runs = run_scenarios(
        Flights(
            solo12,
            paper_device(),
            [disturbance],
            jumps={"disturbance": JumpPlans(no_jump, no_jump)},
        )
    )
    assert [run.passed for run in runs] == [None, None]
    assert "cannot lift the robot off the ground" in runs[0].reason


@pytest.mark.slow
def test_the_device_reduces_the_swing_of_a_shoved_robot(solo12, builder):
    shove = Shove(name="shove", torque=(2.0, 8.0, 0.0), duration=0.05, settling=0.5)
    runs = run_scenarios(Flights(solo12, paper_device(), [shove]))
    carrying, bare = (run.metrics for run in runs)
    assert [run.passed for run in runs] == [True, True]
    assert carrying.pitch_swing < 0.8 * bare.pitch_swing
    assert carrying.peak_wheel_torque > 0.0
    world = builder.flight(shove, Wheels.ABSENT)
    series = series_of(simulate([world]), 0, world)
    before = series.time < world.stands - 0.1
    settled = before & (series.time > 0.7 * world.stands)
    assert np.ptp(series.pitch[settled]) < np.radians(0.1)
    assert np.abs(series.pitch[series.time > world.stands]).max() > np.radians(3.0)
