"""design.json is a contract: files that older versions wrote still read, new fields come back."""

import json
import os
import tempfile
from dataclasses import replace
from pathlib import Path

import pytest
from wheels import EC45, EC45_BODY, geared

from ocs_design.actuation.supply import Supply
from ocs_design.common.errors import OcsError
from ocs_design.common.files import to_json
from ocs_design.device.device import NO_CARRIER
from ocs_design.device.records.design import LARGEST, read_design
from ocs_design.device.records.device import Buildable, Margin, OpenPoint
from ocs_design.device.records.selection import Alternative

OLD = Path(__file__).parents[1] / "data" / "design_0_1_0.json"
"""By `size examples/solo12.urdf --no-validate` of version 0.1.0, which knew no motors."""

FLOWN = OLD.with_name("design_1.json")
"""By `size examples/solo12.urdf`, with motors and flights, of the last version of schema 1."""


def test_a_file_of_the_first_version_still_reads():
    written, design = json.loads(OLD.read_bytes()), read_design(OLD)
    assert design.ocs.flywheel.mass == written["ocs"]["flywheel"]["mass"]
    assert design.ocs.motor.name == "assumed"
    assert design.ocs.motor.gear == "direct"
    assert design.ocs.motor.gear_ratio == design.ocs.motor.gear_efficiency == 1.0
    assert design.ocs.motor.armature == design.ocs.motor.gear_mass == 0.0
    unknown = ("bus_voltage", "speed_max", "torque_constant", "resistance", "continuous_torque")
    assert [getattr(design.ocs.motor, name) for name in unknown] == [None] * 5
    assert design.ocs.carrier == NO_CARRIER


def test_everything_that_it_held_is_still_there():
    """What is written again has the old fields with their values, and new ones beside them."""
    for path in (OLD, FLOWN):
        old, new = json.loads(path.read_bytes()), json.loads(to_json(read_design(path)))
        assert (old.pop("schema_version"), new["schema_version"]) == (1, 2)
        for margin in old["margins"]:
            margin["scenario"] = margin.pop("maneuver", "")
        assert_within(old, new, "design")


def test_what_version_1_did_not_say_takes_its_default():
    design = read_design(FLOWN)
    assert (design.supply, design.alternatives, design.buildable.yes) == (None, (), None)
    assert (design.ocs.layout, design.requirement.reliability) == ("pair", None)
    by_name = {margin.name: margin for margin in design.margins}
    assert by_name["bus current"].scenario == "back-flip"
    assert by_name["height"].scenario == ""


def test_what_passed_in_version_1_was_level_and_stood():
    design = read_design(FLOWN)
    assert [run.passed for run in design.validation] == [True, False] * 3
    assert [run.level for run in design.validation] == [True, None] * 3
    assert [run.stands for run in design.validation] == [True, None] * 3
    document = json.loads(FLOWN.read_bytes())
    for run in document["validation"]:
        # As of a biped that no device keeps up.
        run["can_stand"] = False
    fallen = read_back(document)
    assert [run.stands for run in fallen.validation] == [None] * 6


def test_a_document_of_this_version_comes_back_as_it_was(tmp_path):
    design = replace(
        read_design(FLOWN),
        supply=Supply(24.0, 40.0, 960.0),
        alternatives=(Alternative(change="any motor", mass_total=0.4, motor="X", note="n"),),
        buildable=Buildable(yes=False, open=(OpenPoint(what="w", cure="c"),)),
    )
    (tmp_path / "design.json").write_bytes(to_json(design))
    assert read_design(tmp_path / "design.json") == design


@pytest.mark.parametrize(
    ("demand", "capacity", "margin"), [(2.0, 3.0, 1.5), (2.0, None, None), (0.0, 3.0, None)]
)
def test_a_margin_is_written_with_its_factor_also_where_it_has_none(demand, capacity, margin):
    found = Margin("bus power", demand, capacity, "W", note="n")
    assert json.loads(to_json(found)) == {
        "name": "bus power", "demand": demand, "capacity": capacity, "unit": "W",
        "margin": margin, "scenario": "", "note": "n",
    }  # fmt: skip


@pytest.mark.parametrize("version", [0, 3, 99])
def test_other_versions_are_refused_with_the_cure(tmp_path, version):
    path = tmp_path / "design.json"
    path.write_text(
        FLOWN.read_text().replace('"schema_version": 1', f'"schema_version": {version}')
    )
    with pytest.raises(OcsError, match=f"schema_version {version}, .* reads 1 to 2"):
        read_design(path)


def read_back(document):
    """A document through a file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "design.json"
        path.write_text(json.dumps(document))
        return read_design(path)


def test_a_real_motor_and_its_carrier_come_back(tmp_path):
    design = read_design(OLD)
    drive = replace(geared(3.0), torque_constant=0.0369, resistance=0.608, continuous_torque=0.38)
    motorised = replace(design, ocs=replace(design.ocs, motor=drive, carrier=EC45_BODY))
    (tmp_path / "design.json").write_bytes(to_json(motorised))
    again = read_design(tmp_path / "design.json").ocs
    assert (again.motor, again.carrier) == (drive, EC45_BODY)
    assert again.motor.speed_max == EC45.speed_max


def assert_within(old, new, where):
    """`new` has at least what `old` has."""
    if isinstance(old, dict):
        for key, value in old.items():
            assert_within(value, new[key], f"{where}.{key}")
    elif isinstance(old, list):
        assert len(old) == len(new), where
        for index, (one, other) in enumerate(zip(old, new, strict=True)):
            assert_within(one, other, f"{where}[{index}]")
    else:
        assert old == new, where


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"[" * 100_000, "not a design.json"),
        (b'{"schema_version": 1, "tool": ' + b"[" * 100_000, "design.json"),
        (b'{"schema_version": 1, "tool": {"name": "\xa9"}}', "utf-8"),
        (b'{"schema_version": 1, "tool": {"name": "\\ud800"}}', "design.json"),
        (b" " * (LARGEST + 1), "larger than 16 MiB"),
    ],
    ids=["deep", "deep inside", "not UTF-8", "half a character", "gigantic"],
)
def test_what_no_program_wrote_is_refused(tmp_path, content, words):
    path = tmp_path / "design.json"
    path.write_bytes(content)
    with pytest.raises(OcsError, match=words):
        read_design(path)


def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "design.json")
    with pytest.raises(OcsError, match="not a plain file"):
        read_design(tmp_path / "design.json")
