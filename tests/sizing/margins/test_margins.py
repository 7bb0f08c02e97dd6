"""Each margin computed by hand, and the worst over maneuvers."""

from dataclasses import replace

import numpy as np
import pytest
from driven_wheels import BELT, EC45, STEEL, driven_wheel

from ocs_design.device.layout import module_axes
from ocs_design.device.records.flights import Margin
from ocs_design.sizing.margins import SampledMotion, margins, worst

AXES = module_axes(np.radians(30.0))


def turn(torque=0.4, speed=300.0, rate=4.0):
    """Both wheels spin up for 0.5 s and brake for 0.5 s."""
    time = np.array([0.0, 0.5, 0.5, 1.0])
    shape = np.array([0.0, 1.0, 1.0, 0.0])
    drive = torque * np.array([1.0, 1.0, -1.0, -1.0])
    zero = np.zeros(4)
    return SampledMotion(
        time,
        np.column_stack([speed * shape] * 2),
        np.column_stack([drive] * 2),
        np.column_stack([zero, rate * shape, zero]),
        np.column_stack([zero, 2.0 * rate * np.array([1.0, 1.0, -1.0, -1.0]), zero]),
    )


def by_name(motion, wheel):
    return {margin.name: margin for margin in margins(motion, AXES, wheel)}


SLOW_LINE = replace(driven_wheel(), line=replace(driven_wheel().line, speed_max=400.0))
UNLIMITED = driven_wheel(replace(EC45, peak_torque=np.inf, speed_max=np.inf))


def about(value, rel=1e-4):
    return pytest.approx(value, rel=rel)


@pytest.mark.parametrize(
    ("wheel", "name", "demand", "capacity"),
    [
        (driven_wheel(), "motor torque", 0.4, 1.0),
        (driven_wheel(), "motor speed", 300.0, 1047.2),
        (driven_wheel(), "wheel speed", 300.0, 1047.2),
        # At the end of the spin-up: 300 / 650.4 + 0.4 / 1.4566.
        (driven_wheel(), "voltage line", about(0.73586), 1.0),
        # Both wheels with their rotors.
        (driven_wheel(), "stored energy", about(9.0446e-5 * 300.0**2, 1e-3), None),
        # rho w^2 / 4 ((3 + nu) R^2 + (1 - nu) r^2) at 1.2 x 650.4 rad/s: 4.0262 MPa.
        (driven_wheel(), "hoop stress", about(4.0262e6), 215e6),
        # 0.4 N m against 0.128 N m.
        (driven_wheel(), "rms current", about(0.4 / 0.0369, 1e-12), about(0.128 / 0.0369, 1e-12)),
        # The motor behind a gear turns faster.
        (driven_wheel(gear=BELT), "motor speed", 600.0, 900.0),
        (driven_wheel(gear=BELT), "wheel speed", 300.0, 450.0),
        # A specified wheel speed acts like a mechanical limit; stress grows with its square.
        (SLOW_LINE, "wheel speed", 300.0, 400.0),
        (SLOW_LINE, "hoop stress", about(4.0262e6 * (400.0 / 650.4) ** 2), 215e6),
        (driven_wheel(replace(EC45, speed_max=325.2)), "hoop stress", about(4.0262e6 / 4.0), 215e6),
        # Without a rated limit: the no-load speed, and no rating of the current.
        (driven_wheel(replace(EC45, speed_max=None)), "motor speed", 300.0, 639.8),
        (driven_wheel(replace(EC45, continuous_torque=None)), "rms current", about(10.8401), None),
        (UNLIMITED, "motor torque", 0.4, None),
        (UNLIMITED, "wheel speed", 300.0, None),
    ],
)
def test_demand_and_capacity_by_hand(wheel, name, demand, capacity):
    margin = by_name(turn(), wheel)[name]
    assert (margin.demand, margin.capacity) == (demand, capacity)
    assert margin.margin == (None if capacity is None else margin.capacity / margin.demand)


@pytest.mark.parametrize(
    ("change", "name", "note"),
    [
        ({"speed_max": None}, "motor speed", "no limit stated"),
        ({}, "wheel speed", "at 24 V the drive reaches 6,211 rpm, see voltage line"),
        ({"continuous_torque": None}, "rms current", "no continuous rating"),
    ],
)
def test_missing_ratings_are_noted(change, name, note):
    assert note in by_name(turn(), driven_wheel(replace(EC45, **change)))[name].note


def test_the_speed_limit_is_attributed_to_motor_or_gear():
    """A motor without a rated limit, 640 rad/s, behind a gear with a lower or higher limit."""
    unrated = replace(EC45, speed_max=None)
    slow = by_name(turn(), driven_wheel(unrated, gear=replace(BELT, motor_speed_max=600.0)))
    fast = by_name(turn(), driven_wheel(unrated, gear=BELT))
    assert (slow["motor speed"].capacity, fast["motor speed"].capacity) == (600.0, 639.8)
    assert "gear" in slow["motor speed"].note
    assert "no limit stated" in fast["motor speed"].note


def test_braking_uses_less_of_the_torque_speed_line_than_driving():
    """At rest tau / tau_s, and at full speed |300 / 650.4 - 0.4 / 1.4566|."""
    for part, share in ((slice(0, 2), 0.73586), (slice(2, 4), 0.4 / 1.4566)):
        motion = SampledMotion(**{name: values[part] for name, values in vars(turn()).items()})
        margin = by_name(motion, driven_wheel())["voltage line"]
        assert margin.demand == pytest.approx(share, rel=1e-4)


def test_no_stress_without_a_poisson_ratio():
    wheel = driven_wheel(material=replace(STEEL, poisson_ratio=None))
    assert "hoop stress" not in by_name(turn(), wheel)


def test_heat_against_the_continuous_rating():
    """0.4 N m against 0.128 N m: 9.77 of i^2 t, so a pause of 8.77 s after each second."""
    assert "8.8 s" in by_name(turn(), driven_wheel())["rms current"].note
    cool = by_name(turn(torque=0.1), driven_wheel())["rms current"]
    assert cool.margin == pytest.approx(1.28)
    assert cool.note == ""


def test_a_device_at_rest_has_no_demand():
    for margin in by_name(turn(torque=0.0, speed=0.0, rate=0.0), driven_wheel()).values():
        assert margin.demand == 0.0 or margin.name == "hoop stress"


def test_the_worst_of_each_kind_names_its_maneuver():
    drop, flip = (margins(turn(*values), AXES, driven_wheel()) for values in ((0.4,), (0.2, 500.0)))
    worst_margins = {margin.name: margin for margin in worst([("drop", drop), ("back-flip", flip)])}
    assert [margin.name for margin in drop] == list(worst_margins)
    assert worst_margins["motor torque"].scenario == "drop"
    assert worst_margins["wheel speed"].scenario == "back-flip"
    assert worst_margins["stored energy"].scenario == "back-flip"
    assert worst_margins["motor torque"].demand == 0.4
    assert worst_margins["hoop stress"].scenario == ""


def test_the_worst_is_the_largest_share_of_its_capacity():
    """Maneuvers at another incidence may have another limit."""
    low, high = Margin("speed", 10.0, 11.0, "rad/s"), Margin("speed", 50.0, 100.0, "rad/s")
    assert worst([("a", [low]), ("b", [high])])[0].scenario == "a"
    assert worst([("a", [high]), ("b", [low])])[0].scenario == "b"
    assert worst([]) == ()
