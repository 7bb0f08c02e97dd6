"""Catalogue files of users: both formats, and every kind of fault."""

import re
from importlib.resources import as_file, files

import pytest

from ocs_design.actuation.fasteners import BoltCircle
from ocs_design.actuation.motor import Face, Mounting, build_gaps
from ocs_design.catalogue.gears import gears, load_gears
from ocs_design.catalogue.motors import implausible_values, load_motors, motors
from ocs_design.common.errors import SpecificationError

HEADER = "name,maker,source,mass_kg,kt_nm_per_a,kt_convention,kv_rpm_per_v,resistance_ohm"
SHEET = {
    "name": "M",
    "maker": "me",
    "source": "bench",
    "mass_kg": 0.1,
    "kt_nm_per_a": 0.02,
    "kt_convention": "six-step",
    "resistance_ohm": 0.5,
    "resistance_between": "line-line",
    "rated_voltage_v": 24,
    "peak_torque_nm": 0.3,
}


MOUNTED = {
    "name": "M",
    "maker": "me",
    "source": "bench",
    "diameter_m": 0.05,
    "shaft_diameter_m": 0.005,
    "rotor_bolt_circle_m": 0.017,
    "rotor_bolts": 3,
    "rotor_thread": "M3",
    "stator_bolt_circle_m": 0.025,
    "stator_bolts": 4,
    "stator_thread": "M2.5",
    "stator_face": "output",
}
"""A motor of which only shaft and threads are given."""

MOUNTING = Mounting(0.005, BoltCircle(0.017, 3, "M3"), BoltCircle(0.025, 4, "M2.5"), Face.OUTPUT)


def toml(sheet=SHEET, **changes):
    """A TOML file of one motor; None leaves a column out."""
    given = {key: value for key, value in (sheet | changes).items() if value is not None}
    return "[[motor]]\n" + "\n".join(f"{key} = {value!r}" for key, value in given.items())


def csv(sheet=SHEET, **changes):
    given = {key: value for key, value in (sheet | changes).items() if value is not None}
    texts = (f'"{value}"' if "," in str(value) else str(value) for value in given.values())
    return f"{','.join(given)}\n{','.join(texts)}\n"


@pytest.mark.parametrize(("write", "suffix"), [(toml, ".toml"), (csv, ".csv")])
def test_both_formats_read_the_same(load, write, suffix):
    loaded = load(write(), suffix)["M"]
    assert (loaded.mass, loaded.torque_constant, loaded.resistance) == (0.1, 0.02, 0.5)
    assert (loaded.rotor_inertia, loaded.speed_max) == (None, None)
    assert load(write(MOUNTED), suffix)["M"].mounting == MOUNTING


def test_each_part_of_a_mounting_is_optional(load):
    without_mounting = dict.fromkeys(
        key for key in MOUNTED if key.startswith(("shaft", "rotor", "stator"))
    )
    assert load(toml(MOUNTED | without_mounting))["M"].mounting is None
    shaft_alone = without_mounting | {"shaft_diameter_m": 0.005}
    assert load(toml(MOUNTED | shaft_alone))["M"].mounting == Mounting(0.005)


def test_byte_order_marks_and_line_ends_do_not_matter(load):
    text = csv(source="bench, hall 3").replace("\n", "\r\n").encode("utf-8-sig")
    assert load(text, ".csv")["M"].source == "bench, hall 3"


def test_empty_lines_and_cells_are_ignored(load):
    text = "name,maker,source,mass_kg\n\n M , me ,bench,\n,,,\n"
    assert load(text, ".csv")["M"].mass is None


def test_a_file_without_motors_is_an_empty_catalogue(load):
    assert load("") == {}
    assert load("name,maker,source\n", ".csv") == {}


def test_a_users_motor_replaces_that_of_the_catalogue(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(toml() + "\n" + toml(name="R80 KV110", mass_kg=0.3))
    known = motors(path)
    assert len(known) == len(motors()) + 1
    assert known["R80 KV110"].mass == 0.3
    assert list(known) == sorted(known)
    assert motors() is motors()


FAULTS = {
    "column without its unit": (toml(kv=400.0), r"motor\[1\] \(M\), kv: .*mean kv_rpm_per_v"),
    "unknown column": (toml(mas_kg=1.0), r"motor\[1\] \(M\), mas_kg: unknown .*mean mass_kg"),
    "no number": (toml(mass_kg="heavy"), "mass_kg: 'heavy' is not a number"),
    "negative": (toml(mass_kg=-1.0), "mass_kg: -1.0 is not positive"),
    "zero": (toml(mass_kg=0), "mass_kg: 0 is not positive"),
    "infinite": (toml().replace("0.1", "inf"), "mass_kg: inf is not positive and finite"),
    "not a number": (csv(mass_kg="nan"), "mass_kg: 'nan' is not positive and finite"),
    "a boolean": (toml().replace("0.1", "true"), "mass_kg: True is not a number"),
    "a list": (toml(mass_kg=[1]), r"mass_kg: \[1\] is not a number"),
    "a huge number": (toml().replace("0.1", "1" + 400 * "0"), "mass_kg: 1.* is not a number"),
    "no text": (toml(maker=7), "maker: 7 is not text"),
    "no source": (toml(source=None), "source: is missing"),
    "an empty source": (toml(source=""), "source: is missing"),
    "no name": (csv(name=None), "line 2, name: is missing"),
    "no convention": (toml(kt_convention=None), "needs its kt_convention: one of six-step, foc"),
    "a wrong convention": (toml(kt_convention="dq"), "'dq' is not one of six-step, foc"),
    "no terminals": (toml(resistance_between=None), "needs its resistance_between"),
    "k_t of another convention": (toml(kv_rpm_per_v=413.5), "not six-step; it fits foc; explain"),
    "k_t of no convention": (toml(kv_rpm_per_v=300), "k_t Kv is 6.00 .* it fits no convention"),
    "no-load speed": (toml(no_load_speed_rpm=9000), "9,000 rpm, but V, R and k_t make it 11,459"),
    "stall torque": (toml(stall_torque_nm=2.0), "stall torque is 2 N m, but V k_t / R is 0.96"),
    "stall current": (toml(stall_current_a=20), "stall current is 20 A, but V / R is 48 A"),
    "peak torque": (toml(peak_current_a=10), "peak torque is 0.3 N m, above k_t times"),
    "continuous torque": (toml(continuous_torque_nm=0.4), "continuous torque is above"),
    "grams": (
        toml(mass_kg=120, diameter_m=0.0556, length_m=0.025),
        r"mass_kg is 120 kg in a body of 55.6 x 25 mm, 1977 g/cm3, .*: did you mean 0.12 kg\?",
    ),
    "tonnes": (
        csv(mass_kg=1e-4, diameter_m=0.0556, length_m=0.025),
        r"mass_kg is 0.0001 kg .*: did you mean 0.1 kg\?",
    ),
    "millimetres": (toml(diameter_m=55.6), r"diameter_m is 55.6 m, .*: did you mean 0.0556 m\?"),
    "a long shaft": (toml(shaft_length_m=5), r"shaft_length_m is 5 m, .*: did you mean 0.005 m\?"),
    "twice in a file": (toml() + "\n" + toml(), r"motor\[2\]: 'M' is already .* of motor\[1\]"),
    "too many cells": (csv() + "a,b,c,d,e,f,g,h,i,j,k\n", "line 3: has 11 cells for 10"),
    "a column twice": ("name,name\na,b\n", "the column 'name' occurs twice"),
    "an unknown table": (toml() + "\n[gear]\n", "gear: unknown key; known: motor"),
    "no array": ("[motor]\nname = 'M'\n", r"give each motor as a \[\[motor\]\] table"),
    "an array of numbers": ("motor = [1]", r"motor\[1\]: must be a table"),
}


@pytest.mark.parametrize(("text", "message"), FAULTS.values(), ids=FAULTS)
def test_faults_are_reported_with_their_place(load, text, message):
    suffix = ".csv" if "," in text.splitlines()[0] else ".toml"
    with pytest.raises(SpecificationError) as caught:
        load(text, suffix)
    assert "mine" in caught.value.message
    assert matches(message, caught.value), caught.value.problems


def matches(message, error):
    return any(re.search(message, problem) for problem in error.problems)


UNMOUNTABLE = {
    "no thread": ({"rotor_thread": None}, "rotor_bolt_circle_m, .* or none: rotor_thread missing"),
    "only a number": (
        {"stator_bolt_circle_m": None, "stator_thread": None, "stator_face": None},
        "or none: stator_bolt_circle_m, stator_thread missing",
    ),
    "two bolts": ({"rotor_bolts": 2}, "rotor_bolts is 2; it must be 3 or more"),
    "one bolt": ({"stator_bolts": 1}, "stator_bolts is 1; it must be 2 or more"),
    "half a bolt": ({"rotor_bolts": 3.5}, "rotor_bolts: 3.5 is not a whole number"),
    "no bolts": ({"rotor_bolts": 0}, "rotor_bolts: 0 is not positive"),
    "no class": ({"rotor_screws": "9.9"}, "rotor_screws is '9.9', which is not one of 8.8, 10.9"),
    "half a depth": ({"rotor_depth_m": 0.01}, "give rotor_depth_m and rotor_depth_max_m together"),
    "depth of nothing": (
        {
            "stator_bolt_circle_m": None,
            "stator_bolts": None,
            "stator_thread": None,
            "stator_face": None,
            "stator_depth_m": 0.01,
            "stator_depth_max_m": 0.02,
        },
        "together, and only with stator_bolt_circle_m",
    ),
    "depths": ({"rotor_depth_m": 0.02, "rotor_depth_max_m": 0.01}, "0.02, above rotor_depth_max_m"),
    "inch thread": (
        {"rotor_thread": "4-40"},
        "rotor_thread is '4-40', which is not one of M2, M2.5",
    ),
    "wide circle": ({"rotor_bolt_circle_m": 0.05}, "0.05, but the motor is only 0.05 m wide"),
    "thick shaft": ({"shaft_diameter_m": 0.06}, "shaft_diameter_m is 0.06, but the motor is only"),
    "shaft between": ({"shaft_diameter_m": 0.0117}, "leave less than 1 mm to the shaft"),
    "many bolts": ({"rotor_bolts": 13}, "13 holes for M3 leave less than 1 mm between them"),
    "no face": ({"stator_face": None}, "stator_face and the stator's bolt circle"),
    "wrong face": ({"stator_face": "front"}, "'front' is not one of output, back"),
}


@pytest.mark.parametrize(("changes", "message"), UNMOUNTABLE.values(), ids=UNMOUNTABLE)
def test_an_impossible_mounting_is_refused_also_with_a_remark(load, changes, message):
    with pytest.raises(SpecificationError, match=message) as caught:
        load(toml(MOUNTED | changes, remark="so it is"))
    assert "(M)" in str(caught.value)


def test_limits_of_possible_mountings_are_accepted(load):
    """Holes of 3.4 mm on 17 mm leave 1 mm to a shaft of 11.6 mm, and between 11 screws."""
    changes = {"shaft_diameter_m": 0.0116 - 1e-9, "rotor_bolts": 11}
    edge = load(toml(MOUNTED | changes))["M"].mounting
    assert edge.rotor.inside - edge.shaft_diameter / 2.0 == pytest.approx(1e-3, abs=1e-9)
    assert 1e-3 < edge.rotor.spacing < 1.4e-3


UNREADABLE = {
    "neither": (b"", ".txt", "neither .csv nor .toml"),
    "no UTF-8": (b"name,maker\nM,\xff\n", ".csv", "line 2: not UTF-8"),
    "UTF-16": ("name,maker\n".encode("utf-16"), ".csv", "line 1: not UTF-8"),
    "no TOML": (b"[[motor]\n", ".toml", "is not TOML"),
    "no column names": (b"\n", ".csv", "has no column names"),
    "semicolons": (b"name;maker\nM;me\n", ".csv", "line 1: semicolons separate the columns"),
    "tabs": (b"name\tmaker\nM\tme\n", ".csv", "line 1: tabs separate the columns"),
    "an open quote": (b'name,maker\n"M,me\n', ".csv", "is not CSV"),
    "a long line": (b"a" * 6000, ".toml", "line 1: over 5000 characters"),
    "large": (b"#\n" * 600_000, ".toml", "larger than 1 MiB"),
    "deep": (b"a = " + b"[" * 4000, ".toml", "nests its values too deeply|is not TOML"),
}


@pytest.mark.parametrize(("content", "suffix", "message"), UNREADABLE.values(), ids=UNREADABLE)
def test_an_unreadable_file_is_an_error(load, content, suffix, message):
    with pytest.raises(SpecificationError, match=message):
        load(content, suffix)


def test_a_missing_file_is_an_error(tmp_path):
    with pytest.raises(SpecificationError, match="No such file"):
        load_motors(tmp_path / "none.csv")
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(SpecificationError, match="cannot read the catalogue"):
        load_motors(tmp_path / "folder.csv")


def test_all_faults_are_reported_at_once(load):
    text = f"{HEADER}\nA,me,,x,0.02,,,1\nB,me,bench,-1,,,,\n"
    with pytest.raises(SpecificationError) as caught:
        load(text, ".csv")
    places = [problem.split(":")[0] for problem in caught.value.problems]
    assert places == [
        "line 2 (A), mass_kg",
        "line 2 (A), source",
        "line 3 (B), mass_kg",
        # Figures needed only for building are reported at the same time.
        "line 2 (A)",
        "line 3 (B)",
    ]
    assert "it lacks kind (outrunner or inrunner), bolt circle" in caught.value.problems[-1]


@pytest.mark.parametrize("column", ["mass_kg", "resistance_ohm", "kt_nm_per_a"])
@pytest.mark.parametrize("value", [-0.1, 0, "much"])
def test_a_wrong_figure_is_not_reported_as_missing_too(load, column, value):
    correct = load(toml())["M"]
    with pytest.raises(SpecificationError) as caught:
        load(toml(**{column: value}))
    wrong, gaps = caught.value.problems
    assert wrong.startswith(f"motor[1] (M), {column}: ")
    assert gaps == f"motor[1] (M): to build with it, it lacks {', '.join(build_gaps(correct))}"


IMPLAUSIBLE = {
    "hardly any mass": (
        {"mass_kg": 0.025, "diameter_m": 0.0556, "length_m": 0.025},
        r"mass_kg is 0.025 kg .* 0.4119 g/cm3, where motors have 1.3 to 7: check its unit",
    ),
    "milliohm": (
        {"resistance_ohm": 60, "peak_current_a": 26},
        r"resistance_ohm is 60 ohm, which takes 1560 V for peak_current_a, 26 A, and "
        r"rated_voltage_v is 24 V: did you mean 0.06 ohm\?",
    ),
    "thousands of rpm": (
        {"kt_nm_per_a": None, "kt_convention": None, "kv_rpm_per_v": 450_000},
        r"kv_rpm_per_v is 450000 rpm/V, where .* 25 to 2800 rpm/V: did you mean 450 rpm/V\?",
    ),
    "mN m": (
        {"kt_nm_per_a": 20.0},
        r"kt_nm_per_a is 20 N m/A, where .*: did you mean 0.02 N m/A\?",
    ),
    "grams, and no size": (
        {"mass_kg": 120.0, "peak_torque_nm": 1.0},
        r"mass_kg is 120 kg for 1 N m, where motors weigh 0.098 to 0.42 kg: did you mean 0.12 kg",
    ),
    "a ton for a newton metre": (
        {"mass_kg": 3000.0, "peak_torque_nm": 1.0},
        r"mass_kg is 3000 kg for 1 N m, .* 0.42 kg: check its unit",
    ),
    "half a metre of shaft": (
        {
            "mass_kg": 0.106,
            "diameter_m": 0.0556,
            "length_m": 0.025,
            "shaft_diameter_m": 0.004,
            "shaft_length_m": 0.5,
        },
        r"shaft_length_m is 0.5 m, 20 times its motor's body, .* less than 3 times that: check its",
    ),
}


@pytest.mark.parametrize(("changes", "message"), IMPLAUSIBLE.values(), ids=IMPLAUSIBLE)
def test_implausible_figures_raise_a_warning(load, changes, message):
    (warning,) = load(toml(**changes), read=implausible_values)
    assert re.search(f"mine.toml, M: {message}", warning), warning
    # The file is read nevertheless.
    assert "M" in load(toml(**changes))


def test_the_catalogue_raises_no_warning():
    with as_file(files("ocs_design.catalogue") / "motors.csv") as path:
        assert implausible_values(path) == ()


def test_a_remark_permits_a_contradiction(load):
    assert load(toml(stall_torque_nm=2.0, remark="measured on the bench"))["M"].remark


def test_the_line_of_a_row_counts_its_quoted_line_ends(load):
    text = 'name,maker,source\nA,me,"two\nlines"\nB,me,\n'
    with pytest.raises(SpecificationError) as caught:
        load(text, ".csv")
    assert caught.value.problems[0] == "line 4 (B), source: is missing"


GEAR = "[[gear]]\nname = 'G'\nmaker = 'me'\nsource = 'bench'\nkind = 'fixed'\n"


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("efficiency = 1.2", "efficiency: 1.2 is not above 0 and at most 1"),
        ("reverses = 'perhaps'", "reverses: 'perhaps' is neither yes nor no"),
        ("ratios = [2, -3]", "ratios: -3 is not positive"),
        ("teeth = [20.5]", "teeth: .* not a whole number"),
        ("inertia_at = 'planet'", "inertia_at: 'planet' is not one of motor, wheel"),
    ],
)
def test_faults_of_gears(load, line, message):
    with pytest.raises(SpecificationError) as caught:
        load(GEAR + line, read=load_gears)
    assert matches(message, caught.value)


def test_a_users_gear_joins_the_catalogue(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(GEAR)
    assert gears(path)["G"].missing
