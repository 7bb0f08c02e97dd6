"""Defaults and their reported assumptions, and faults that depend on the robot."""

import re
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest
from commands import SOLO12
from specifications import problems_of
from urdf_text import LIMIT, inertial, joint, link, robot

from ocs_design.common.errors import RobotError, SpecificationError, UsageError
from ocs_design.requirement.bound import spin_demands
from ocs_design.requirement.device_sections import MotorSection, SupplySection
from ocs_design.requirement.froude import WHEEL_SPEED_MAX, default_envelope
from ocs_design.requirement.reading import parse_specification, read_specification, specify
from ocs_design.requirement.resolving import default_specification, read_specified_robot, resolve
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification, specification_from_options
from ocs_design.robot.manual import person, robot_by_hand

EXAMPLES = Path(__file__).parents[2] / "examples"
SIZE = 0.45


def specified(text: str) -> Specification:
    return parse_specification(text, "x")


@pytest.mark.parametrize("words", [{}, {"fall": "1m"}, {"flip": "back"}])
def test_options_that_contradict_each_other_are_refused_as_in_a_file(solo12, words):
    keys = {f"requirement.{key}": value for key, value in words.items()}
    options = specification_from_options({"requirement.gravity": "orbit", **keys})
    key = next(iter(words), "maneuvers")
    problem, *_ = problems_of(options, solo12, SIZE)
    assert problem.startswith(f"requirement.{key}: nothing jumps or falls")


def check_assumptions(resolved, *words):
    text = "\n".join(resolved.assumptions)
    assert [each for each in words if each not in text] == []
    assert all(sentence.endswith(".") for sentence in resolved.assumptions)


def test_all_defaults_are_reported(solo12):
    resolved = resolve(Specification(), solo12, SIZE)
    assert resolved.envelope == default_envelope(solo12)
    check_assumptions(
        resolved,
        "the paper's three",
        "Supply: 24 V, at most 1 kW (400 W per kg of robot).",
        "Motor: chosen for the lightest device, of all that can be built with.",
        "Gear: none, because gear mountings are not designed.",
        "Incidence: alpha* = atan(Ixx/Iyy) of robot and device (equal-rate).",
        "Material: one of 5 steels.",
        "at least 2.",
        "95% of voltage, current and speed limit",
        "broken by 0.2 mm",
    )


def test_no_power_is_assumed_where_a_specified_current_is_the_tighter_limit(solo12):
    """24 V at 30 A are 720 W, less than 400 W per kg of 2.5 kg; at 100 A they are more."""
    for current, assumed in ((30.0, False), (100.0, True)):
        specification = Specification(supply=SupplySection(current_max=current))
        assumptions = resolve(specification, solo12, SIZE).assumptions
        (supply,) = (each for each in assumptions if each.startswith("Supply"))
        assert ("at most 1 kW" in supply) == assumed


def test_all_defaults_without_a_motor_are_reported(solo12):
    resolved = resolve(Specification(motor=MotorSection(name="none")), solo12, SIZE)
    assert (resolved.choice, resolved.torque_max) == (None, None)
    assert resolved.material.name == "stainless-304"
    requirement = resolved.requirement
    assert (requirement.wheel_speed_max, requirement.rate_change) == (WHEEL_SPEED_MAX, None)
    assert [item.name for item in requirement.maneuvers] == ["disturbance", "drop", "back-flip"]
    check_assumptions(
        resolved,
        "the paper's three",
        "falls from 1 m at roll 0 deg and pitch 30 deg",
        "7,200 rpm",
        "r_max 50, r_min 5, h_max 10, h_min 2, wall_min 2 mm",
        "at most 250 g, 10% of the robot's",
        "stainless-304, 7900 kg/m3",
    )


def test_what_is_specified_is_not_assumed(solo12):
    resolved = resolve(read_specification(EXAMPLES / "solo12.toml"), solo12, SIZE)
    assert resolved.envelope.outer_radius_max == 0.03
    assert resolved.requirement.spin_inertia == 7.11e-5
    text = "\n".join(resolved.assumptions)
    assert "rpm" not in text
    assert "r_max" not in text
    assert "h_min 2, wall_min 2 mm" in text
    assert "not checked, because the strength of stainless-paper is not known" in text


def test_the_papers_wheel_is_sufficient_at_the_speed_of_the_example(solo12):
    """The back-flip at alpha 0 spins 7.11e-5 kg m^2 up to 23,000 rpm (docs/validation.md)."""
    requirement = resolve(read_specification(EXAMPLES / "solo12.toml"), solo12, SIZE).requirement
    total = solo12.inertia + np.diag([1e-3, 2e-3, 2e-3])
    demands = spin_demands(requirement, lambda _: total, np.radians(40.0))
    assert max(demand.spin_inertia for demand in demands) < requirement.spin_inertia


def test_the_assumed_height_of_a_robot_without_legs_is_reported(make_robot):
    robot = make_robot(12.0, (0.19, 0.33, 0.42), None)
    resolved = resolve(read_specification(EXAMPLES / "by_hand.toml"), robot, 0.8)
    assert "No legs" in resolved.assumptions[0]
    assert resolved.torque_max == 4.0
    assert len(resolved.requirement.maneuvers) == 3


def test_the_assumed_trunk_of_a_robot_by_hand_is_reported():
    """A solid box of mass m with edges a, b, c has I_xx = m (b^2 + c^2) / 12, and so on."""

    def trunk_of(robot):
        assumptions = resolve(Specification(), robot, 0.8).assumptions
        return [each for each in assumptions if each.startswith("Trunk")]

    (trunk,) = trunk_of(robot_by_hand(12.0, (0.13, 0.37, 0.4)))
    assert "a solid box of 566 x 283 x 224 mm" in trunk
    assert "--position" in trunk
    assert trunk_of(person(75.0, 1.75)) == []


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("[flywheel]\nr_max = 30", "flywheel.r_max: 30 m is larger than the robot (0.45 m): "
         "did you mean 30mm?"),
        ("[flywheel]\nh_max = 10", "flywheel.h_max: 10 m is larger"),
        ("[flywheel]\nwheel_mass_max = 102", "did you mean 102g?"),
        ("[ocs]\nposition = [0, 100, 0]", "y = 100 m is off the robot"),
        ("[ocs]\nlayout = 'pyramid'\nposition = "
         "[0, 0.1, 0.1, 0, -0.1, 0.1, -0.1, 0, 0.1, 0.1, 80, 0.1]",
         "y = 80 m is off the robot (0.45 m): did you mean 80mm?"),
        ("[ocs]\nposition = [0, '-50mm', '80mm']", "y > 0"),
        ("[flywheel]\nr_max = '4mm'", "flywheel: r_max, 4 mm, leaves no room above r_min, "
         "5 mm (default: set it too)"),
        ("[flywheel]\nh_max = '1mm'", "h_max, 1 mm, is below h_min, 2 mm (default: set it too)"),
        ("[flywheel]\nr_min = '60mm'", "r_max, 50 mm (default: set it too), leaves no room"),
        ("[requirement]\nmaneuvers = 'none'", "nothing is required"),
        ("[flywheel]\nmaterial = 'stainless'", "flywheel.material: there is no material"),
        ("[[maneuver]]\nkind='drop'\nname='d'\nheight='10cm'\npitch=1",
         "there is no fall. Release it higher."),
    ],
)  # fmt: skip
def test_implausible_values_are_refused_with_a_suggestion(solo12, text, problem):
    assert any(problem in line for line in problems_of(specified(text), solo12, SIZE))


@pytest.mark.parametrize("key", ["rate_change = 2", "spin_inertia = 1e-4"])
@pytest.mark.parametrize(
    ("maneuvers", "names"),
    [
        ("", []),
        ("maneuvers = 'none'", []),
        ("maneuvers = 'paper'", ["disturbance", "drop", "back-flip"]),
    ],
)
def test_a_specified_requirement_replaces_the_default_maneuvers(solo12, key, maneuvers, names):
    resolved = resolve(specified(f"[requirement]\n{key}\n{maneuvers}"), solo12, SIZE)
    assert [item.name for item in resolved.requirement.maneuvers] == names
    assert ("the paper's three" in "\n".join(resolved.assumptions)) == bool(names)


DROP = "[[maneuver]]\nkind = 'drop'\nname = 'x'\nheight = 1"
FLIP = "[[maneuver]]\nkind = 'flip'\nname = 'x'\njump_height = 1\nduration = '0.4 s'"
IDLE = [
    {"kind": "drop", "name": "level", "height": 1.2, "pitch": 0},
    {"kind": "flip", "name": "hop", "jump_height": 1, "angle": 0, "duration": 0.4},
    {"kind": "shove", "name": "twist", "torque": [0, 0, 1], "duration": 0.1, "settling": 0.4},
    {
        "kind": "disturbance",
        "name": "calm",
        "takeoff_velocity": [0.5, 2.4],
        "torque": [0, 0, 0],
        "onset": 0.1,
        "duration": 0.05,
    },
]


@pytest.mark.parametrize("beside", [{}, {"tilt": "20deg"}])
def test_maneuvers_that_require_nothing_are_refused(solo12, beside):
    """Beside another maneuver they once ended in "needs a wheel of 0 kg m^2"."""
    problems = problems_of(specify(maneuver=IDLE, requirement=beside), solo12, SIZE)
    for name, keys in (
        ("level", "roll and pitch are 0"),
        ("hop", "angle is 0"),
        ("twist", "torque about roll and pitch is 0"),
        ("calm", "torque about roll and pitch is 0"),
    ):
        assert f"maneuver.{name}: {keys}, which requires nothing of the device" in problems


@pytest.mark.parametrize("others", [{}, {"tilt": "20deg"}])
@pytest.mark.parametrize(
    ("rates", "message"),
    [
        ("yaw 60deg/s", "cannot stop a yaw of 60 deg/s: leave yaw out"),
        ("pitch 30deg/s yaw -60deg/s", "cannot stop a yaw of -60 deg/s: leave yaw out"),
    ],
)
def test_a_yaw_that_the_wheels_cannot_stop_is_refused(solo12, others, rates, message):
    """A catch of yaw once passed with two wheels, as it does without a device."""
    words = {"catch": rates, **others}
    assert any(message in each for each in problems_of(specify(requirement=words), solo12, SIZE))
    for ocs in ({"layout": "orthogonal"}, {"axes": [1, 0, 1, 0, 1, 1, 1, 1, 0]}):
        resolve(specify(requirement=words, ocs=ocs), solo12, SIZE)


def test_a_flip_that_does_not_end_level_is_refused_with_a_turn_to_use(solo12):
    flip = specify(requirement={"flip": "90deg", "gravity": "moon"})
    (problem,) = problems_of(flip, solo12, SIZE)
    assert "after 90 deg the trunk is 90 deg off level, but a flip must land level" in problem
    turn = re.search(r"'(pitch 90deg in .*)'", problem).group(1)
    resolve(specify(requirement={"turn": turn, "gravity": "moon"}), solo12, SIZE)
    resolve(specify(requirement={"flip": "-720deg", "gravity": "moon"}), solo12, SIZE)


def test_idle_maneuvers_are_accepted_beside_a_rate_change(solo12):
    specification = specify(maneuver=IDLE, requirement={"rate_change": 2})
    assert len(resolve(specification, solo12, SIZE).requirement.maneuvers) == 4


@pytest.mark.parametrize(
    ("kind", "key", "raw", "message"),
    [
        (DROP, "pitch", "20", "20 rad is above 3.142 rad. Did you mean 20deg?"),
        (DROP, "pitch", "-20", "-20 rad is below -3.142 rad. Did you mean -20deg?"),
        (DROP, "pitch", "2", "2 without a unit is 2 rad. Did you mean 2deg?"),
        (DROP, "pitch", "'400deg'", "400deg is above 180 deg"),
        (DROP, "roll", "30", "Did you mean 30deg?"),
        (FLIP, "angle", "-360", "-360 rad is below -62.83 rad. Did you mean -360deg?"),
        (FLIP, "angle", "12", "12 without a unit is 12 rad. Did you mean 12deg?"),
        (FLIP, "angle", "'11 rev'", "11 rev is above 10 rev"),
        (FLIP, "incidence", "'400deg'", "400deg is above 90 deg"),
        ("[requirement]", "wheel_speed_max", "9000", "Did you mean 9000rpm?"),
        # Plausible values are accepted.
        (FLIP, "angle", "'-360deg'", ""),
        (FLIP, "angle", "-6.2832", ""),
        (FLIP, "angle", "'3 rev'", ""),
        ("[requirement]", "wheel_speed_max", "'9000rpm'", ""),
        ("[requirement]", "wheel_speed_max", "'12566rad/s'", ""),
    ],
)
def test_values_probably_meant_in_another_unit_are_refused(kind, key, raw, message):
    if not message:
        specified(f"{kind}\n{key} = {raw}")
        return
    with pytest.raises(SpecificationError) as caught:
        specified(f"{kind}\n{key} = {raw}")
    assert any(f".{key}: " in line and message in line for line in caught.value.problems)


LARGE_SIZE = 2.0
GAINS = {"kp": 60.0, "kd": 12.0}


def specified_defaults(robot):
    """Every default, specified; the paper's three by name would contradict their tables."""
    default = default_specification(robot, **GAINS)
    return replace(default, requirement=replace(default.requirement, maneuvers=None))


@pytest.fixture
def large(make_robot):
    """A robot of another mass, height and shape than Solo12, with another voltage."""
    return make_robot(50.0, (2.0, 5.0, 6.0), 0.5)


@pytest.mark.parametrize("robot", ["solo12", "large"])
def test_specifying_every_default_changes_nothing(robot, request):
    robot = request.getfixturevalue(robot)
    both = Specification(), specified_defaults(robot)
    assumed, explicit = (resolve(each, robot, LARGE_SIZE) for each in both)
    assert explicit.envelope == assumed.envelope
    assert asdict(explicit.requirement) == asdict(assumed.requirement)
    for name in ("motors", "gears", "materials", "supply", "wheel_speed_max"):
        assert getattr(explicit.choice, name) == getattr(assumed.choice, name)


def test_with_all_defaults_specified_only_the_reserve_is_assumed(solo12):
    text = " ".join(resolve(specified_defaults(solo12), solo12, LARGE_SIZE).assumptions)
    for words in ("Rim:", "Rim mass", "Supply:", "Web:", "Stress:", "paper's three"):
        assert words not in text
    assert "Reserve" in text


def test_default_maneuvers_scale_with_gravity(solo12):
    disturbance, drop, flip = default_specification(solo12, **GAINS, gravity=3.7).maneuvers
    assert disturbance.gravity == drop.gravity == 3.7
    np.testing.assert_allclose(disturbance.takeoff_velocity[1], 2.4 * np.sqrt(3.7 / 9.81))
    assert flip.gravity == 1.62


MASS_WARNING = "the parts' masses add up to 2.5"


def warnings_of(weighed, **options):
    specified = Specification(robot=RobotSection(file=SOLO12, weighed=weighed))
    return read_specified_robot(specified, **options).warnings


@pytest.mark.parametrize(
    ("weighed", "word"), [(2.7, "missing"), (2.53, ""), (2.47, ""), (2.2, "too heavy")]
)
def test_masses_that_do_not_add_up_are_reported(weighed, word):
    reported = [warning for warning in warnings_of(weighed) if warning.startswith(MASS_WARNING)]
    assert [word in each for each in reported] == [True] * bool(word)
    if word:
        with pytest.raises(RobotError, match=MASS_WARNING):
            warnings_of(weighed, strict=True)


RAIL = robot(
    link("trunk", inertial(2.0)),
    link("arm", inertial()),
    link("cart", inertial()),
    joint("hip", "trunk", "arm", LIMIT),
    joint("rail", "arm", "cart", LIMIT, kind="prismatic"),
)


@pytest.mark.parametrize(
    ("joint", "valid", "invalid"), [("hip", "10deg", "10mm"), ("rail", "10mm", "10deg")]
)
def test_hinges_take_angles_and_slides_take_lengths(joint, valid, invalid, tmp_path):
    (path := tmp_path / "robot.urdf").write_bytes(RAIL)

    def posture(value):
        options = {"robot.file": str(path), "robot.joints": [f"{joint}={value}"]}
        return read_specified_robot(specification_from_options(options), sure=False).posture[joint]

    assert posture(valid) > 0.0
    assert posture("0.5") == 0.5
    with pytest.raises(UsageError, match=f"'{joint}'"):
        posture(invalid)
