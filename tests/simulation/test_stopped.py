"""A drive stops in flight: its wheel runs on, and the others take over its torque."""

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
def test_the_others_give_the_same_torque_within_their_span(wheels, seed):
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(3, wheels))
    lost = int(rng.integers(wheels))
    shared, torque = shared_by_others(axes, lost), rng.normal(size=wheels)
    assert not shared[lost].any()
    remaining = np.delete(axes, lost, axis=1)
    difference = axes @ torque - axes @ (shared @ torque)
    # The missing torque is perpendicular to all remaining axes.
    np.testing.assert_allclose(remaining.T @ difference, 0.0, rtol=0, atol=1e-9)
    if wheels > 3:
        np.testing.assert_allclose(difference, 0.0, rtol=0, atol=1e-9)
    # Sharing again changes nothing.
    np.testing.assert_allclose(shared @ (shared @ torque), shared @ torque, rtol=0, atol=1e-9)


def test_a_shoved_robot_stays_level_when_drives_stop(solo12, monkeypatch):
    monkeypatch.setattr("ocs_design.simulation.scenario.STOPS", 2)
    shove = Shove(name="shove", torque=(0.2, 0.8, 0.0), duration=0.05, settling=0.5)
    stopped_flights = fly_stopped(Flights(solo12, layout_device(TRIAD), [shove]), 0.02)
    assert len({flight.instant for flight in stopped_flights.flights}) == 2
    assert not stopped_flights.lost
    assert all(0.0 < flight.tilt < np.radians(5.0) for flight in stopped_flights.flights)


@pytest.fixture(scope="module")
def recorded(solo12):
    """A drop without and with a stop of the pitch wheel at a third of its time; 200 steps/s."""
    builder = WorldBuilder(solo12, layout_device(TRIAD))
    drop = builder.flight(paper_maneuvers(solo12)[1], Wheels.ACTIVE)
    stops = StoppedDrive(0, 0.1, 0.02)
    return simulate([drop, replace(drop, stopped=stops)], threads=1)


def test_a_stopped_motor_gives_no_torque_and_its_wheel_runs_on(recorded):
    stop = round(0.1 / 0.005)
    torque, speed = recorded.wheel_torque[:, 1], recorded.wheel_speed[:, 1, 0]
    assert torque[:stop, 0].all()
    assert not torque[stop:, 0].any()
    assert abs(speed[stop]) > 10.0
    # The speed against an inertial frame stays; only the trunk turns.
    flying = slice(stop, stop + 40)
    inertial_speed = speed[flying] + recorded.rate[flying, 1, 1]
    np.testing.assert_allclose(inertial_speed, inertial_speed[0], rtol=1e-3)


def test_the_others_react_after_the_detection_time(recorded):
    working, stopped = np.moveaxis(recorded.wheel_torque[:, :, 1:], 1, 0)
    stop, detected = round(0.1 / 0.005), round(0.12 / 0.005)
    np.testing.assert_array_equal(working[: stop + 1], stopped[: stop + 1])
    before, after = (np.abs(stopped[k] - working[k]).max() for k in (detected - 1, detected))
    assert after > 2.0 * before


def test_a_pilot_cannot_drive_a_stopped_wheel(solo12):
    drop = WorldBuilder(solo12, layout_device(TRIAD)).flight(
        paper_maneuvers(solo12)[1], Wheels.ACTIVE
    )
    flight = PilotedFlight(replace(drop, stopped=StoppedDrive(0, 0.02, 0.02)), hold=5)
    for _ in range(6):
        flight.fly(np.full(3, 0.1))
    torque = flight._record.wheel_torque[:6, 0]
    np.testing.assert_allclose(torque[:4], 0.1)
    np.testing.assert_allclose(torque[4:], [[0.0, 0.1, 0.1]] * 2)


@pytest.mark.slow
def test_every_drive_stops_at_every_instant_of_each_maneuver(solo12):
    """Wheels with twice the paper's inertia can take over the momentum of one."""
    device = layout_device(TRIAD)
    wheel = replace(device.flywheel, spin_inertia=2.0 * device.flywheel.spin_inertia)
    drop = paper_maneuvers(solo12)[1]
    triad = fly_stopped(Flights(solo12, replace(device, flywheel=wheel), [drop]), 0.02)
    assert len(triad.flights) == 3 * STOPS
    assert {flight.module for flight in triad.flights} == {"1", "2", "3"}
    assert triad.worst in (triad.lost or triad.flights)
    assert triad.worst.tilt == max(flight.tilt for flight in triad.lost or triad.flights)
    pair = fly_stopped(Flights(solo12, layout_device(Layout()), [drop]), 0.02)
    assert triad.worst.tilt < pair.worst.tilt
