"""Contradictions of a design that was edited by hand are refused with their key."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from commands import run, with_value
from designed_devices import MOTOR, design_of, record_of
from subsets import slow_subset

from ocs_design.common.errors import OcsError
from ocs_design.common.files import to_json
from ocs_design.requirement.device_sections import FlywheelSection, MotorSection, OcsSection
from ocs_design.requirement.sections import RequirementSection
from ocs_design.requirement.specification import Specification
from ocs_design.workflows.export import export_design
from ocs_design.workflows.restoring import read_design_and_device

DATA = Path(__file__).parents[1] / "data"

OUTRUNNER = MotorSection(name="Antigravity MN5008 KV400")
FLAT = MotorSection(name=MOTOR)
SMALL_RATE = RequirementSection(rate_change=1.0)
KINDS = {
    "disc": Specification(requirement=SMALL_RATE, motor=OUTRUNNER),
    "shrunk on": Specification(motor=FLAT, flywheel=FlywheelSection(web="aluminium")),
    "spokes": Specification(motor=FLAT, flywheel=FlywheelSection(web="none")),
    "ring": Specification(motor=OUTRUNNER, ocs=OcsSection(wheel="ring")),
    "gear": Specification(requirement=SMALL_RATE, motor=replace(FLAT, gear="PLE040 3")),
    "guard": Specification(motor=FLAT, ocs=OcsSection(guard="containing")),
    "tilted": Specification(
        requirement=SMALL_RATE, motor=FLAT, ocs=OcsSection(layout="orthogonal")
    ),
    "four wheels": Specification(motor=FLAT, ocs=OcsSection(layout="double-pair")),
    "no motor": Specification(motor=MotorSection(name="none")),
}


@cache
def written(kind):
    task, sizing = design_of(KINDS[kind])
    return to_json(record_of(task, sizing))


@pytest.mark.parametrize("kind", slow_subset(2, KINDS))
def test_a_design_agrees_with_itself(kind, tmp_path):
    (tmp_path / "design.json").write_bytes(written(kind))
    design, device = read_design_and_device(tmp_path)
    assert device.mass == design.ocs.mass_total


@pytest.mark.parametrize("name", ["design_0_1_0", "design_1"])
def test_designs_of_older_versions_are_read(name, tmp_path):
    """Also after an export, which writes a document of this schema."""
    export_design(DATA / f"{name}.json", "bom", out=tmp_path / "again")
    read_design_and_device(tmp_path / "again")


def edited(folder, key, value, kind="disc"):
    """A design with another value at a key."""
    document = with_value(json.loads(written(kind)), key, value)
    (folder / "design.json").write_text(json.dumps(document))
    return folder


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("ocs.flywheel.outer_radius", 0.06, r"ocs\.flywheel\.mass is .* g, but its dimensions"),
        ("ocs.flywheel.height", lambda mm: 1e3 * mm, r"ocs\.flywheel\.mass is"),
        ("ocs.flywheel.spin_inertia", lambda x: 3.0 * x, r"ocs\.flywheel\.spin_inertia is"),
        ("ocs.flywheel.web.holes.hole_radius", lambda x: 0.9 * x, r"flywheel\.web\.holes is"),
        ("ocs.mass_total", 5.0, r"ocs\.mass_total is 5000 g, but its parts weigh"),
        (
            "ocs.motor.name",
            "MN4012 KV480",
            r"ocs\.motor\.name is 'MN4012 KV480', but the first entry",
        ),
        ("ocs.motor.mass", lambda x: 1.1 * x, r"ocs\.carrier\.mass is"),
        ("ocs.motor.bus_voltage", 48.0, r"ocs\.motor\.bus_voltage is 48 V"),
        ("ocs.motor.mounting.shaft_diameter", 0.008, r"ocs\.flywheel\.web\.hub\.radius is"),
        ("ocs.motor.mounting.stator.thread", "M99", r"mounting\.stator\.thread is 'M99'.*M3"),
        ("ocs.flywheel.web.hub.radius", 4.0, r"flywheel\.web\.hub\.radius is not below"),
        ("ocs.motor.gear_ratio", 0.0, r"motor\.gear_ratio is 0"),
        ("ocs.foot_plate", 1e-4, r"ocs\.carrier\.mass is"),
        ("ocs.modules.0.position.2", 0.02, r"ocs\.center_of_mass is .* ocs\.modules"),
        ("ocs.incidence", 0.2, r"axis of module left is .* ocs\.incidence gives"),
        ("robot.mass", 25.0, r"ocs\.total_mass is"),
        ("supply.voltage", 48.0, r"supply\.voltage is 48 V, but selection\.bus_voltage is"),
        ("ocs.motor.stall_torque", None, r"ocs\.motor\.stall_torque is null, but voltage"),
        ("ocs.motor.resistance", None, r"ocs\.motor\.resistance is null, but voltage"),
        ("ocs.motor.armature", -1.0, r"ocs\.motor\.armature is -1 kg m\^2, but rotor and gear"),
        ("robot.standing_height", -1.0, r"robot\.standing_height is -1, not between"),
        ("requirement.detection", 1e300, r"requirement\.detection is 1e\+300, not between"),
        ("seed", -1, r"seed is -1, not between"),
    ],
)
def test_a_contradiction_is_refused_with_its_key(key, value, message, tmp_path):
    with pytest.raises(OcsError, match=rf"design\.json: .*{message}") as refused:
        read_design_and_device(edited(tmp_path, key, value))
    assert refused.value.exit_code == 3
    assert "size" in refused.value.hint


@pytest.mark.parametrize(
    ("key", "name"),
    [
        ("ocs.motor.torque_limit", "motor torque"),
        ("ocs.motor.speed_max", "wheel speed"),
        ("supply", "bus current"),
    ],
)
def test_a_limit_that_margins_have_may_not_be_removed(key, name, tmp_path):
    """Without it the flights were judged as passed with any torque, speed or power."""
    document = json.loads(written("disc"))
    motor, supply = document["ocs"]["motor"], document["supply"]
    friction = motor["torque_constant"] * motor["no_load_current"]
    capacities = {
        "motor torque": motor["torque_limit"] + friction,
        "wheel speed": motor["speed_max"],
        "bus power": supply["power_max"],
        "bus current": supply["current_max"],
    }
    for margin, capacity in capacities.items():
        row = {"name": margin, "demand": 0.0, "capacity": capacity, "unit": "SI", "scenario": ""}
        document["margins"].append(row)
    (tmp_path / "design.json").write_text(json.dumps(document))
    read_design_and_device(tmp_path)
    (tmp_path / "design.json").write_text(json.dumps(with_value(document, key, None)))
    with pytest.raises(OcsError, match=rf"{key}\S* is null, but the capacity of {name} in margins"):
        read_design_and_device(tmp_path)


def test_a_reserve_of_zero_is_refused(tmp_path):
    """It ended in a division by zero."""
    folder = edited(tmp_path, "selection.kept.maneuvers.0.demand", 0.0, "shrunk on")
    with pytest.raises(OcsError, match=r"selection\.kept\.maneuvers\.demand is 0, not between"):
        read_design_and_device(folder)


def test_a_wheel_without_a_motor_is_checked_too(tmp_path):
    with pytest.raises(OcsError, match=r"ocs\.flywheel\.mass is"):
        read_design_and_device(edited(tmp_path, "ocs.flywheel.inner_radius", 0.02, "no motor"))


@pytest.mark.parametrize("command", ["export", "validate"])
def test_commands_refuse_a_contradiction_before_writing(command, tmp_path):
    result = run(command, edited(tmp_path, "ocs.mass_total", 5.0), "-o", tmp_path / "out")
    assert result.code == 3
    assert "ocs.mass_total is 5000 g" in result.output
    assert "change the specification" in result.output
    assert not (tmp_path / "out").exists()
