"""Bad input of every kind and what must be said of it."""

import gzip
from pathlib import Path

from commands import BY_HAND, SOLO12
from urdf_text import LIMIT, inertial, joint, link, robot

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
        "x.urdf: line 1, .*not well-formed|remove the bytes that are zero",
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
    "unknown link": ({}, f"size {SOLO12} --trunk base", EXIT_3, "no link 'base'|base_link"),
    "unknown posture": ({}, f"size {SOLO12} --posture sit", EXIT_3, "'sit'|stand, zero"),
    "unknown joint": ({}, f"size {SOLO12} --joint hip=1", EXIT_3, "moving joint 'hip'|FL_HAA"),
    "joint without a value": ({}, f"size {SOLO12} --joint foo", EXIT_2, "'foo'.*NAME=VALUE|10deg"),
    "joint in degrees": ({}, f"size {SOLO12} --joint FL_HFE=45", EXIT_2, "FL_HFE.*|45deg"),
    "cells": ({}, f"size {SOLO12} --bus-voltage 6S", EXIT_2, "'6S'|6S is 22.2 V nominal, 25.2 V"),
    "millivolts": ({}, f"size {SOLO12} --bus-voltage 24000", EXIT_2, "above 1000 V|24000mV"),
    "inertia in kg mm2": (
        {},
        "size --mass 9.2 --inertia 107500,248400,258700",
        EXIT_3,
        "radius of gyration of 149 m|107500kgmm2",
    ),
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
        "no material 'stele'|Did you mean steel-",
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
        "s.toml, line 1: not UTF-8|Save the file as",
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
    "a motor's name misspelt": (
        {},
        f"{QUAD} --motor AS23O8",
        SPECIFICATION,
        "motor.name: .*'AS23O8'|Did you mean AS2308 KV1450 or AS2308 KV2600",
    ),
    "unknown gear": (
        {},
        f"{QUAD} --gear planet",
        SPECIFICATION,
        "motor.gear: there is no gear 'planet'|catalogue gears` lists all",
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
    "a voltage in ampere": (
        {},
        f"{QUAD} --bus-voltage 24A",
        EXIT_2,
        "--bus-voltage: .*24A.* a unit of current, not of voltage|Units of voltage: V, mV",
    ),
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
        "motor.gear: has no effect|supply.voltage: has no effect|ocs.co_design: needs a motor",
    ),
    "a motor whose figures are missing": (
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
    "no such catalogue": ({}, "catalogue bolts", EXIT_2, "no catalogue of bolts|materials"),
}
