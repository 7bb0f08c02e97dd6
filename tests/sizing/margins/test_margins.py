"""Every margin once by hand, and the worst over maneuvers."""

from dataclasses import replace

import numpy as np
import pytest
from driven_wheels import BELT, EC45, STEEL, driven_wheel

from ocs_design.device.layout import module_axes
from ocs_design.device.records.device import Margin
from ocs_design.sizing.margins import Motion, margins, worst

AXES = module_axes(np.radians(30.0))


def turn(torque=0.4, speed=300.0, rate=4.0):
    """Half a second of spinning up and as much of braking; both wheels alike."""
    time = np.array([0.0, 0.5, 0.5, 1.0])
    shape = np.array([0.0, 1.0, 1.0, 0.0])
    drive = torque * np.array([1.0, 1.0, -1.0, -1.0])
    zero = np.zeros(4)
    return Motion(
        time,
        np.column_stack([speed * shape] * 2),
        np.column_stack([drive] * 2),
        np.column_stack([zero, rate * shape, zero]),
        np.column_stack([zero, 2.0 * rate * np.array([1.0, 1.0, -1.0, -1.0]), zero]),
    )


def by_name(motion, wheel):
    return {margin.name: margin for margin in margins(motion, AXES, wheel)}


def test_the_drive():
    found = by_name(turn(), driven_wheel())
    torque = found["motor torque"]
    assert (torque.demand, torque.capacity, torque.margin) == (0.4, 1.0, 2.5)
    # At the end of the spin-up: 300 / 650.4 + 0.4 / 1.4566.
    assert found["voltage line"].demand == pytest.approx(0.73586, rel=1e-4)
    assert found["wheel speed"].capacity == 1047.2
    assert found["motor speed"].demand == 300.0


def test_braking_takes_less_of_the_line_than_driving():
    motion = turn()
    half = {
        "drive": replace_all(motion, slice(0, 2)),
        "brake": replace_all(motion, slice(2, 4)),
    }
    shares = {
        name: by_name(part, driven_wheel())["voltage line"].demand for name, part in half.items()
    }
    assert shares["drive"] == pytest.approx(0.73586, rel=1e-4)
    # Braking ends at rest with tau alone; at full speed it is |300 / 650.4 - 0.4 / 1.4566|.
    assert shares["brake"] == pytest.approx(0.4 / 1.4566, rel=1e-4)


def replace_all(motion, part):
    return Motion(**{name: values[part] for name, values in vars(motion).items()})


def test_a_gear_turns_the_motor_faster():
    found = by_name(turn(), driven_wheel(gear=BELT))
    assert found["motor speed"].demand == 600.0
    assert found["motor speed"].capacity == 900.0
    assert found["wheel speed"].capacity == 450.0


def test_a_stated_wheel_speed_limits_like_a_mechanical_one():
    wheel = driven_wheel()
    found = by_name(turn(), replace(wheel, line=replace(wheel.line, speed_max=400.0)))
    assert found["wheel speed"].capacity == 400.0
    full = by_name(turn(), driven_wheel())["hoop stress"]
    slow = found["hoop stress"]
    assert slow.demand / full.demand == pytest.approx((400.0 / (24.0 / 0.0369)) ** 2)


def test_without_a_stated_limit_a_motor_turns_no_faster_than_it_does_unloaded():
    wheel = driven_wheel(replace(EC45, speed_max=None))
    speed = by_name(turn(), wheel)["motor speed"]
    assert speed.capacity == 639.8
    assert "no limit stated" in speed.note


def test_hoop_stress_is_judged_above_the_speed_that_the_drive_reaches():
    """rho w^2 / 4 ((3 + nu) R^2 + (1 - nu) r^2) at 1.2 x 650.4 rad/s: 4.0262 MPa."""
    stress = by_name(turn(), driven_wheel())["hoop stress"]
    assert stress.demand == pytest.approx(4.0262e6, rel=1e-4)
    assert stress.capacity == 215e6


def test_a_mechanical_limit_below_no_load_speed_limits_the_stress():
    wheel = driven_wheel()
    slow = driven_wheel(replace(EC45, speed_max=325.2))
    ratio = (
        by_name(turn(), slow)["hoop stress"].demand / by_name(turn(), wheel)["hoop stress"].demand
    )
    assert ratio == pytest.approx(0.25, rel=1e-4)


def test_no_stress_without_a_poisson_ratio():
    wheel = driven_wheel(material=replace(STEEL, poisson_ratio=None))
    assert "hoop stress" not in by_name(turn(), wheel)


def test_stored_energy_is_that_of_both_wheels_with_their_rotors():
    energy = by_name(turn(), driven_wheel())["stored energy"]
    assert energy.demand == pytest.approx(9.0446e-5 * 300.0**2, rel=1e-3)
    assert energy.capacity is None
    assert energy.margin is None


def test_heat_against_the_continuous_rating():
    """0.4 N m against 0.128 N m: 9.77 of i^2 t, so a pause of 8.77 s after each second."""
    current = by_name(turn(), driven_wheel())["rms current"]
    assert current.demand == pytest.approx(0.4 / 0.0369, rel=1e-12)
    assert current.capacity == pytest.approx(0.128 / 0.0369, rel=1e-12)
    assert "8.8 s" in current.note
    cool = by_name(turn(torque=0.1), driven_wheel())["rms current"]
    assert cool.margin == pytest.approx(1.28)
    assert cool.note == ""


def test_a_motor_without_a_continuous_rating():
    wheel = driven_wheel(replace(EC45, continuous_torque=None))
    current = by_name(turn(), wheel)["rms current"]
    assert current.capacity is None
    assert "no continuous rating" in current.note


def test_nothing_is_asked_of_a_device_at_rest():
    for margin in by_name(turn(torque=0.0, speed=0.0, rate=0.0), driven_wheel()).values():
        assert margin.demand == 0.0 or margin.name == "hoop stress"


def test_unlimited_drives_have_no_capacity():
    found = by_name(turn(), driven_wheel(replace(EC45, peak_torque=np.inf, speed_max=np.inf)))
    assert found["motor torque"].capacity is None
    assert found["wheel speed"].margin is None


def test_the_worst_of_each_kind_names_its_maneuver():
    drop, flip = (margins(turn(*values), AXES, driven_wheel()) for values in ((0.4,), (0.2, 500.0)))
    found = {margin.name: margin for margin in worst([("drop", drop), ("back-flip", flip)])}
    assert [margin.name for margin in drop] == list(found)
    assert found["motor torque"].scenario == "drop"
    assert found["wheel speed"].scenario == "back-flip"
    assert found["stored energy"].scenario == "back-flip"
    assert found["motor torque"].demand == 0.4
    assert found["hoop stress"].scenario == ""


def test_the_worst_goes_by_the_share_of_the_capacity():
    """Maneuvers flown at another incidence may be with another limit: the share tells."""
    low, high = Margin("speed", 10.0, 11.0, "rad/s"), Margin("speed", 50.0, 100.0, "rad/s")
    assert worst([("a", [low]), ("b", [high])])[0].scenario == "a"
    assert worst([("a", [high]), ("b", [low])])[0].scenario == "b"
    assert worst([]) == ()
