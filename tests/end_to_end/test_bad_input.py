"""Bad input of every kind: the right exit code, words to act on, nothing left behind."""

import errno
import gzip
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
from commands import PROGRAM, SOLO12, environment, everything_in, run, run_process
from urdf_text import LIMIT, inertial, joint, link, robot

from ocs_design.export.folder import file_hashes

SOLO12_TEXT = Path(SOLO12).read_bytes()
BOMB = (
    '<!DOCTYPE r [<!ENTITY e0 "aaaaaaaaaa">'
    + "".join(f'<!ENTITY e{n + 1} "{f"&e{n};" * 10}">' for n in range(9))
    + ']><robot name="&e9;"><link name="a"/></robot>'
).encode()
LOOP = robot(
    link("a", inertial()), link("b", inertial()), joint("j", "a", "b"), joint("k", "b", "a")
)
ZIPPED = gzip.compress(SOLO12_TEXT, mtime=0)
GARBLED = ZIPPED[:500] + bytes(64) + ZIPPED[564:]
XACRO = b'<robot name="r"><xacro:macro name="leg"/></robot>'

# Bound alone: the quickest way to size, where what is tested has nothing to do with motors.
BOUND = ("--motor", "none")
BY_HAND = ("--mass", "2.5", "--inertia", "0.032,0.055,0.07")
QUAD = " ".join(("size", *BY_HAND))
MOTORS = b"""name,maker,source,mass_kg,kt_nm_per_a,kt_convention,kv_rpm_per_v,rated_voltage_v
fine,me,bench,0.1,0.02,six-step,,24
heavy,me,bench,plenty,0.02,six-step,,24
other,me,bench,0.1,0.02,six-step,413.5,24
"""

EXIT_2, EXIT_3 = (2, "usage"), (3, "robot")
SPECIFICATION, OUTPUT, INFEASIBLE = (3, "specification"), (3, "output"), (4, "infeasible")

# What is wrong: files to write, what to type, exit code and kind, and what must be said.
CASES = {
    "missing file": ({}, "size rover.urdf", EXIT_3, "rover.urdf does not exist|check the path"),
    "misspelt file": ({"rover.urdf": LOOP}, "size rover.urf", EXIT_3, "did you mean rover.urdf"),
    "a folder": ({"a/rover.urdf": LOOP}, "size a", EXIT_3, "a is a folder|a/rover.urdf"),
    "empty file": ({"x.urdf": b" \n"}, "size x.urdf", EXIT_3, "x.urdf is empty"),
    "not XML": ({"x.urdf": b"solid cube"}, "size x.urdf", EXIT_3, "x.urdf: the file is not XML"),
    "broken XML": (
        {"x.urdf": b"<robot>\n<link></robot>"},
        "size x.urdf",
        EXIT_3,
        "x.urdf: line 2, column|every tag is closed",
    ),
    "no robot": ({"x.xml": b"<html/>"}, "size x.xml", EXIT_3, "x.xml: .*no robot.*<html>|URDF"),
    "SDF": (
        {"x.sdf": b"<sdf/>"},
        "size x.sdf",
        EXIT_3,
        "x.sdf: the file is SDF|convert it to URDF",
    ),
    "unexpanded xacro": ({"x.urdf": XACRO}, "size x.urdf", EXIT_3, "x.urdf: .*xacro|xacro robot"),
    "no link": ({"x.urdf": robot()}, "size x.urdf", EXIT_3, "x.urdf: the <robot> has no <link>"),
    "missing inertial": (
        {"x.urdf": robot(link("trunk"), link("leg"), joint("hip", "trunk", "leg", LIMIT))},
        "size x.urdf",
        EXIT_3,
        "x.urdf: .*no mass.*'trunk'|give link 'trunk' its mass",
    ),
    "negative mass": (
        {"x.urdf": robot(link("trunk", inertial(-2.0)))},
        "size x.urdf",
        EXIT_3,
        "x.urdf: link 'trunk' has the negative mass -2 kg|<mass value>",
    ),
    "impossible inertia": (
        {"x.urdf": robot(link("trunk", inertial(2.0, "0.1 0.1 1.0")))},
        "size x.urdf",
        EXIT_3,
        "x.urdf: .*triangle inequality|first of 'trunk'",
    ),
    "NaN": (
        {"x.urdf": robot(link("trunk", inertial(2.0, "nan 0.1 0.1")))},
        "size x.urdf",
        EXIT_3,
        "x.urdf: link 'trunk': ixx=\"nan\"|plain number",
    ),
    "loop of joints": ({"x.urdf": LOOP}, "size x.urdf", EXIT_3, "x.urdf: .*'a', 'b'.*loop|cut"),
    "entity bomb": ({"x.urdf": BOMB}, "size x.urdf", EXIT_3, "x.urdf: .*entities|write the values"),
    "truncated gzip": (
        {"x.urdf.gz": ZIPPED[:500]},
        "size x.urdf.gz",
        EXIT_3,
        "x.urdf.gz is a gzip file that ends too early|fetch it again",
    ),
    "garbled gzip": (
        {"x.urdf.gz": GARBLED},
        "size x.urdf.gz",
        EXIT_3,
        "x.urdf.gz is a broken gzip|fetch it again",
    ),
    "nothing on standard input": ({}, "size -", EXIT_3, "standard input is empty"),
    "unknown link": ({}, f"size {SOLO12} --trunk base", EXIT_2, "no link 'base'|base_link"),
    "unknown posture": ({}, f"size {SOLO12} --posture sit", EXIT_2, "'sit'|stand, zero"),
    "unknown joint": ({}, f"size {SOLO12} --joint hip=1", EXIT_2, "moving joint 'hip'|FL_HAA"),
    "joint without a value": ({}, f"size {SOLO12} --joint foo", EXIT_2, "'foo'.*NAME=VALUE|10deg"),
    "joint at no number": ({}, f"size {SOLO12} --joint FL_HAA=up", EXIT_2, "--joint.FL_HAA.*'up'"),
    "unknown key": (
        {"s.toml": b"[flywheel]\nrmax = '30mm'\n[ocs]\nalhpa = 1"},
        f"size {SOLO12} --spec s.toml",
        SPECIFICATION,
        "s.toml has 2 faults|flywheel.rmax: unknown key|'r_max'|ocs.alhpa|'alpha'",
    ),
    "bad unit in the file": (
        {"s.toml": b"[flywheel]\nr_max = '30 furlong'"},
        f"size {SOLO12} --spec s.toml",
        SPECIFICATION,
        "flywheel.r_max: .*'furlong'|mm",
    ),
    "bad unit": ({}, f"size {SOLO12} --r-max 30furlong", EXIT_2, "--r-max: .*'furlong'|mm, cm"),
    "metres for millimetres": (
        {},
        f"size {SOLO12} --r-max 30",
        SPECIFICATION,
        "r_max: 30 m is larger than the robot|did you mean 30mm",
    ),
    "degrees without a unit": ({}, f"size {SOLO12} --alpha 40", EXIT_2, "--alpha.*|40deg"),
    "unknown material": (
        {},
        f"size {SOLO12} --material stele",
        SPECIFICATION,
        "no material 'stele'|stainless-304|aluminium-6061-t6",
    ),
    "unknown criterion": (
        {},
        f"size {SOLO12} --alpha-criterion best",
        EXIT_2,
        "--alpha-criterion: 'best'|equal-rate, weighted",
    ),
    "two robots": ({}, f"size {SOLO12} --mass 2 --inertia 1,1,1", EXIT_2, "exclude each other"),
    "half a robot": ({}, "size --mass 2", EXIT_2, "both its mass and its inertia|--inertia IXX"),
    "no robot named": ({}, "size", EXIT_2, "no robot is given|--mass and --inertia"),
    "no robot in the file": ({"s.toml": b""}, "size --spec s.toml", EXIT_2, "no robot is given"),
    "its robot is missing": (
        {"deep/s.toml": b"robot.file = 'rover.urdf'"},
        "size --spec deep/s.toml",
        EXIT_3,
        "deep/rover.urdf does not exist",
    ),
    "missing specification": ({}, "size --spec s.toml", SPECIFICATION, "s.toml: No such|--spec"),
    "not TOML": (
        {"s.toml": b"[flywheel]\nr_max = 30mm"},
        f"size {SOLO12} --spec s.toml",
        SPECIFICATION,
        "s.toml is not TOML.*line 2|quotes",
    ),
    "not UTF-8": (
        {"s.toml": "# Größe".encode("latin-1")},
        f"size {SOLO12} --spec s.toml",
        SPECIFICATION,
        "s.toml, line 1: not UTF-8|save the file so",
    ),
    "unknown command": ({}, f"siez {SOLO12}", EXIT_2, "'siez'.*'size'|ocs-design --help"),
    "unknown option": ({}, f"size {SOLO12} --rmax 1", EXIT_2, "--rmax.*--r-max|size --help"),
    "option without a value": ({}, f"size {SOLO12} --force --r-max", EXIT_2, "--r-max"),
    "package path without a folder": (
        {},
        f"size {SOLO12} --package-path solo",
        EXIT_2,
        "--package-path solo|NAME=DIR",
    ),
    "an output that is there": (
        {"out/design.json": b"{}"},
        f"size {SOLO12} -o out",
        OUTPUT,
        "out: exists already|-o.*--force",
    ),
    "an output of another kind": (
        {"out/thesis.txt": b"years of work"},
        f"size {SOLO12} -o out --force",
        OUTPUT,
        "out: .*holds no design.json|another folder with -o",
    ),
    "an output that is a file": ({"out": b""}, f"size {SOLO12} -o out", OUTPUT, "not a folder"),
    "an output in a file": ({"a": b""}, f"size {SOLO12} -o a/b", OUTPUT, "a: .*|is a file"),
    "an output nowhere": ({}, f"size {SOLO12} -o no/where", OUTPUT, "no such folder|create"),
    "unknown motor": (
        {},
        f"{QUAD} --motor maxon",
        SPECIFICATION,
        "motor.name: there is no motor 'maxon'|`ocs-design catalogue motors` lists",
    ),
    "half a motor's name": ({}, f"{QUAD} --motor R80", SPECIFICATION, "motor.name: .*R80 KV110"),
    "unknown gear": (
        {},
        f"{QUAD} --gear planet",
        SPECIFICATION,
        "motor.gear: there is no gear 'planet'|GPX 12",
    ),
    "unknown motor, gear and material": (
        {},
        f"{QUAD} --motor maxon --gear planet --material wood",
        SPECIFICATION,
        "motor.name: .*'maxon'|motor.gear: .*'planet'|flywheel.material: .*'wood'",
    ),
    "a motor file with faults": (
        {"mine.csv": MOTORS},
        f"{QUAD} --motors mine.csv",
        SPECIFICATION,
        r"mine.csv has 2 faults|line 3 \(heavy\), mass_kg: 'plenty' is not a number|"
        r"line 4 \(other\): .*not six-step. it fits foc",
    ),
    "a motor file of another kind": (
        {"mine.xlsx": b"PK"},
        f"{QUAD} --motors mine.xlsx",
        SPECIFICATION,
        "mine.xlsx: is neither .csv nor .toml",
    ),
    "no motor file": ({}, f"{QUAD} --motors mine.csv", SPECIFICATION, "mine.csv: No such|path"),
    "a gear file with a fault": (
        {"mine.toml": b"[[gear]]\nname = 'g'\nmaker = 'me'\nsource = 'x'\nkind = 'worm'"},
        f"{QUAD} --gears mine.toml",
        SPECIFICATION,
        r"mine.toml has |gear\[1\] \(g\), kind: 'worm' is none of",
    ),
    "no voltage": ({}, f"{QUAD} --bus-voltage 0", EXIT_2, "--bus-voltage: 0 must be positive"),
    "a negative voltage": ({}, f"{QUAD} --bus-voltage=-24V", EXIT_2, "-24V must be positive"),
    "a voltage in ampere": ({}, f"{QUAD} --bus-voltage 24A", EXIT_2, "--bus-voltage: .*'A'|V"),
    "the lightest device without motors": (
        {},
        f"{QUAD} --motor none --alpha-criterion lightest",
        SPECIFICATION,
        "ocs.alpha_criterion: 'lightest' needs a motor|motor.name is 'none'",
    ),
    "a supply and a gear without motors": (
        {},
        f"{QUAD} --motor none --bus-voltage 24V --gear direct --co-design",
        SPECIFICATION,
        "motor.bus_voltage: says nothing|motor.gear: says nothing|ocs.co_design: needs a motor",
    ),
    "a motor whose figures are missing": (
        {
            "s.toml": b"robot.mass = 2.5\nrobot.inertia = [0.032, 0.055, 0.07]\n"
            b"motor.name = 'EC 20 flat 5 W 351005'"
        },
        "size --spec s.toml",
        INFEASIBLE,
        "EC 20 flat 5 W 351005 cannot do it at 24 V|"
        "gives no torque constant, resistance, peak torque or current",
    ),
    "nothing to bound": ({}, "bound", EXIT_2, "'--inertia'|bound --help"),
    "no such catalogue": ({}, "catalogue bolts", EXIT_2, "no catalogue of bolts|materials"),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty working folder, where xacro is not installed."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "xacro", None)
    return tmp_path


@pytest.mark.parametrize(("files", "typed", "expected", "words"), CASES.values(), ids=CASES)
def test_bad_input_is_explained(folder, files, typed, expected, words):
    for name, content in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    before = everything_in(folder)
    said = run(*typed.split())
    assert (said.code, said.stdout) == (expected[0], "")
    for word in words.split("|"):
        assert re.search(word, said.said), said.stderr
    check_json(run(*typed.split(), "--json"), expected, words)
    assert everything_in(folder) == before


def check_json(result, expected, words):
    """One document, which says what the panel says, and nothing beside it."""
    assert (result.code, result.stderr) == (expected[0], "")
    assert set(result.document) == {"schema_version", "error"}
    error = result.document["error"]
    assert error["kind"] == expected[1]
    everything = " ".join([error["message"], *error.get("problems", ()), error["hint"]])
    for word in words.split("|"):
        assert re.search(word, everything, re.DOTALL)


def test_a_xacro_that_cannot_be_expanded(tmp_path, monkeypatch):
    pytest.importorskip("xacro")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"><link name="${n}"/></robot>'
    )
    result = run("size", "x.xacro")
    assert result.code == 3
    assert "x.xacro: xacro cannot expand the file" in result.said
    assert everything_in(tmp_path) == ["x.xacro"]


SHAPED = robot(
    link("trunk", inertial(2.0, "0.02 0.03 0.04"), "<visual><geometry>{}</geometry></visual>")
).decode()


@pytest.mark.parametrize(
    ("content", "warning"),
    [
        (SHAPED.format('<mesh filename="package://gone/trunk.stl"/>').encode(), "gone/trunk.stl"),
        (SHAPED.format('<mesh filename="tr\xfcnk.stl"/>').encode("latin-1"), "not UTF-8"),
    ],
    ids=["a mesh that is not there", "undeclared Latin-1"],
)
def test_what_is_only_odd_works_with_a_warning(folder, content, warning):
    (folder / "rover.urdf").write_bytes(content)
    result = run("size", "rover.urdf", *BOUND, "--no-validate")
    assert (result.code, result.stdout) == (0, "")
    assert re.search(rf"warning: .*{warning}", result.said)
    strict = run(
        "size", "rover.urdf", *BOUND, "--no-validate", "--strict", "-o", "strict", "--json"
    )
    assert (strict.code, strict.document["error"]["kind"]) == (3, "robot")
    assert warning in strict.document["error"]["message"]
    assert sorted(path.name for path in folder.iterdir()) == ["rover.urdf", "test-ocs"]


@contextmanager
def small_disk(folder, kib):
    """A disk of that size at `folder`, where the system lets us mount one."""
    mount = shutil.which("mount")
    made = mount and subprocess.run(
        [mount, "-t", "tmpfs", "-o", f"size={kib}k", "none", str(folder)],
        capture_output=True,
        check=False,
    )
    if not made or made.returncode:
        pytest.skip("a disk of its own can be mounted by root only")
    try:
        yield lambda *options: subprocess.run([mount, *options, str(folder)], check=True)
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def test_a_full_disk(folder):
    (folder / "disk").mkdir()
    with small_disk(folder / "disk", kib=256):
        result = run("size", SOLO12, *BOUND, "--no-validate", "-o", "disk/out")
        assert (result.code, result.stdout) == (3, "")
        assert re.search("No space left on device.*free some space", result.said)
        assert everything_in(folder) == ["disk"]


def test_a_disk_that_fills_up_anywhere(folder, monkeypatch):
    written = []

    def write_bytes(path, content, original=Path.write_bytes):
        written.append(path)
        if len(written) == 5:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        return original(path, content)

    monkeypatch.setattr(Path, "write_bytes", write_bytes)
    result = run("size", SOLO12, *BOUND, "--no-validate", "--json")
    assert result.code == 3
    assert result.document["error"]["kind"] == "output"
    assert str(written[-1]) in result.document["error"]["message"]
    assert everything_in(folder) == []


def test_a_parent_that_is_read_only(folder):
    parent = folder / "locked"
    parent.mkdir()
    if os.geteuid() == 0:
        with small_disk(parent, kib=64) as mount:
            mount("-o", "remount,ro")
            result = run("size", SOLO12, *BOUND, "-o", "locked/out")
    else:
        parent.chmod(0o555)
        result = run("size", SOLO12, *BOUND, "-o", "locked/out")
    assert result.code == 3
    assert re.search(
        "cannot be written to choose a folder that you may write to with -o", result.said
    )
    assert everything_in(folder) == ["locked"]


def test_a_failing_run_keeps_the_output_that_it_was_to_replace(folder):
    assert run("size", SOLO12, *BOUND, "--no-validate", "-o", "out").code == 0
    before = file_hashes(folder)
    weak = ("--motor", "Antigravity 4004 KV300")
    assert run("size", SOLO12, *weak, "-o", "out", "--force").code == 4
    assert file_hashes(folder) == before


TOO_TIGHT = {
    "radius": ("--r-max", "20mm"),
    "radius and height": ("--r-max", "20mm", "--h-max", "2.5mm"),
    "height": ("--h-max", "2.1mm"),
    "mass": ("--wheel-mass-max", "20g"),
    "slow wheels": ("--wheel-speed-max", "1000rpm"),
    "stress": ("--wheel-speed-max", "50000rpm", "--r-min", "40mm"),
    "room": ("--wall-min", "40mm", "--r-min", "20mm"),
    "thin room": ("--r-max", "49mm", "--r-min", "48mm"),
    "rate": ("--rate-change", "30", "--r-max", "30mm"),
}
WHEELS_ALONE = ("--motor", "none", "--no-validate")
RELAXATION = re.compile(
    r"\b(?P<key>[a-z_]+) (?P<figure>[\d.e+]+)(?: (?P<unit>mm|g|rpm))?(?=[;.] ?)"
)


@pytest.mark.parametrize("robot_given", [(SOLO12,), BY_HAND], ids=["Solo12", "by hand"])
@pytest.mark.parametrize("limits", TOO_TIGHT.values(), ids=TOO_TIGHT)
def test_what_the_hint_proposes_works_as_it_is_printed(folder, limits, robot_given):
    result = run("size", *robot_given, *limits, *WHEELS_ALONE, "--json")
    error = result.document["error"]
    assert (result.code, result.stderr, error["kind"]) == (4, "", "infeasible")
    assert error["binding"]
    assert error["largest_spin_inertia"] < error["required_spin_inertia"]
    assert everything_in(folder) == []
    proposed = {match["key"]: match for match in RELAXATION.finditer(error["hint"] + " ")}
    assert set(proposed) | {"hoop_stress"} == set(error["relaxations"]) | {"hoop_stress"}
    assert error["relaxations"]
    for key, match in proposed.items():
        typed = (f"--{key.replace('_', '-')}", f"{match['figure']}{match['unit'] or ''}")
        mended = run("size", *robot_given, *limits, *typed, *WHEELS_ALONE, "-o", key)
        assert mended.code == 0, (typed, mended.said)
    assert sorted(path.name for path in folder.iterdir()) == sorted(proposed)


def test_a_missing_authority_is_no_matter_of_size(folder):
    result = run("size", SOLO12, "--alpha", "0", "--motor", "none", "--json")
    error = result.document["error"]
    assert (result.code, error["binding"], error["relaxations"]) == (4, ["incidence"], {})
    assert "roll momentum" in error["message"]


def test_no_motor_reaches_an_axis_that_the_incidence_leaves_out(folder):
    result = run("size", SOLO12, "--alpha", "0", "--motor", "R80 KV110", "--json")
    assert result.code == 4
    assert "axis out of reach" in result.document["error"]["message"]
    assert everything_in(folder) == []


def test_a_motor_that_is_too_weak_is_told_how_much_time_it_needs(folder):
    """No limit of the room mends a torque: Solo12's own motor needs longer for the drop."""
    result = run("size", SOLO12, "--motor", "Antigravity 4004 KV300", "--json")
    error = result.document["error"]
    assert (result.code, result.stderr, error["kind"]) == (4, "", "infeasible")
    for words in ("Antigravity 4004 KV300", "24 V", "drop", "0.385 s given"):
        assert words in error["message"]
    assert set(error["relaxations"]) == {"time"}
    assert 1.0 < error["relaxations"]["time"] < 2.0
    assert everything_in(folder) == []


def test_a_robot_that_no_motor_can_turn(folder):
    """Told within seconds: what is missing, and what would do."""
    began = time.monotonic()
    result = run("size", "--mass", "200", "--inertia", "40,60,60", "--json")
    assert time.monotonic() - began < 30.0
    error = result.document["error"]
    assert (result.code, error["kind"], error["binding"]) == (4, "infeasible", ["torque"])
    assert re.search(r"None of \d+ motors can do it at 48 V; .* comes closest", error["message"])
    assert set(error["relaxations"]) == {"time"}
    assert f"{error['relaxations']['time']:.3g} times what is given" in error["hint"]
    assert everything_in(folder) == []


ONE_DRIVE = (
    *("--motor", "EC 90 flat 90 W 323772", "--gear", "direct"),
    *("--material", "stainless-304", "--alpha", "35deg", "--no-validate"),
)
TOO_TIGHT_FOR_MOTORS = {
    "room": ("--r-max", "40mm", "--h-max", "2.1mm"),
    "voltage": ("--bus-voltage", "5V"),
}


@pytest.mark.parametrize("limits", TOO_TIGHT_FOR_MOTORS.values(), ids=TOO_TIGHT_FOR_MOTORS)
def test_what_the_hint_proposes_for_a_motor_works_as_it_is_printed(folder, limits):
    told = run("size", *BY_HAND, *ONE_DRIVE, *limits)
    assert told.code == 4
    proposed = list(re.finditer(r"\b(r_max|h_max|bus_voltage) ([\d.]+) (mm|V)", told.said))
    assert proposed, told.said
    for key, figure, unit in (match.groups() for match in proposed):
        option = f"--{key.replace('_', '-')}"
        mended = run("size", *BY_HAND, *ONE_DRIVE, *limits, option, figure + unit, "-o", key)
        assert mended.code == 0, (option, figure, unit, mended.said)


def test_a_voltage_without_a_unit_is_in_volt(folder):
    for voltage in ("24", "24V"):
        result = run(
            "size", *BY_HAND, *ONE_DRIVE, "--bus-voltage", voltage, "-o", voltage, "--json"
        )
        assert result.document["selection"]["bus_voltage"] == 24.0


@pytest.mark.parametrize("typed", ["inspect --json", "size", "inspect"])
def test_the_reader_of_the_output_may_leave(folder, typed):
    """As `head` does: no complaint, and nothing half done is left."""
    command, *options = typed.split()
    reading, writing = os.pipe()
    os.close(reading)
    streams = {"stdout": writing, "stderr": subprocess.PIPE if options else writing}
    process = subprocess.Popen([*PROGRAM, command, SOLO12, *options], **streams)
    os.close(writing)
    complaint = process.communicate()[1]
    assert not complaint
    assert process.returncode == 141
    assert everything_in(folder) == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda each: each.name)
def test_an_interrupt_leaves_nothing(folder, number):
    process = subprocess.Popen(
        [*PROGRAM, "size", SOLO12, *BOUND], stderr=subprocess.PIPE, text=True
    )
    deadline = time.monotonic() + 60.0
    while not any(folder.glob(".*/robot/*.urdf")) and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(number)
    _, said = process.communicate()
    assert "Traceback" not in said
    assert process.returncode == 130
    assert said.endswith("interrupted; nothing was written\n")
    assert everything_in(folder) == []


def test_a_process_of_its_own_says_the_same(folder):
    """All else here runs inside the tests' own process."""
    for typed in ("size rover.urdf", "size rover.urdf --json", "siez"):
        own = run_process(*typed.split(), env=environment(COLUMNS="80"))
        here = run(*typed.split())
        assert (own.code, without_times(own.said)) == (here.code, without_times(here.said))
        assert own.stdout == here.stdout
    assert everything_in(folder) == []


def without_times(said):
    return re.sub(r"[0-9.]+ s\b", "", said)
