"""Compatibility of design.json: files of older versions are read, new fields are preserved."""

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
from ocs_design.device.records.design import LARGEST, read_design
from ocs_design.device.records.flights import Buildable, Margin, OpenPoint
from ocs_design.device.records.selection import Alternative
from ocs_design.parts.solids import NO_CARRIER

FIRST_VERSION = Path(__file__).parents[1] / "data" / "design_0_1_0.json"
"""Written by `size examples/solo12.urdf --no-validate` of version 0.1.0, without motors."""

SCHEMA_1 = FIRST_VERSION.with_name("design_1.json")
"""Written by `size examples/solo12.urdf` of the last version of schema 1, with flights."""


def test_a_file_of_the_first_version_is_read():
    written, design = json.loads(FIRST_VERSION.read_bytes()), read_design(FIRST_VERSION)
    assert design.ocs.flywheel.mass == written["ocs"]["flywheel"]["mass"]
    assert design.ocs.motor.name == "assumed"
    assert design.ocs.motor.gear == "direct"
    assert design.ocs.motor.gear_ratio == design.ocs.motor.gear_efficiency == 1.0
    assert design.ocs.motor.armature == design.ocs.motor.gear_mass == 0.0
    unknown = ("bus_voltage", "speed_max", "torque_constant", "resistance", "continuous_torque")
    assert [getattr(design.ocs.motor, name) for name in unknown] == [None] * 5
    assert design.ocs.carrier == NO_CARRIER


def test_old_fields_are_preserved():
    """Written again, a document has its old fields with their values, and new ones."""
    for path in (FIRST_VERSION, SCHEMA_1):
        old, new = json.loads(path.read_bytes()), json.loads(to_json(read_design(path)))
        assert (old.pop("schema_version"), new["schema_version"]) == (1, 2)
        for margin in old["margins"]:
            margin["scenario"] = margin.pop("maneuver", "")
        assert_within(old, new, "design")


def test_fields_missing_in_version_1_have_defaults():
    design = read_design(SCHEMA_1)
    assert (design.supply, design.alternatives, design.buildable.yes) == (None, (), None)
    assert (design.ocs.layout, design.requirement.reliability) == ("pair", None)
    by_name = {margin.name: margin for margin in design.margins}
    assert by_name["bus current"].scenario == "back-flip"
    assert by_name["height"].scenario == ""


def test_flights_passed_in_version_1_were_level_and_stood():
    design = read_design(SCHEMA_1)
    assert [run.passed for run in design.validation] == [True, False] * 3
    assert [run.level for run in design.validation] == [True, None] * 3
    assert [run.stands for run in design.validation] == [True, None] * 3
    document = json.loads(SCHEMA_1.read_bytes())
    for run in document["validation"]:
        # As for a biped, which no device keeps standing.
        run["can_stand"] = False
    fallen = read_back(document)
    assert [run.stands for run in fallen.validation] == [None] * 6


def test_a_document_of_this_version_is_read_back_unchanged(tmp_path):
    design = replace(
        read_design(SCHEMA_1),
        supply=Supply(24.0, 40.0, 960.0),
        alternatives=(Alternative(change="any motor", mass_total=0.4, motor="X", note="n"),),
        buildable=Buildable(yes=False, open=(OpenPoint(what="w", cure="c"),)),
    )
    (tmp_path / "design.json").write_bytes(to_json(design))
    assert read_design(tmp_path / "design.json") == design


@pytest.mark.parametrize(
    ("demand", "capacity", "margin"), [(2.0, 3.0, 1.5), (2.0, None, None), (0.0, 3.0, None)]
)
def test_a_margin_is_written_with_its_factor_or_null(demand, capacity, margin):
    written = Margin("bus power", demand, capacity, "W", note="n")
    assert json.loads(to_json(written)) == {
        "name": "bus power", "demand": demand, "capacity": capacity, "unit": "W",
        "margin": margin, "scenario": "", "note": "n",
    }  # fmt: skip


@pytest.mark.parametrize("version", [0, 3, 99])
def test_other_schema_versions_are_refused(tmp_path, version):
    path = tmp_path / "design.json"
    path.write_text(
        SCHEMA_1.read_text().replace('"schema_version": 1', f'"schema_version": {version}')
    )
    with pytest.raises(OcsError, match=f"schema_version {version}, .* reads 1 to 2"):
        read_design(path)


def read_back(document):
    """The design of a document that is written to a file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "design.json"
        path.write_text(json.dumps(document))
        return read_design(path)


def test_motor_and_carrier_are_read_back(tmp_path):
    design = read_design(FIRST_VERSION)
    drive = replace(geared(3.0), torque_constant=0.0369, resistance=0.608, continuous_torque=0.38)
    motorised = replace(design, ocs=replace(design.ocs, motor=drive, carrier=EC45_BODY))
    (tmp_path / "design.json").write_bytes(to_json(motorised))
    ocs = read_design(tmp_path / "design.json").ocs
    assert (ocs.motor, ocs.carrier) == (drive, EC45_BODY)
    assert ocs.motor.speed_max == EC45.speed_max


def assert_within(old, new, where):
    """`new` has at least what `old` has."""
    if isinstance(old, dict):
        for key, value in old.items():
            assert_within(value, new[key], f"{where}.{key}")
    elif isinstance(old, list):
        assert len(old) == len(new), where
        for index, (old_item, new_item) in enumerate(zip(old, new, strict=True)):
            assert_within(old_item, new_item, f"{where}[{index}]")
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
def test_corrupt_files_are_refused(tmp_path, content, words):
    path = tmp_path / "design.json"
    path.write_bytes(content)
    with pytest.raises(OcsError, match=words):
        read_design(path)


def test_a_pipe_is_refused(tmp_path):
    os.mkfifo(tmp_path / "design.json")
    with pytest.raises(OcsError, match="not a plain file"):
        read_design(tmp_path / "design.json")
