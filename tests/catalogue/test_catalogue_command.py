"""`catalogue motors` and `catalogue gears` as people and programs meet them."""

import csv
import json

import pytest
from commands import ROOT, environment, run, run_process

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


@pytest.mark.parametrize("what", ["motors", "gears"])
def test_the_listing_is_the_file(what):
    listed = run("catalogue", what, "--json").document[what]
    path = ROOT / "ocs_design" / "catalogue" / f"{what}.csv"
    rows = {row["name"]: row for row in csv.DictReader(path.read_text().splitlines())}
    assert [entry["name"] for entry in listed] == sorted(rows)
    assert all(entry["source"] == rows[entry["name"]]["source"] for entry in listed)


def test_json_is_in_si_and_says_what_is_missing():
    listed = {row["name"]: row for row in run("catalogue", "motors", "--json").document["motors"]}
    assert listed["R80 KV110"]["missing"] == []
    assert listed["R80 KV110"]["no_load_speed"] == pytest.approx(549.78, abs=0.01)
    assert listed["4221 G 024 BXTH"]["missing"] == ["mass"]


def test_people_read_figures_marks_and_what_is_missing():
    said = run("catalogue", "motors").said
    assert "R80 KV110 354 48 5250 4 86.8 0.125" in said
    assert "Antigravity MN4006 KV380 68 25.2 9576 0.402+ 25.1 0.194" in said
    assert "1.22* 37.7" in said
    assert "4221 G 024 BXTH: no mass" in said
    assert "SwRI/SymBench" in said


def test_gears_in_words():
    said = run("catalogue", "gears").said
    assert "GP 32 C 166936 23.04:1 23.040 160 424.7 3.75 8000 -" in said
    assert "GP 42 C 203115: no inertia_kg_m2" in said


@pytest.mark.parametrize("width", [80, 120])
@pytest.mark.parametrize("what", ["motors", "gears"])
def test_no_row_of_the_table_wraps(what, width):
    result = run_process("catalogue", what, env=environment(COLUMNS=str(width), NO_COLOR="1"))
    assert (result.code, result.stdout) == (0, "")
    lines = result.stderr.splitlines()
    start = next(index for index, line in enumerate(lines) if "──" in line) + 1
    end = next(
        index
        for index in range(start, len(lines))
        if lines[index].startswith("  + " if what == "motors" else "  ratio:")
    )
    names = {line[2:].split("  ")[0].strip() for line in lines[start:end]}
    assert "" not in names
    assert max(map(len, lines)) <= width
    assert "\x1b" not in result.stderr


def test_a_users_file_joins_the_table(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(MINE)
    result = run("catalogue", "motors", "--motors", path)
    assert "my motor 20 16.8 16800 0.115+ 9.55 0.100" in result.said
    assert "my motor: my bench" in result.said
    assert "wound by hand" not in result.said
    assert "wound by hand" in run("catalogue", "motors", "--motors", path, "-v").said


def test_a_users_file_with_faults_is_told(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(MINE.replace("0.0205", "'20 g'"))
    result = run("catalogue", "motors", "--motors", path, "--json")
    assert result.code == 3
    error = json.loads(result.stdout)["error"]
    assert error["problems"] == ["motor[1] (my motor), mass_kg: '20 g' is not a number"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("gears", "--motors", "m.csv"), "--motors says nothing of gears"),
        (("materials", "--gears", "g.csv"), "--gears says nothing of materials"),
        (("cheeses",), "try: catalogue motors, catalogue gears, catalogue materials"),
    ],
)
def test_what_makes_no_sense_is_wrong_usage(arguments, words):
    result = run("catalogue", *arguments)
    assert result.code == 2
    assert words in result.said
