"""A drive stops in flight: its wheel runs on, and the others take over what they can."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from wheels import layout_device, paper_maneuvers

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.requirement.pushes import Shove
from ocs_design.simulation.piloted import PilotedFlight
from ocs_design.simulation.scenario import STOPS, Flights, fly_stopped
from ocs_design.simulation.scene import Wheels
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.target import StoppedDrive
from ocs_design.simulation.world_builder import WorldBuilder
from ocs_design.sizing.trajectory.gyrostat import shared_by_others

TRIAD = Layout(LayoutName.TRIAD)


@given(st.integers(2, 6), st.integers(0, 2**32 - 1))
def test_the_others_give_the_same_torque_as_far_as_they_reach(wheels, seed):
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(3, wheels))
    lost = int(rng.integers(wheels))
    shared, asked = shared_by_others(axes, lost), rng.normal(size=wheels)
    assert not shared[lost].any()
    left = np.delete(axes, lost, axis=1)
    missed = axes @ asked - axes @ (shared @ asked)
    # What is missing is across all that is left.
    np.testing.assert_allclose(left.T @ missed, 0.0, rtol=0, atol=1e-9)
    if wheels > 3:
        np.testing.assert_allclose(missed, 0.0, rtol=0, atol=1e-9)
    # Once more, or where that motor was not asked for anything, nothing changes.
    np.testing.assert_allclose(shared @ (shared @ asked), shared @ asked, rtol=0, atol=1e-9)


def test_a_shove_survives_on_its_feet_and_drives_stop_while_it_is_watched(solo12, monkeypatch):
    monkeypatch.setattr("ocs_design.simulation.scenario.STOPS", 2)
    shove = Shove(name="shove", torque=(0.2, 0.8, 0.0), duration=0.05, settling=0.5)
    found = fly_stopped(Flights(solo12, layout_device(TRIAD), [shove]), 0.02)
    assert len({each.instant for each in found.flights}) == 2
    assert not found.lost
    assert all(0.0 < each.tilt < np.radians(5.0) for each in found.flights)


@pytest.fixture(scope="module")
def recorded(solo12):
    """A drop, whole and with the wheel on pitch stopped a third of the way; 200 steps a second."""
    builder = WorldBuilder(solo12, layout_device(TRIAD))
    drop = builder.flight(paper_maneuvers(solo12)[1], Wheels.ACTIVE)
    stops = StoppedDrive(0, 0.1, 0.02)
    return simulate([drop, replace(drop, stopped=stops)], threads=1)


def test_its_motor_gives_nothing_and_its_wheel_runs_on(recorded):
    last = round(0.1 / 0.005)
    torque, speed = recorded.wheel_torque[:, 1], recorded.wheel_speed[:, 1, 0]
    assert torque[:last, 0].all()
    assert not torque[last:, 0].any()
    assert abs(speed[last]) > 10.0
    # Only the trunk, as it turns the other way, changes it.
    flying = slice(last, last + 40)
    held = speed[flying] + recorded.rate[flying, 1, 1]
    np.testing.assert_allclose(held, held[0], rtol=1e-3)


def test_the_others_know_after_the_detection_and_not_before(recorded):
    whole, stopped = np.moveaxis(recorded.wheel_torque[:, :, 1:], 1, 0)
    last, known = round(0.1 / 0.005), round(0.12 / 0.005)
    np.testing.assert_array_equal(whole[: last + 1], stopped[: last + 1])
    before, after = (np.abs(stopped[k] - whole[k]).max() for k in (known - 1, known))
    assert after > 2.0 * before


def test_a_pilot_cannot_drive_what_has_stopped(solo12):
    drop = WorldBuilder(solo12, layout_device(TRIAD)).flight(
        paper_maneuvers(solo12)[1], Wheels.ACTIVE
    )
    flight = PilotedFlight(replace(drop, stopped=StoppedDrive(0, 0.02, 0.02)), hold=5)
    for _ in range(6):
        flight.fly(np.full(3, 0.1))
    given = flight._record.wheel_torque[:6, 0]
    np.testing.assert_allclose(given[:4], 0.1)
    np.testing.assert_allclose(given[4:], [[0.0, 0.1, 0.1]] * 2)


@pytest.mark.slow
def test_every_drive_stops_at_every_instant_of_each_maneuver(solo12):
    """Wheels that are twice as large as the paper's hold what one of them leaves."""
    device = layout_device(TRIAD)
    wheel = replace(device.flywheel, spin_inertia=2.0 * device.flywheel.spin_inertia)
    drop = paper_maneuvers(solo12)[1]
    found = fly_stopped(Flights(solo12, replace(device, flywheel=wheel), [drop]), 0.02)
    assert len(found.flights) == 3 * STOPS
    assert {each.module for each in found.flights} == {"1", "2", "3"}
    assert found.worst in (found.lost or found.flights)
    assert found.worst.tilt == max(each.tilt for each in found.lost or found.flights)
    pair = fly_stopped(Flights(solo12, layout_device(Layout()), [drop]), 0.02)
    assert found.worst.tilt < pair.worst.tilt
