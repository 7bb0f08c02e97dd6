"""Every margin and the printed figures, recalculated from the files alone."""

import json
import math
import re

import pytest
from commands import SOLO12, run, with_value
from flown_margins import FlownMargins, catalogue_row
from subsets import fast_subset

from ocs_design.common.errors import OcsError
from ocs_design.workflows.restoring import read_design_and_device

pytestmark = pytest.mark.slow

MOTOR = "MN4014 KV400"
UNPLANNED = """
[motor]
name = "MN4014 KV400"
gear = "direct"
[[maneuver]]
kind = "disturbance"
name = "push"
takeoff_velocity = ["0.5 m/s", "2.4 m/s"]
torque = ["0.3 N m", "1.2 N m", 0]
onset = "0.1 s"
duration = "0.05 s"
"""
"""A push, for which there is no plan: the demands on the drive are those of the flight."""


@pytest.fixture(scope="module")
def sized(tmp_path_factory, no_alternatives):
    """Result of `size`, and the files of a design for a push in the air."""
    folder = tmp_path_factory.mktemp("pushed")
    (folder / "push.toml").write_text(UNPLANNED)
    out = folder / "out"
    result = run("size", SOLO12, "--spec", folder / "push.toml", "-o", out)
    assert result.code in {0, 1}, result.output
    return result, FlownMargins(out)


def margins_of(flown):
    return {margin["name"]: margin for margin in flown.design["margins"]}


def test_the_motor_is_its_row_in_the_catalogue(sized):
    motor, row = sized[1].motor, catalogue_row("motors.csv", MOTOR)
    assert motor["torque_constant"] == pytest.approx(30.0 / math.pi / float(row["kv_rpm_per_v"]))
    assert motor["resistance"] == float(row["resistance_ohm"])
    assert motor["no_load_current"] == float(row["no_load_current_a"])
    useful = float(row["peak_current_a"]) - float(row["no_load_current_a"])
    assert motor["torque_limit"] == pytest.approx(useful * motor["torque_constant"])


def test_every_demand_is_that_of_the_flight(sized):
    """To the six digits of the time series; less where differences or sums of them are formed."""
    tolerances = {"winding heat": 5e-4, "bearing moment": 1e-3}
    flown = sized[1]
    margins = margins_of(flown)
    for name, demand in flown.demands().items():
        rel = tolerances.get(name, 2e-5)
        assert margins[name]["demand"] == pytest.approx(demand, rel=rel), name
        assert margins[name]["scenario"] == "push"


def test_the_time_series_do_not_exceed_the_demands(sized):
    flown = sized[1]
    margins = margins_of(flown)
    for table in flown.tables:
        assert table["power"].max() <= margins["bus power"]["demand"] * (1.0 + 1e-5)
        assert -table["power"].min() <= margins["bus power, fed back"]["demand"] * (1.0 + 1e-5)
        assert table["current"].max() <= margins["bus current"]["demand"] * (1.0 + 1e-5)
        assert -table["current"].min() <= margins["bus current, fed back"]["demand"] * (1.0 + 1e-5)


def test_energies_are_the_integral_of_the_power(sized):
    """Power is linear while a torque is held; its zeros are accurate to a step."""
    flown = sized[1]
    margins = margins_of(flown)
    (table,) = flown.tables
    torque, speed, steps = (
        table["torque"][:-1],
        table["speed"],
        table["time"][1:] - table["time"][:-1],
    )
    for name, idle, sign in (
        ("energy from the bus", flown.idle, 1.0),
        ("energy fed back", 0.0, -1.0),
    ):
        ends = [
            (sign * flown.power(torque, end, idle * (end != 0.0))).clip(0.0)
            for end in (speed[:-1], speed[1:])
        ]
        energy = float(steps @ (0.5 * (ends[0] + ends[1])))
        assert margins[name]["demand"] == pytest.approx(energy, rel=0.03)


def test_every_capacity_is_that_of_its_part(sized):
    flown = sized[1]
    margins, motor, row = margins_of(flown), flown.motor, catalogue_row("motors.csv", MOTOR)
    watts = 400.0 * flown.design["robot"]["mass"]
    assert flown.design["supply"]["power_max"] == pytest.approx(watts)
    for name in ("bus power", "bus power, fed back"):
        assert margins[name]["capacity"] == pytest.approx(watts)
    for name in ("bus current", "bus current, fed back"):
        assert margins[name]["capacity"] == pytest.approx(watts / 24.0)
    peak = float(row["peak_current_a"]) * motor["torque_constant"]
    assert margins["motor torque"]["capacity"] == pytest.approx(peak)
    # Without a maximum speed in the catalogue the no-load speed at rated voltage is the limit.
    top = float(row["rated_voltage_v"]) / motor["torque_constant"]
    assert margins["wheel speed"]["capacity"] == pytest.approx(top)
    assert margins["motor speed"]["capacity"] == pytest.approx(top)
    stress, strength = flown.hoop_stress()
    assert margins["hoop stress"]["demand"] == pytest.approx(stress, rel=1e-9)
    assert margins["hoop stress"]["capacity"] == strength
    rating = motor["continuous_torque"] / motor["torque_constant"]
    assert margins["rms current"]["capacity"] == pytest.approx(rating)
    assert margins["voltage line"]["capacity"] == 1.0


def test_the_rms_current_is_that_of_the_flight(sized):
    """The larger value of the whole run and of the time from lift-off to touchdown."""
    flown = sized[1]
    (table,) = flown.tables
    (metrics,) = (run["metrics"] for run in flown.design["validation"] if run["ocs"])
    lift_off, touchdown = metrics["lift_off_time"] - 1e-6, metrics["touchdown_time"] + 1e-6
    in_flight = (table["time"] >= lift_off) & (table["time"] <= touchdown)
    parts = [
        {name: table[name][part] for name in ("time", "torque", "speed")}
        for part in (in_flight, ...)
    ]
    means = [
        math.sqrt(
            flown.heat(part) / flown.motor["resistance"] / (part["time"][-1] - part["time"][0])
        )
        for part in parts
    ]
    assert margins_of(flown)["rms current"]["demand"] == pytest.approx(max(means), rel=5e-4)


def test_the_output_shows_these_figures(sized):
    """Each number in the block of the device agrees with the files."""
    result, flown = sized
    ocs, wheel, motor = flown.design["ocs"], flown.design["ocs"]["flywheel"], flown.motor
    text = result.output
    share = ocs["mass_total"] / flown.design["robot"]["mass"]
    assert f"{1e3 * ocs['mass_total']:.1f} g, {share:.1%} of the robot" in text
    parts = re.search(r" module (.*?) (?:plate|incidence)", text)[1]
    grams = sum(map(float, re.findall(r"[\d.]+", parts)))
    plate = re.search(r" plate ([\d.]+) g", text)
    mass = 2.0 * grams + (float(plate[1]) if plate else 0.0)
    assert mass == pytest.approx(1e3 * ocs["mass_total"], abs=0.6)
    sizes = (1e3 * wheel[name] for name in ("outer_radius", "inner_radius", "height"))
    assert "R {:.2f} r {:.2f} h {:.2f} mm".format(*sizes) in text
    assert f"{math.degrees(ocs['incidence']):.2f} deg" in text
    top = 24.0 / motor["torque_constant"] * 30.0 / math.pi
    # A single maximum speed, that of the drive at this voltage; once there was a higher one too.
    limits = f"at most {top:,.0f} rpm (without load at 24 V) and {motor['torque_limit']:.3g} N m"
    assert limits in text
    demands, margins = flown.demands(), margins_of(flown)
    used = re.findall(r"(\d+)% (\D*)", re.search(r" used (.*?) Flights", text)[1])
    assert [int(percent) for percent, _ in used] == sorted(
        (int(percent) for percent, _ in used), reverse=True
    )
    for percent, names in used:
        for name in demands:
            if re.search(rf"(^| and |, ){name}( and |, | \(|$)", names):
                share = 100.0 * demands[name] / margins[name]["capacity"]
                assert int(percent) == math.ceil(share - 2e-3), name


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("ocs.motor.torque_limit", "the capacity of motor torque in margins"),
        ("ocs.motor.speed_max", "the capacity of wheel speed in margins"),
        ("supply.power_max", "the capacity of bus power in margins"),
        ("supply.current_max", "the capacity of bus current in margins"),
        ("ocs.flywheel.hoop_stress", "dimensions, material and top speed give"),
        ("ocs.flywheel.stress_margin", "dimensions, material and top speed give"),
    ],
)
def test_a_limit_changed_by_hand_is_refused_with_its_key(sized, key, message, tmp_path):
    """Otherwise flights would keep one limit and be judged by another."""
    document = json.loads((sized[1].folder / "design.json").read_text())
    with_value(document, key, lambda figure: 1.01 * figure)
    (tmp_path / "design.json").write_text(json.dumps(document))
    with pytest.raises(OcsError, match=f"{key} is .*{message}"):
        read_design_and_device(tmp_path)


@pytest.mark.parametrize("product", ["motor"], indirect=True)
def test_no_flight_exceeds_the_demands(product):
    """With plans, which may demand more than the flights."""
    flown = FlownMargins(product.folder)
    margins = margins_of(flown)
    for name, demand in flown.demands().items():
        assert demand <= margins[name]["demand"] * (1.0 + 2e-5), name


RANDOM_DESIGNS = (
    (SOLO12, "--motor", "MN4014 KV400", "--bus-power", "700W"),
    ("--mass", "3.4", "--inertia", "0.05,0.09,0.12", "--motor", "AT4120 KV560"),
    (SOLO12, "--motor", "AT2820 KV1050", "--alpha", "25deg", "--bus-voltage", "20V"),
)
"""Three of twenty designs that were drawn at random."""


@pytest.mark.usefixtures("no_alternatives", "no_files")
@pytest.mark.parametrize(
    "options", fast_subset(3, [(options,) for options in RANDOM_DESIGNS], pytest.mark.exhaustive)
)
def test_no_flight_of_other_designs_exceeds_the_demands(options, tmp_path):
    command = (*options, "--gear", "direct", "--ballistic", "-q", "-o", tmp_path / "out")
    result = run("size", *command)
    assert result.code in {0, 1}, result.output
    flown = FlownMargins(tmp_path / "out")
    margins, supply = margins_of(flown), flown.design["supply"]
    for name, demand in flown.demands().items():
        assert demand <= margins[name]["demand"] * (1.0 + 5e-4), name
    for table in flown.tables:
        assert abs(table["power"]).max() <= supply["power_max"]
        assert abs(table["current"]).max() <= supply["current_max"]
