"""Maneuvers in words: reading, resulting maneuvers, and a kick against MuJoCo."""

import re
from dataclasses import replace
from math import pi, radians
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from specifications import problems_of
from wheels import braked_inertia, paper_device

from ocs_design.common.errors import OcsError, SpecificationError
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.phrases import (
    CATCH_TEXT,
    FLIP,
    TURN_TEXT,
    About,
    Kick,
    Person,
    Tilt,
    kick_text,
    person_text,
    tilt_text,
)
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.reading import parse_specification
from ocs_design.requirement.resolving import resolve
from ocs_design.requirement.sections import RequirementSection
from ocs_design.requirement.specification import Specification, merge, specification_from_options
from ocs_design.requirement.sweep import SWEEPS, Task
from ocs_design.requirement.values import GRAVITY
from ocs_design.requirement.worded_maneuvers import worded_maneuvers
from ocs_design.robot.reader import read_robot

SIZE = 0.45


@pytest.fixture(scope="module")
def real():
    """Solo12 from its file: its centre of mass is not at the trunk's frame."""
    return read_robot(Path(__file__).parents[2] / "examples" / "solo12.urdf")


def section_of(**words):
    """Requirement section from options of the command line."""
    options = {f"requirement.{key}": value for key, value in words.items()}
    return specification_from_options(options).requirement


def maneuvers(robot, **words):
    """Maneuvers of a robot from these words."""
    return worded_maneuvers(section_of(**words), robot).maneuvers


def tilt(roll, pitch):
    return Tilt(pytest.approx(radians(roll)), pytest.approx(radians(pitch)))


@pytest.mark.parametrize(
    ("reader", "text", "value"),
    [
        (kick_text, "12 N s at 0.1,0,0.2", Kick(12.0, (0.1, 0.0, 0.2))),
        (
            kick_text,
            "12Ns at 100mm, 0, 20cm along 0,1,0",
            Kick(12.0, (0.1, 0.0, 0.2), (0.0, 1.0, 0.0)),
        ),
        (kick_text, "500 mN s at FL_hip along Left", Kick(0.5, "FL_hip", (0.0, 1.0, 0.0))),
        (kick_text, "3 at base_link along 0,-1,-1", Kick(3.0, "base_link", (0.0, -1.0, -1.0))),
        (kick_text, "3 N s at 0.1 0 -0.2", Kick(3.0, (0.1, 0.0, -0.2))),
        (kick_text, "3 N s at 0.1,0,0.2 from left", Kick(3.0, (0.1, 0.0, 0.2), (0.0, -1.0, 0.0))),
        (kick_text, "3 N s at FL_hip from the Front", Kick(3.0, "FL_hip", (-1.0, 0.0, 0.0))),
        (tilt_text, "20deg", tilt(0, 20)),
        (tilt_text, "20 deg roll", tilt(20, 0)),
        (tilt_text, "10deg roll -20deg pitch", tilt(10, -20)),
        (tilt_text, "20deg left", tilt(-20, 0)),
        (tilt_text, "10 deg right 5deg backward", tilt(10, -5)),
        # The axis before or after its angle.
        (TURN_TEXT, "yaw 90deg in 2.9s", About(0.0, 0.0, pi / 2.0, 2.9, "rad")),
        (TURN_TEXT, "90 deg yaw in 2900 ms", About(0.0, 0.0, pi / 2.0, 2.9, "rad")),
        (TURN_TEXT, "-20deg Roll 1.5 pitch", About(-pi / 9.0, 1.5, 0.0, None, "rad")),
        (person_text, "75kg 1.75m", Person(75.0, 1.75)),
        (person_text, "75 kg, 175 cm", Person(75.0, 1.75)),
        (person_text, "75kg 1.75m with 10kg", Person(75.0, 1.75, 10.0)),
    ],
)
def test_words_are_read_and_written(reader, text, value):
    read = reader.read(text, "key")
    assert read == value
    assert reader.read(str(read), "key") == read


@pytest.mark.parametrize(
    ("reader", "text", "message"),
    [
        (kick_text, "12", "must give an impulse and where.*'12 N s at FL_hip'"),
        (kick_text, "12 N s", "must give an impulse and where"),
        (kick_text, "12 N at 0.1,0,0.2", "force times time.*N s"),
        (kick_text, "12 N s at 0.1,0,0.2 from outside", "not a side.*left, right"),
        (kick_text, "12 N m at 0.1,0,0.2", "torque, not of impulse"),
        (kick_text, "-12 N s at 0.1,0,0.2", "must be positive"),
        (kick_text, "12 N s at 0.1,0.2", "needs 3 values"),
        (kick_text, "12 N s at 0.1,0,0.2 along 0,0,0", "not a direction"),
        (kick_text, "12 N s at 0.1,0,0.2 along sideways", "not a direction.*left"),
        # A high rate without a unit was probably meant in degrees.
        (CATCH_TEXT, "pitch 45", "without a unit.*deg/s[?]"),
        (CATCH_TEXT, "roll -115 pitch 1", "without a unit.*deg/s[?]"),
        *((tilt_text, text, "") for text in ("20", "20deg yaw", "200deg", "roll")),
        (tilt_text, "5deg left 5deg roll", "gives roll twice"),
        *((TURN_TEXT, text, "must give each value with its axis") for text in ("", "90deg", 3.0)),
        *((TURN_TEXT, text, "") for text in ("yaw", "yaw 1deg yaw 2deg", "90deg yaw 3")),
        (TURN_TEXT, "yaw 90deg 10deg roll", ""),
        *((person_text, text, "must give a mass and a height") for text in ("75kg", "75 1.75", 75)),
        (person_text, "75kg 1.75m 10kg", "must give a mass and a height"),
        *((person_text, text, "height") for text in ("75kg 1.75kg", "75kg 17.5m")),
    ],
)
def test_unclear_words_are_refused_with_an_example(reader, text, message):
    with pytest.raises(OcsError, match="--key") as caught:
        reader.read(text, "--key")
    assert re.search(message, f"{caught.value.message} {caught.value.hint}", re.DOTALL)


def test_a_tilt_names_its_lower_side():
    """Roll turns y towards z, and pitch z towards x."""
    tilt = tilt_text.read("20deg left 10deg forward", "tilt")
    assert tilt.roll < 0.0 < tilt.pitch


def test_words_stand_for_gravity_and_whole_turns():
    assert [GRAVITY.read(word, "") for word in ("Mars", "moon", "3.5 m/s2")] == [3.71, 1.62, 3.5]
    assert [FLIP.read(word, "") for word in ("back", "forward")] == [-2.0 * pi, 2.0 * pi]
    with pytest.raises(OcsError) as caught:
        FLIP.read("360", "--flip")
    assert caught.value.hint == "Did you mean 360deg?"
    assert GRAVITY.read("orbit", "") == GRAVITY.read("0", "") == 0.0
    with pytest.raises(OcsError, match="neither a number nor one of earth, moon, mars") as caught:
        GRAVITY.read("mras", "--gravity")
    assert caught.value.hint == "Did you mean 'mars'?"
    with pytest.raises(OcsError, match="400 m") as caught:
        section_of(jump_height=["400"])
    assert "Did you mean 400mm?" in str(caught.value)


@pytest.mark.parametrize(
    ("words", "names"),
    [
        ({"jump_height": ["0.4"]}, ["jump"]),
        ({"kick": ["1 N s at 0.1,0,0.1"]}, ["kick"]),
        ({"jump_height": ["0.4"], "kick": ["1 at 0.1,0,0.1"]}, ["kick"]),
        ({"jump_height": ["0.4"], "flip": ["back"]}, ["flip"]),
        (
            {"jump_height": ["0.4", "0.5"], "kick": ["1 at 0.1,0,0.1", "2 at 0.1,0,0.1"]},
            ["kick", "kick 2", "kick 3", "kick 4"],
        ),
        ({"fall": ["1"], "tilt": ["20deg"]}, ["fall"]),
        ({"tilt": ["20deg", "10deg roll"]}, ["fall", "fall 2"]),
        ({"fall": ["1"], "flip": ["back"]}, ["flip", "fall"]),
        (
            {"pivot": "0,0,-0.2", "stand_up": ["pitch 10deg in 0.6s", "pitch 5deg in 0.6s"]},
            ["stand up", "stand up 2"],
        ),
    ],
)
def test_words_become_named_maneuvers(solo12, words, names):
    resolved = resolve(Specification(requirement=section_of(**words)), solo12, SIZE)
    assert [each.name for each in resolved.requirement.maneuvers] == names
    text = "\n".join(resolved.assumptions)
    assert "paper's three" not in text
    assert all(f"{name}: " in text for name in names)


def test_names_of_tables_are_not_used_again(solo12):
    table = '[[maneuver]]\nkind = "drop"\nname = "{}"\nheight = 1.0\npitch = 0.3\n'
    tables = table.format("Fall") + table.format("fall-3") + table.format("fall_4")
    specified = parse_specification(f"requirement.tilt = ['20deg', '10deg', '5deg']\n{tables}", "x")
    resolved = resolve(specified, solo12, SIZE)
    names = [each.name for each in resolved.requirement.maneuvers]
    # "fall 4" would write the files of "fall_4".
    assert names == ["Fall", "fall-3", "fall_4", "fall 2", "fall 3", "fall 5"]
    assumed = [each.partition(": ")[0] for each in resolved.assumptions]
    assert [name for name in names if name in assumed] == names[3:]


def test_unspecified_values_are_the_papers(solo12):
    _, drop, flip = default_maneuvers(solo12)
    (fall,) = maneuvers(solo12, fall=["0.9m"])
    assert (fall.height, fall.pitch) == (0.9, drop.pitch)
    (turn,) = maneuvers(solo12, flip=["back"], gravity="moon")
    assert turn.duration == pytest.approx(flip.duration)
    assert (turn.jump_height, turn.gravity) == (flip.jump_height, flip.gravity)
    (jump,) = maneuvers(solo12, jump_height=["0.4"])
    default = default_maneuvers(solo12)[0]
    assert jump.takeoff_velocity == (0.0, pytest.approx(np.sqrt(2.0 * 9.81 * 0.4)))
    assert np.multiply(jump.torque, jump.duration) == pytest.approx(
        np.multiply(default.torque, default.duration)
    )


def test_words_of_the_command_line_replace_the_maneuvers_of_a_file():
    drop = parse_specification(
        '[[maneuver]]\nkind = "drop"\nname = "a"\nheight = 1.0\npitch = 0.3', "x"
    )
    paper = Specification(requirement=RequirementSection(maneuvers="paper", fall=(2.0,)))
    for base in (drop, paper):
        merged = merge(base, Specification(requirement=section_of(flip=["back"])))
        assert not merged.maneuvers
        assert merged.requirement == section_of(flip=["back"])
        assert merge(base, Specification()) == base


def test_the_papers_three_are_added_by_name(solo12):
    section = replace(section_of(fall=["1m"]), maneuvers="paper")
    resolved = resolve(Specification(requirement=section), solo12, SIZE)
    assert [each.name for each in resolved.requirement.maneuvers] == [
        "disturbance",
        "drop",
        "back-flip",
        "fall",
    ]


def test_a_sweep_replaces_worded_maneuvers_by_tables(solo12):
    task = Task.of(Specification(requirement=section_of(fall=["1m"])), solo12)
    changed = task.with_specification(SWEEPS["time"].at(0.5, task))
    (fall,) = changed.maneuvers
    assert fall.time() == pytest.approx(0.5)


def test_a_kick_worked_by_hand(make_robot):
    """By hand: (0.1, 0, 0.2) m x (0, 0.3, 0) N s = (-0.06, 0, 0.03) N m s; 0.3 / 2.5 = 0.12."""
    robot = make_robot(2.5, (0.032, 0.055, 0.07), 0.27)
    worded = worded_maneuvers(section_of(kick=["0.3 N s at 0.1,0,0.2 along 0,2,0"]), robot)
    (kick,) = worded.maneuvers
    assert np.multiply(kick.torque, kick.duration) == pytest.approx([-0.06, 0.0, 0.03])
    assert kick.velocity_change == pytest.approx((0.0, 0.12, 0.0))
    assert "angular impulse (-0.06, 0, 0.03) N m s" in worded.notes[0]


def test_only_a_kick_in_words_is_reported_with_the_device_on(real):
    """And not another assumption that starts with the name of a maneuver."""
    (kick,) = maneuvers(real, kick=["0.3 N s at 0.1,0,0.2"])
    named = Specification(maneuvers=(replace(kick, name="Wheel"),))
    in_words = Specification(requirement=section_of(kick=["1 N s at 0,0,0.1"]))
    for specification, count in ((named, 0), (in_words, 1)):
        resolved = resolve(specification, real, SIZE)
        assumptions = resolved.carrying(resolved.requirement).assumptions
        assert sum("with the device on" in each for each in assumptions) == count
        assert any(each.startswith("Wheel: one piece") for each in assumptions)


def test_a_kick_without_a_direction_comes_from_its_side(solo12):
    for point, along in (("0,0.1,0", -1.0), ("0,-0.1,0", 1.0), ("0.1,0,0.1", 1.0)):
        worded = worded_maneuvers(section_of(kick=[f"1 N s at {point}"]), solo12)
        assert np.sign(worded.maneuvers[0].velocity_change[1]) == along
        assert (
            f"along (0, {along:g}, 0) (from the side, as no direction is given)" in worded.notes[0]
        )


def test_a_kick_at_a_link_hits_its_frame(real):
    both = ["1 N s at FL_SHOULDER along up", "1 N s at 0.1946,0.0875,0 along up"]
    kick, same = maneuvers(real, kick=both)
    assert kick.torque == pytest.approx(same.torque, rel=1e-9)
    with pytest.raises(SpecificationError, match="no link 'FL_SHOLDER'") as caught:
        maneuvers(real, kick=["1 N s at FL_SHOLDER"])
    assert "FL_SHOULDER" in caught.value.hint


@pytest.mark.parametrize("along", ["0,1,0", "1,0,0", "0,0,-1", "1,-2,0.5"])
@pytest.mark.parametrize("with_device", [False, True])
def test_the_closed_form_of_a_kick_agrees_with_mujoco(real, along, with_device):
    """A free body with the total mass and inertia, and a force at the point of the kick."""
    total = braked_inertia(real, paper_device()) if with_device else real.mass_properties
    (kick,) = maneuvers(real, kick=[f"0.7 N s at 0.12,0.05,0.08 along {along}"])
    kick = kick.on(total)
    body = mujoco.MjSpec()
    body.option.gravity = (0.0, 0.0, 0.0)
    body.option.timestep = 1e-7
    trunk = body.worldbody.add_body(name="trunk")
    trunk.add_freejoint()
    trunk.explicitinertial = True
    trunk.mass, trunk.ipos = total.mass, total.com
    trunk.fullinertia = [*np.diag(total.inertia), *total.inertia[np.triu_indices(3, 1)]]
    model = body.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    direction = np.array([float(each) for each in along.split(",")])
    force = 0.7 * direction / np.linalg.norm(direction) / model.opt.timestep
    mujoco.mj_applyFT(
        model, data, force, np.zeros(3), np.array([0.12, 0.05, 0.08]), 1, data.qfrc_applied
    )
    mujoco.mj_step(model, data)
    rate = np.linalg.solve(total.inertia, np.multiply(kick.torque, kick.duration))
    assert data.qvel[3:] == pytest.approx(rate, rel=1e-5)
    at_com = data.qvel[:3] + np.cross(data.qvel[3:], total.com)
    assert at_com == pytest.approx(np.array(kick.velocity_change), rel=1e-5, abs=1e-6)


@given(st.floats(-1.5, 1.5), st.floats(1.0, 4.0), st.floats(0.05, 0.15))
def test_a_kick_up_or_down_moves_the_landing(gained, upward, onset):
    kick = Disturbance(
        name="kick",
        takeoff_velocity=(0.0, upward),
        torque=(0.1, 0.0, 0.0),
        onset=onset,
        duration=0.0005,
        velocity_change=(0.3, -0.2, gained),
    )
    hit = onset + 0.5 * kick.duration
    height = upward * hit - 9.81 * hit**2 / 2.0
    speed = upward - 9.81 * hit + gained
    left = (speed + np.sqrt(speed**2 + 2.0 * 9.81 * height)) / 9.81
    assert kick.flight_time == pytest.approx(hit + left)


@pytest.mark.parametrize("gained", [-0.5, 0.0, 0.5])
def test_a_slower_kick_has_more_time_after_it(real, gained):
    (kick,) = maneuvers(real, kick=["1 N s at 0.1,0,0.1"])
    kick = replace(kick, velocity_change=(0.0, 0.1, gained))
    assert kick.slower(1.2).time_left == pytest.approx(1.2 * kick.time_left)


def test_a_kick_in_millimetres_without_a_unit_is_off_the_robot(solo12):
    specification = Specification(requirement=section_of(kick=["1 N s at 100,0,80"]))
    assert "off the robot (0.45 m)" in problems_of(specification, solo12, SIZE)[0]


def test_a_turn_of_a_specified_time_gets_a_sufficient_jump(solo12):
    """It takes 90 % of the flight, as in the paper's back-flip."""
    words = {"turn": ["yaw 90deg in 2.9s"], "catch": ["pitch 45deg/s"], "gravity": "moon"}
    turn, catch = maneuvers(solo12, **words)
    assert turn.duration == 2.9
    assert turn.flight_time == pytest.approx(2.9 / 0.9)
    assert catch.rate == pytest.approx((0.0, pi / 4.0, 0.0))
    assert catch.duration == pytest.approx(0.9 * catch.flight_time)
    assert catch.end == "level"


def test_a_turn_in_orbit_has_no_jump(solo12):
    (turn,) = maneuvers(solo12, turn=["yaw 90deg in 60s"], gravity="orbit")
    assert (turn.gravity, turn.jump_height, turn.flight_time) == (0.0, 0.0, 60.0)
    assert turn.summary == "turns to yaw 90 deg in 60 s, in orbit"


@pytest.mark.parametrize(
    ("turn", "time"), [({"turn": ["yaw 90deg in 2.9s"]}, 2.9), ({"catch": ["pitch 1 in 1s"]}, 1)]
)
def test_a_turn_longer_than_the_specified_jump_is_refused(solo12, turn, time):
    """By hand: a jump of 0.1 m lasts sqrt(8 x 0.1 / 9.81) s."""
    (name,) = turn
    specified = Specification(requirement=section_of(jump_height=["0.1m"], **turn))
    assert problems_of(specified, solo12, SIZE) == (
        f"maneuver.{name}: its turn ends {time} s after lift-off, but the flight lasts 0.286 s",
    )


def test_a_trunk_frame_below_the_feet_is_refused(solo12):
    with pytest.raises(SpecificationError, match="is 50 mm below the feet") as caught:
        resolve(Specification(), replace(solo12, standing_height=-0.05), SIZE)
    assert "--trunk" in caught.value.hint
