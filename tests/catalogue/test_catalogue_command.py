"""`catalogue motors`, `gears` and `materials`: tables and JSON."""

import csv
import re

import pytest
from commands import ROOT, failure, run

MINE = """[[motor]]
name = "my motor"
maker = "me"
source = "my bench"
mass_kg = 0.0205
kv_rpm_per_v = 1000
resistance_ohm = 0.1
resistance_between = "line-line"
rated_voltage_v = 16.8
peak_current_a = 12
remark = "wound by hand"
"""


@pytest.mark.parametrize("catalogue", ["motors", "gears", "materials"])
def test_the_listing_has_the_rows_of_the_file(catalogue):
    listed = run("catalogue", catalogue, "--json").document[catalogue]
    path = ROOT / "ocs_design" / "catalogue" / f"{catalogue}.csv"
    rows = {row["name"]: row for row in csv.DictReader(path.read_text().splitlines())}
    assert [entry["name"] for entry in listed] == sorted(rows)
    assert all(entry["source"] == rows[entry["name"]]["source"] for entry in listed)


def test_json_is_in_si_units_with_missing_figures():
    listed = {row["name"]: row for row in run("catalogue", "motors", "--json").document["motors"]}
    assert listed["R80 KV110"]["missing"] == []
    assert listed["R80 KV110"]["no_load_speed"] == pytest.approx(549.78, abs=0.01)
    assert listed["4221 G 024 BXTH"]["missing"] == ["mass"]


def test_the_table_has_figures_marks_and_missing_data():
    """Each motor is one line, so that grep works."""
    result = run("catalogue", "motors")
    text = result.output
    assert re.search(r"^  MN5212 KV340 .* -$", result.stdout, re.MULTILINE)
    assert "U8 Lite KV100 238 50.4 5,040 2.8+ 95.5 - " in text
    assert "R80 KV110 354 48 5,250 4 86.8 stator" in text
    assert "1.22* 37.7 stator +2" in text
    assert "ILM85x26 670 48 1,560 9.4 292 bearings +2" in text
    assert "4221 G 024 BXTH" in text.split("Cannot be built with")[1]
    assert "SwRI/SymBench" in text
    assert re.search(r"1 to 2 14 \d+ 2 to 5 16 \d+ 5 to 20 6 \d+", text)


def test_the_table_of_gears():
    text = run("catalogue", "gears").output
    assert "GP 32 C 166936 23.04:1 23.040 160 424.7 3.75 8,000 -" in text
    assert "GP 42 C 203115: no inertia_kg_m2" in text


@pytest.mark.parametrize("width", [80, pytest.param(120, marks=pytest.mark.slow)])
@pytest.mark.parametrize("catalogue", ["motors", "gears"])
def test_no_row_of_the_table_wraps(catalogue, width, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(width))
    result = run("catalogue", catalogue)
    assert (result.code, result.stderr) == (0, "")
    lines = result.stdout.splitlines()
    start = next(index for index, line in enumerate(lines) if "──" in line) + 1
    end = next(
        index
        for index in range(start, len(lines))
        if lines[index].startswith("  + " if catalogue == "motors" else "  ratio:")
    )
    names = {line[2:].split("  ")[0].strip() for line in lines[start:end]}
    assert "" not in names
    assert max(map(len, lines)) <= width
    assert "\x1b" not in result.stdout


@pytest.mark.slow
def test_a_users_file_joins_the_table(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(MINE)
    result = run("catalogue", "motors", "--motors", path)
    assert "my motor 20 16.8 16,800 0.115+ 9.55 kind +6" in result.output
    assert "MN4012 KV480" in result.output
    assert "Also list the motors" in run("catalogue", "--help").output
    assert "my motor: my bench" in result.output
    assert "wound by hand" not in result.output
    assert "wound by hand" in run("catalogue", "motors", "--motors", path, "-v").output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("gears", "--motors", "m.csv"), "--motors has no effect on gears"),
        (("materials", "--gears", "g.csv"), "--gears has no effect on materials"),
    ],
)
def test_options_of_other_catalogues_are_wrong_usage(arguments, words):
    assert words in failure(2, "catalogue", *arguments)


@pytest.mark.slow
def test_implausible_figures_of_a_users_file_raise_a_warning(tmp_path):
    """They are on standard error, or in the document."""
    path = tmp_path / "mine.toml"
    path.write_text(MINE.replace("0.0205", "20.5"))
    result = run("catalogue", "motors", "--motors", path)
    assert "warning:" in result.stderr
    assert "did you mean 0.0205 kg?" in result.stderr
    (warning,) = run("catalogue", "motors", "--motors", path, "--json").document["warnings"]
    assert "mass_kg is 20.5 kg" in warning
    assert run("catalogue", "motors", "--json").document["warnings"] == []
