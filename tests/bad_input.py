"""Bad input of every kind and the message it must give; typing errors are in docs/hostile.md."""

import gzip
from pathlib import Path

from commands import BY_HAND, SOLO12
from urdf_text import inertial, link, robot

SOLO12_TEXT = Path(SOLO12).read_bytes()
ZIPPED = gzip.compress(SOLO12_TEXT, mtime=0)
GARBLED = ZIPPED[:500] + bytes(64) + ZIPPED[564:]

QUAD = " ".join(("size", *BY_HAND))
MOTORS = b"""name,maker,source,mass_kg,kt_nm_per_a,kt_convention,kv_rpm_per_v,rated_voltage_v
fine,me,bench,0.1,0.02,six-step,,24
heavy,me,bench,plenty,0.02,six-step,,24
other,me,bench,0.1,0.02,six-step,413.5,24
"""

EXIT_2, EXIT_3 = (2, "usage"), (3, "robot")
SPECIFICATION, OUTPUT, INFEASIBLE = (3, "specification"), (3, "output"), (4, "infeasible")

# Fault: files to write, command line, exit code and kind, and patterns of the message.
CASES = {
    "missing file": ({}, "size rover.urdf", EXIT_3, "rover.urdf does not exist|check the path"),
    "broken XML": (
        {"x.urdf": b"<robot>\n<link></robot>"},
        "size x.urdf",
        EXIT_3,
        "x.urdf: line 2, column .* mismatched tag in '<link></robot>'|every tag is closed",
    ),
    "two XML files in one": (
        {"x.urdf": b'<robot/>\n<?xml version="1.0"?><robot/>'},
        "size x.urdf",
        EXIT_3,
        "x.urdf: line 2, .*junk after document element|every tag is closed",
    ),
    "a zero byte": (
        {"x.urdf": b"<robot/>\0"},
        "size x.urdf",
        EXIT_3,
        "x.urdf: line 1, .*not well-formed|remove the null bytes",
    ),
    "negative mass": (
        {"x.urdf": robot(link("trunk", inertial(-2.0)))},
        "size x.urdf",
        EXIT_3,
        "x.urdf: link 'trunk' has the negative mass -2 kg|<mass value>",
    ),
    "garbled gzip": (
        {"x.urdf.gz": GARBLED},
        "size x.urdf.gz",
        EXIT_3,
        "x.urdf.gz is a broken gzip|fetch it again",
    ),
    "empty standard input": ({}, "size -", EXIT_3, "standard input is empty"),
    "millivolts": ({}, f"size {SOLO12} --bus-voltage 24000", EXIT_2, "above 1000 V|24000mV"),
    "unknown key": (
        {"s.toml": b"[flywheel]\nrmax = '30mm'\n[ocs]\nalhpa = 1"},
        f"size {SOLO12} --spec s.toml",
        SPECIFICATION,
        "s.toml has 2 faults|flywheel.rmax: unknown key|'r_max'|ocs.alhpa|'alpha'",
    ),
    "no robot given": ({}, "size", EXIT_2, "no robot is given|--mass and --inertia"),
    "missing robot of a specification": (
        {"deep/s.toml": b"robot.file = 'rover.urdf'"},
        "size --spec deep/s.toml",
        EXIT_3,
        "deep/rover.urdf does not exist",
    ),
    "not TOML": (
        {"s.toml": b"[flywheel]\nr_max = 30mm"},
        f"size {SOLO12} --spec s.toml",
        SPECIFICATION,
        "s.toml is not TOML.*line 2|quotes",
    ),
    "option without a value": ({}, f"size {SOLO12} --force --r-max", EXIT_2, "--r-max"),
    "package path without a folder": (
        {},
        f"size {SOLO12} --package-path solo",
        EXIT_2,
        "--package-path solo|NAME=DIR",
    ),
    "existing output": (
        {"out/design.json": b"{}"},
        f"size {SOLO12} -o out",
        OUTPUT,
        "out: exists already|-o.*--force",
    ),
    "output below a file": ({"a": b""}, f"size {SOLO12} -o a/b", OUTPUT, "a: .*|is a file"),
    "output in a missing folder": (
        {},
        f"size {SOLO12} -o no/where",
        OUTPUT,
        "no such folder|create",
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
    "a gear file with a fault": (
        {"mine.toml": b"[[gear]]\nname = 'g'\nmaker = 'me'\nsource = 'x'\nkind = 'worm'"},
        f"{QUAD} --gears mine.toml",
        SPECIFICATION,
        r"mine.toml has |gear\[1\] \(g\), kind: 'worm' is not one of",
    ),
    "a supply and a gear without motors": (
        {},
        f"{QUAD} --motor none --bus-voltage 24V --gear direct --co-design",
        SPECIFICATION,
        "motor.gear: has no effect|supply.voltage: has no effect|ocs.co_design: needs a motor",
    ),
    "a motor with missing figures": (
        {
            "s.toml": b"robot.mass = 2.5\nrobot.inertia = [0.032, 0.055, 0.07]\n"
            b"motor.name = 'ILM70x10'"
        },
        "size --spec s.toml",
        INFEASIBLE,
        "ILM70x10 cannot do it at 24 V|"
        "gives no torque constant, resistance, peak torque or current|Choose another motor|"
        "--motors",
    ),
    "nothing to bound": ({}, "bound", EXIT_2, "'--inertia'|bound --help"),
}
