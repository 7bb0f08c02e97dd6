"""Reading of specification files and options, valid and invalid."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ocs_design.common.errors import OcsError, QuantityError, SpecificationError, UsageError
from ocs_design.common.units import Dimension
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.reading import parse_specification, read_specification
from ocs_design.requirement.specification import specification_from_options
from ocs_design.requirement.values import Quantities
from ocs_design.requirement.writing import specification_to_toml

EXAMPLES = Path(__file__).parents[2] / "examples"

DROP = "[[maneuver]]\nkind = 'drop'\nname = 'fall'\nheight = '1m'\npitch = '30deg'\n"
PUSH = (
    "[[maneuver]]\nkind='disturbance'\nname='push'\ntakeoff_velocity=[0, 2.4]\n"
    "torque=[0, 1, 0]\nonset=0.1\nduration=0.05\n"
)
FLIP = "[[maneuver]]\nkind='flip'\nname='f'\njump_height=1\nangle='1rev'\nduration=0.9\n"
TURN = "[[maneuver]]\nkind='turn'\nname='t'\nyaw='90deg'\nduration=0.9\n"


def test_file_and_options_give_the_same_specification():
    specification = parse_specification(
        """
        [robot]
        joints = { hip = "10deg", slide = "5mm", knee = -1.6 }
        mass = "2500g"
        inertia = ["300 kg cm^2", 0.05, 0.07]
        [requirement]
        rate_change = 2
        wheel_speed_max = "7200rpm"
        maneuvers = "none"
        jump_height = ["0.4 m", 0.5]
        kick = "3 N s at 0.1,0,0.2"
        tilt = ["20deg", "10deg roll"]
        flip = "back"
        gravity = "mars"
        [ocs]
        position = ["-5cm", "100mm", 0]
        [flywheel]
        r_max = "30mm"
        stress_safety = 1.5
        [validation]
        enabled = false
        seed = 7
        """,
        "x",
    )
    options = {
        "robot.joints": ["hip=10deg", "slide=5mm", "knee=-1.6"],
        "robot.mass": "2.5kg",
        "robot.inertia": "0.03, 0.05, 0.07",
        "requirement.rate_change": "2",
        "requirement.wheel_speed_max": "7200 rpm",
        "requirement.maneuvers": "none",
        "requirement.jump_height": ["0.4m", "0.5m"],
        "requirement.kick": ["3 N s at 0.1,0,0.2"],
        "requirement.tilt": ["20deg", "10deg roll"],
        "requirement.flip": ["-360deg"],
        "requirement.gravity": "Mars",
        "ocs.position": "-0.05,0.1,0",
        "flywheel.r_max": "0.03",
        "flywheel.h_max": None,
        "flywheel.stress_safety": "1.5",
        "validation.enabled": False,
        "validation.seed": "7",
    }
    assert specification_from_options(options) == specification
    assert parse_specification(specification_to_toml(specification), "again") == specification
    robot, flywheel = specification.robot, specification.flywheel
    assert robot.joints == {"hip": pytest.approx(np.radians(10.0)), "slide": 0.005, "knee": -1.6}
    assert (robot.mass, robot.inertia) == (2.5, (0.03, 0.05, 0.07))
    assert specification.ocs.position == (-0.05, 0.1, 0.0)
    assert (flywheel.r_max, flywheel.h_max, flywheel.stress_safety) == (0.03, None, 1.5)
    assert (specification.validation.enabled, specification.validation.seed) == (False, 7)
    assert not specification.takes_default_maneuvers


def test_maneuvers_take_their_defaults_and_the_files_gravity():
    text = f"[requirement]\ngravity = 3.71\n{DROP}{FLIP}gravity = 'moon'\n"
    drop, flip = parse_specification(text, "x").maneuvers
    assert (drop.gravity, drop.roll, drop.incidence) == (3.71, 0.0, None)
    assert flip.gravity == 1.62
    assert parse_specification(DROP, "x").maneuvers[0].gravity == 9.81


FAULTS = {
    "": {"fly = 1": ("fly: ", "unknown key")},
    "[flywheel]": {
        'rmax = "30mm"': ("flywheel.rmax: ", "Did you mean 'r_max'?"),
        'r_min = "30furlong"': ("flywheel.r_min: ", "unknown unit 'furlong'"),
        'h_max = "24V"': ("flywheel.h_max: ", "voltage"),
        'wall_min = "-2mm"': ("flywheel.wall_min: ", "must be positive"),
        "wheel_mass_max = true": ("flywheel.wheel_mass_max: ", "not a number"),
        "material = 304": ("flywheel.material: ", "not a text"),
    },
    "[ocs]": {
        "alpha = 40": ("ocs.alpha: ", "Did you mean 40deg?"),
        'alpha_criterion = "simultanous"': ("ocs.alpha_criterion: ", "mean 'simultaneous'?"),
        "position = [0, 1]": ("ocs.position: ", "needs 3, 6, ... or 18"),
    },
    "[validation]": {
        'enabled = "yes"': ("validation.enabled: ", "neither true nor false"),
        "seed = -1": ("validation.seed: ", "whole number"),
    },
    "[robot]": {"joints = 3": ("robot.joints: ", "table")},
    "[[maneuver]]\nkind = 'drop'\nname = 'fall'\npitch = '30deg'": {
        "heigth = 1": ("maneuver.fall.heigth: ", "Did you mean 'height'?"),
        "": ("maneuver.fall.height: ", "missing"),
    },
    "[[maneuver]]": {
        "kind = 'leap'": (
            "maneuver[1].kind: ",
            "'leap' is unknown; one of disturbance, shove, drop, flip",
        )
    },
    "[[maneuver]]\nname = 'nothing'": {"": ("maneuver.nothing.kind: ", "missing")},
}


def test_all_faults_are_reported_together_with_their_keys():
    text = "\n".join("\n".join((heading, *lines)) for heading, lines in FAULTS.items())
    with pytest.raises(SpecificationError) as caught:
        parse_specification(text, "my.toml")
    expected = [fault for lines in FAULTS.values() for fault in lines.values()]
    problems = caught.value.problems
    for start, word in expected:
        assert [line for line in problems if line.startswith(start) and word in line], (start, word)
    assert len(problems) == len(expected)
    assert str(caught.value).startswith("my.toml has 17 faults:\n  ")
    assert caught.value.exit_code == 3


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("[flywheel]\nr_min='30mm'\nr_max='20mm'", "leaves no room above r_min, 30 mm"),
        ("[flywheel]\nr_min='30mm'\nr_max='30mm'", "leaves no room above r_min, 30 mm"),
        ("[flywheel]\nh_min='3mm'\nh_max='2mm'", "flywheel: h_max, 2 mm, is below h_min, 3 mm"),
        ("[robot]\nmass = 3", "give both mass and inertia"),
        ("[robot]\nfile='a'\nmass=3\ninertia=[1,1,1]", "not both"),
        (f"[requirement]\nmaneuvers='none'\n{DROP}", "contradicts"),
        ("[requirement]\ngravity='orbit'", "requirement.maneuvers: nothing jumps or falls"),
        ("[requirement]\ngravity='orbit'\nfall='1m'", "requirement.fall: nothing jumps or falls"),
        ("[requirement]\ngravity='orbit'\nturn='yaw 90deg'", "needs a time"),
        (f"[requirement]\ngravity='orbit'\n{DROP}", "nothing falls in orbit"),
        (TURN, "jump_height: is missing"),
        (f"[requirement]\ngravity=0\n{TURN}jump_height=1", "there is no jump in orbit"),
        (DROP + DROP, "two are named 'fall'"),
        (
            DROP.replace("fall", "fall 1") + DROP.replace("fall", "Fall_1"),
            "'fall 1', 'Fall_1' would write the same files",
        ),
        (DROP.replace("fall", "跳") + DROP.replace("fall", "翻"), "would write the same files"),
        (FLIP.replace("duration=0.9", "duration='1.1s'"), "its turn ends 1.1 s .* lasts 0.903 s"),
        (PUSH.replace("2.4", "0.4"), "torque ends 0.15 s .* lasts 0.0815 s"),
        (PUSH.replace("0.05", "0.4"), "torque ends 0.5 s .* lasts 0.489 s"),
        (PUSH.replace("2.4", "-2.4"), "lasts 0 s"),
        ("[robot]\nfile = 'a\\u0000b'".replace("'", '"'), "not a text"),
        ("maneuver = 3", r"\[\[maneuver\]\]"),
        ("maneuver = [3]", r"maneuver\[0\]: must be a table"),
        ("flywheel = 3", "flywheel: must be a table"),
        ("[requirement]\nrate_change = nan", "not finite"),
        ("[requirement]\nreliability = 1", "at least 0.5 and below 1"),
        ("[requirement]\nreliability = '49%'", "at least 0.5 and below 1"),
        ("[robot]\nfile = ' '", "not a text"),
        ("[validation]\nkp = 1979-05-27", "not a number"),
        ("[validation]\ncontrol_period = '2.5ms'", "control_period: 2.5 ms is not a whole number"),
        ("[validation]\ncontrol_period = 5.0004e-3", "control_period: 5.0004 ms is not a whole"),
        ("[ocs]\nalpha_criterion = ['equal-rate']", "is not one of"),
        ("[requirement]\nsurvives = 'any'", "'any' is not one of 'one', 'any one motor', 'none'"),
        ("[[maneuver]]\nkind = ['drop']", "unknown"),
        ("[[maneuver]]\nname = " + "[\n" * 300 + "]" * 300, r"maneuver\[0\].kind: is missing"),
        ("[flywheel]\n" + "r_max." * 100 + "a = 1", "flywheel.r_max: {'r_max': .* is not a number"),
    ],
)
def test_single_faults(text, problem):
    with pytest.raises(SpecificationError, match=problem) as caught:
        parse_specification(text, "x")
    assert caught.value.problems


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"[flywheel]\nr_max = 30mm\n", "line 2"),
        (b"a = 1\na = 2\n", "line 2"),
        (b"x = 1\n# caf\xe9\n", "line 2: not UTF-8"),
        (b"a = " + b"[\n" * 20_000, "deep"),
        (b"\na = " + b"9" * 5000, "line 2: over 1000 characters"),
        (b"#\n" * (1 << 15) + b"#", "64 KiB"),
        (b"\xff\xfe[\x00", "not UTF-8"),
        (b"\x00", "not TOML"),
    ],
)
def test_invalid_files_are_refused(tmp_path, content, message):
    path = tmp_path / "x.toml"
    path.write_bytes(content)
    with pytest.raises(SpecificationError, match=message) as caught:
        read_specification(path)
    assert "x.toml" in str(caught.value)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(SpecificationError, match="No such file"):
        read_specification(tmp_path / "none.toml")
    with pytest.raises(SpecificationError, match="directory"):
        read_specification(tmp_path)


def test_a_byte_order_mark_is_accepted(tmp_path):
    path = tmp_path / "x.toml"
    path.write_bytes(b"\xef\xbb\xbf[flywheel]\nr_max = '30mm'\n")
    assert read_specification(path).flywheel.r_max == 0.03


def test_the_robots_path_is_relative_to_the_file(tmp_path):
    path = tmp_path / "x.toml"
    path.write_text("[robot]\nfile = 'sub/robot.urdf'\n")
    assert read_specification(path).robot.file == str(tmp_path / "sub" / "robot.urdf")
    path.write_text("[robot]\nfile = '-'\n")
    assert read_specification(path).robot.file == "-"
    path.write_text("[robot]\nfile = '/a/robot.urdf'\n")
    assert read_specification(path).robot.file == "/a/robot.urdf"


@given(text=st.text(alphabet="[]=\"'{}.,#\n abr_max0123-", max_size=120))
def test_random_text_raises_only_specification_errors(text):
    try:
        parse_specification(text, "x")
    except OcsError as error:
        assert isinstance(error, SpecificationError)


def test_faults_of_options_are_named_as_typed():
    with pytest.raises(UsageError) as caught:
        specification_from_options(
            {"flywheel.r_max": "30V", "robot.joints": ["hip=x"], "ocs.alpha": "40"}
        )
    lines = str(caught.value).splitlines()
    assert [line.split(":")[0] for line in lines] == ["--r-max", "--joint.hip", "--alpha"]
    assert "Did you mean 40deg?" in lines[2]
    assert caught.value.exit_code == 2
    with pytest.raises(UsageError, match="--joint: 'hip' is not NAME=VALUE"):
        specification_from_options({"robot.joints": ["hip"]})


def test_the_example_of_solo12_is_the_paper_with_modules_turned_by_hand(solo12):
    specification = read_specification(EXAMPLES / "solo12.toml")
    assert Path(specification.robot.file).name == "solo12.urdf"
    assert specification.requirement.spin_inertia == 7.11e-5
    assert (specification.flywheel.r_max, specification.flywheel.h_max) == (0.03, 0.01)
    assert specification.ocs.alpha == pytest.approx(np.radians(40.0))
    maneuvers = specification.maneuvers
    assert [maneuver.incidence for maneuver in maneuvers] == [None, None, 0.0]
    for one, other in zip(maneuvers, default_maneuvers(solo12), strict=True):
        assert type(one) is type(other)
        assert {**vars(one), "incidence": None} == vars(other)


def test_the_bus_voltage_of_older_files_is_that_of_the_supply():
    old = parse_specification('motor.bus_voltage = "22.2 V"', "old.toml")
    assert old.supply.voltage == 22.2
    both = 'motor.bus_voltage = "22.2 V"\nsupply.voltage = "24 V"\nmotor.gear = "direct"'
    assert parse_specification(both, "both.toml").supply.voltage == 24.0
    assert parse_specification(both, "both.toml").motor.gear == "direct"


def test_controllers_are_a_word_or_a_mass():
    for text, value in (('"none"', "none"), ('"Auto"', "auto"), ('"35 g"', 0.035)):
        read = parse_specification(f"supply.controllers = {text}", "s.toml").supply.controllers
        assert read == value
    for text, message in (
        ("nome", "'nome' is neither a number nor one of auto, none. Did you mean 'none'?"),
        ("35 V", "'35 V' has a unit of voltage, not of mass"),
        ("", "is empty"),
    ):
        with pytest.raises(SpecificationError) as caught:
            parse_specification(f'supply.controllers = "{text}"', "s.toml")
        assert f"supply.controllers: {message}" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "cure"),
    [("0,90,45deg/s", "0deg/s,90deg/s,45deg/s"), ("0,800,0mN m", "0mN m,800mN m,0mN m")],
)
def test_a_single_unit_at_the_end_of_a_row_is_ambiguous(text, cure):
    dimension = Dimension.TORQUE if "N" in text else Dimension.ANGULAR_SPEED
    row = Quantities(dimension, (3,))
    with pytest.raises(QuantityError, match="only the last value") as caught:
        row.read(text, "x")
    assert row.read(cure, "x")[1] > 0.0
    assert cure in str(caught.value.hint)
    assert row.read([*text.split(",")[:2], "1"], "x")[2] == 1.0


@pytest.mark.parametrize("unit", ["", "kg m2", " kg*m^2"])
def test_a_single_si_unit_at_the_end_of_a_row_is_accepted(unit):
    row = Quantities(Dimension.INERTIA, (3,))
    assert row.read(f"0.03,0.05,0.07{unit}", "x") == (0.03, 0.05, 0.07)
