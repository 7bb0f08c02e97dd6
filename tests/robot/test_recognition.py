"""Trunks and legs of robots with unusual zero postures, and questions about ambiguous robots.

The robots are small ones made for this: level, folded and radial legs, a spine, a hopper, wheels on
legs, legs that share a hip, fingers and arms.
"""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from urdf_text import WIDE, hinge, inertial, joint, leg, link, robot

from ocs_design.common.errors import RobotError
from ocs_design.robot.reader import read_robot
from ocs_design.robot.recognition import SURE, question_about, recognise
from ocs_design.robot.robot import Recognition
from ocs_design.robot.tree import Tree
from ocs_design.robot.urdf import read_urdf

CORNERS = {"fl": (0.2, 0.1), "fr": (0.2, -0.1), "hl": (-0.2, 0.1), "hr": (-0.2, -0.1)}
TRUNK = link("trunk", inertial(5.0, "0.02 0.05 0.06"))


def quadruped(thigh, shank, words=("thigh", "shank", "foot")):
    limbs = [leg(name, (*at, 0.0), thigh, shank, words=words) for name, at in CORNERS.items()]
    return [TRUNK, *(element for limb in limbs for element in limb)]


def read(elements) -> Tree:
    return read_urdf(robot(*elements), find_mesh=lambda _: None)


def read_file(folder, elements, **options):
    """The robot of a file with these elements."""
    path = folder / "robot.urdf"
    path.write_bytes(robot(*elements))
    return read_robot(path, **options)


def recognised(elements) -> Recognition:
    return recognise(read(elements))


def feet(recognition: Recognition) -> list[str]:
    return [leg.name for leg in recognition.reading.legs]


ALL_FEET = [f"{name}_foot" for name in CORNERS]
ZEROS = {
    "hanging": ((0.0, 0.0, -0.2), (0.0, 0.0, -0.2)),
    "level, knees outwards": ((0.2, 0.0, 0.0), (0.2, 0.0, 0.0)),
    "level, shank back under the thigh": ((-0.25, 0.0, 0.0), (0.25, 0.0, 0.0)),
    "folded upwards": ((0.0, 0.0, 0.2), (0.0, 0.0, -0.2)),
    "upright": ((0.0, 0.0, 0.2), (0.0, 0.0, 0.2)),
    "bent": ((0.1, 0.0, -0.15), (-0.15, 0.0, -0.1)),
}


def hanging_legs(parent="trunk", **hips):
    """Legs that hang straight down from these hips, by name."""
    return [
        part
        for name, hip in hips.items()
        for part in leg(name, hip, *ZEROS["hanging"], parent=parent)
    ]


def limb_pair(parts, height=0.1, aside=0.2, parent="trunk", words=("thigh", "shank", "foot")):
    """A limb on the left and one on the right."""
    sides = ("l", aside), ("r", -aside)
    return [
        part
        for name, y in sides
        for part in leg(name, (0.0, y, height), *parts, parent=parent, words=words)
    ]


PAIR = hanging_legs(a=(0.0, 0.1, 0.0), b=(0.0, -0.1, 0.0))
TORSO = link("torso", inertial(3.0)), hinge("waist", "trunk", "torso", "0 0 0.1")
ARM = ("upper_arm", "forearm", "hand")
OUTWARDS = ZEROS["level, knees outwards"]


def sliding_limbs():
    """Two limbs of two prismatic joints each."""
    for name, y in (("a", 0.1), ("b", -0.1)):
        at = ("trunk", f"{name}_upper", f"{name}_lower")
        yield from (link(at[1], inertial(0.1)), link(at[2], inertial(0.1, xyz="0 0 -0.3")))
        for above, below, xyz in ((at[0], at[1], f"0 {y} 0"), (at[1], at[2], "0 0 -0.3")):
            place = f'<origin xyz="{xyz}"/><axis xyz="0 0 1"/>'
            yield joint(below, above, below, place, WIDE, kind="prismatic")


def hexapod(zero, **scales):
    """Pairs of legs from front to rear; `scales` multiply the lengths of `ZEROS[zero]`."""
    elements = [TRUNK]
    for (name, scale), x in zip(scales.items(), (0.2, 0.0, -0.2), strict=True):
        parts = [tuple(scale * np.array(part)) for part in ZEROS[zero]]
        for side, y in (("l", 0.1), ("r", -0.1)):
            elements += leg(name + side, (x, y, 0.0), *parts)
    return elements


def with_wheels(joints, **hips):
    """Legs of one or two hinges with a wheel of 60 mm at the end of each."""
    disc = '<collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.06" length="0.03"/>'
    parts = [TRUNK]
    for name, hip in hips.items():
        parent, at = "trunk", " ".join(map(str, hip))
        for number in range(joints):
            part = f"{name}_leg{number}"
            parts += [link(part, inertial(0.2, "3e-4 3e-4 3e-4", "0 0 -0.1"))]
            parts += [hinge(f"{name}_{number}", parent, part, at)]
            parent, at = part, "0 0 -0.2"
        wheel, turn = f"{name}_wheel", f'<origin xyz="{at}"/><axis xyz="0 1 0"/>'
        parts += [link(wheel, inertial(0.2, "1e-4 2e-4 1e-4"), f"{disc}</geometry></collision>")]
        parts += [joint(f"{name}_roll", parent, wheel, turn, kind="continuous")]
    return parts


def hips_that_follow():
    """The right hip is a mimic of the left one."""
    elements = [TRUNK]
    for side, y in (("left", 0.1), ("right", -0.1)):
        hip = hinge(f"{side}_yaw", "trunk", f"{side}_hip", f"0 {y} 0", "0 0.7 0.7")
        if side == "right":
            hip = hip.replace("</joint>", '<mimic joint="left_yaw"/></joint>')
        elements += [link(f"{side}_hip", inertial(0.1)), hip]
        elements += hanging_legs(f"{side}_hip", **{side: (0.0, 0.0, 0.0)})
    return elements


def closed_pair(gap):
    """Two limbs of two bars with hips 0.2 m apart, whose ends are `gap` apart: 0 is a five-bar."""
    elements = [TRUNK]
    for name, x in (("a", 0.1), ("b", -0.1)):
        side = np.sign(x)
        shank = (side * (0.5 * gap - 0.2), 0.0, -0.2)
        elements += leg(name, (x, 0.0, 0.0), (side * 0.1, 0.0, -0.1), shank, words=("p", "q", "e"))
    return elements


def five_bar_legs():
    """Four legs of two limbs each, which turn about one hip axis 30 mm apart."""
    elements = [TRUNK]
    for name, (x, y) in CORNERS.items():
        for side, thigh in (("i", (0.1, 0.0, -0.1)), ("o", (-0.1, 0.0, -0.1))):
            shank = (-thigh[0], 0.0, -0.15)
            hip = (x, y + (0.03 if side == "o" else 0.0) * np.sign(y), 0.0)
            elements += leg(name + side, hip, thigh, shank)
    return elements


SIX_FEET = [f"{end}{side}_foot" for end in "fmh" for side in "lr"]
FOUR_WHEELS = with_wheels(2, **{name: (*at, 0.0) for name, at in CORNERS.items()})
UNAMBIGUOUS = {
    **{zero: (quadruped(*parts), ALL_FEET) for zero, parts in ZEROS.items()},
    "a second pair on a torso is arms": (
        [TRUNK, *TORSO, *limb_pair(ZEROS["hanging"], 0.3, parent="torso"), *PAIR],
        ["a_foot", "b_foot"],
    ),
    "limbs of prismatic joints alone are no legs": ([TRUNK, *sliding_limbs()], []),
    "six, the middle ones longer": (hexapod("hanging", f=1.0, m=1.15, h=1.0), SIX_FEET),
    "six that are level": (hexapod("level, knees outwards", f=1.0, m=1.15, h=1.0), SIX_FEET),
    "wheels on legs": (FOUR_WHEELS, [f"{name}_wheel" for name in CORNERS]),
    "limbs named as arms": ([TRUNK, *limb_pair(OUTWARDS, words=("arm", "forearm", "hand"))], []),
    "fins that hang like legs": (
        [TRUNK, *limb_pair(ZEROS["hanging"], 0.0, 0.1, words=("fin", "fintip", "fin_end"))],
        [],
    ),
    "a hip that follows the other one": (hips_that_follow(), ["left_foot", "right_foot"]),
    "limbs that do not meet at their ends": (closed_pair(0.1), ["a_e", "b_e"]),
}


@pytest.mark.parametrize(("elements", "expected"), UNAMBIGUOUS.values(), ids=UNAMBIGUOUS)
def test_unambiguous_robots_raise_no_question(elements, expected):
    recognition = recognised(elements)
    assert recognition.sure
    assert recognition.reading.confidence >= SURE
    assert (recognition.reading.trunk, feet(recognition)) == ("trunk", expected)


AMBIGUOUS = {
    "three legs, in the order of the file": (
        hanging_legs(c=(0.2, 0.0, 0.0), a=(-0.1, 0.1, 0.0), b=(-0.1, -0.1, 0.0)),
        ["c_foot", "a_foot", "b_foot"],
        "",
    ),
    "a short limb beside legs": (
        [*PAIR, *leg("c", (0.1, 0.0, 0.0), (0.0, 0.0, -0.2), (0.0, 0.0, -0.02))],
        ["a_foot", "b_foot"],
        "",
    ),
    "limbs high above the centre of mass": (
        limb_pair(ZEROS["hanging"], 1.0, 0.1),
        ["l_foot", "r_foot"],
        "",
    ),
    "a nameless limb on a fixed base": (
        leg("it", (0.0, 0.0, 0.0), *ZEROS["hanging"], words=("b", "c", "d")),
        ["it_d"],
        "may just as well be an arm",
    ),
    "a prosthesis and a leg": (
        [
            *hanging_legs(l=(0.0, 0.1, 0.0)),
            *leg("r", (0.0, -0.1, 0.0), (0.0, 0.0, -0.2), (0.0, 0.05, -0.2)),
            link("r_toe", inertial(0.1)),
            hinge("r_d", "r_foot", "r_toe", "0 0 -0.1"),
        ],
        ["l_foot", "r_toe"],
        "",
    ),
    "an insect's front legs, which reach less deep": (
        hexapod("hanging", f=0.7, m=1.0, h=1.0)[1:],
        SIX_FEET,
        "fl_foot, fr_foot",
    ),
    "one leg beside arms": (
        [*hanging_legs(right=(0.0, -0.1, 0.0)), *limb_pair(OUTWARDS, words=ARM)],
        ["right_foot"],
        "it is not the robot's only limb",
    ),
    "wheels on trailing arms": (
        with_wheels(1, hl=(0.0, 0.1, 0.0), hr=(0.0, -0.1, 0.0))[1:],
        ["hl_wheel", "hr_wheel"],
        "",
    ),
    "legs that share a hip, of which one each is offered": (
        five_bar_legs()[1:],
        [f"{name}i_foot" for name in CORNERS],
        "share a hip",
    ),
    "limbs that meet at their ends": (closed_pair(0.0)[1:], ["a_e", "b_e"], "meet at their ends"),
}


@pytest.mark.parametrize(("limbs", "likely", "words"), AMBIGUOUS.values(), ids=AMBIGUOUS)
def test_ambiguous_robots_raise_a_question(limbs, likely, words):
    recognition = recognised([TRUNK, *limbs])
    assert not recognition.sure
    assert [leg.name for leg in recognition.likely[0].legs] == likely
    assert words in question_about(recognition).message


@pytest.mark.parametrize(
    ("elements", "legs", "words"),
    [
        (five_bar_legs(), [f"{name}i_foot" for name in CORNERS], "the other is locked"),
        (closed_pair(0.0), ["a_e", "b_e"], "meet at their ends"),
    ],
)
def test_closed_chains_of_specified_legs_raise_a_warning(tmp_path, elements, legs, words):
    warnings = read_file(tmp_path, elements, legs=legs).warnings
    assert any(words in warning for warning in warnings)


def test_wheels_are_feet_of_their_radius():
    radii = [leg.foot_radius for leg in recognised(FOUR_WHEELS).reading.legs]
    assert radii == pytest.approx([0.06] * 4, abs=1e-6)


def test_a_lone_arm_raises_a_question():
    names = ["base", "one", "two", "three", "four"]
    elements = [link(names[0], inertial(1.0))]
    for below, name in pairwise(names):
        elements += [link(name, inertial(1.5, xyz="0 0 0.1")), hinge(name, below, name, "0 0 0.2")]
    recognition = recognised(elements)
    assert not recognition.sure
    assert recognition.reading.legs == ()
    question = question_about(recognition)
    assert "as an arm is" in question.message
    # Once a link was called the most likely trunk at a lower share than the next answer's.
    shares = [reading.confidence for reading in recognition.likely]
    assert shares == sorted(shares, reverse=True)
    assert recognition.reading == recognition.likely[0]
    assert "'base' as the trunk" in question.message
    assert recognise(read(elements), trunk="base", legs=[]).sure


def test_a_robot_with_level_legs_stands_on_them(tmp_path):
    elements = quadruped(*ZEROS["level, shank back under the thigh"])
    standing, level = read_file(tmp_path, elements), read_file(tmp_path, elements, posture="zero")
    # Thigh and shank of 0.25 m, bent to 80 % of their length.
    assert standing.standing_height == pytest.approx(0.8 * 0.5, abs=1e-4)
    assert standing.inertia[0, 0] > 1.2 * level.inertia[0, 0]
    assert standing.recognition.sure


@given(st.lists(st.text("abcdxyz", min_size=3, max_size=3), min_size=3, max_size=3, unique=True))
@settings(max_examples=15, deadline=None)
def test_meaningless_names_change_nothing(words):
    recognition = recognised(quadruped(*ZEROS["folded upwards"], words=words))
    assert recognition.sure
    assert feet(recognition) == [f"{name}_{words[2]}" for name in CORNERS]


def dog():
    """Shoulders and pelvis, each with two legs, and a spine of two hinges between them."""
    elements = [
        link("chest", inertial(4.0, "0.02 0.03 0.03")),
        link("vertebra", inertial(0.3, "1e-4 1e-4 1e-4")),
        link("pelvis", inertial(2.0, "0.01 0.01 0.01")),
        hinge("spine_1", "chest", "vertebra", "-0.15 0 0"),
        hinge("spine_2", "vertebra", "pelvis", "-0.15 0 0", "0 0 1"),
    ]
    for name, (_, y) in CORNERS.items():
        parent = "chest" if name[0] == "f" else "pelvis"
        elements += hanging_legs(parent, **{name: (0.0, y, 0.0)})
    return elements


def test_a_spine_raises_a_question():
    recognition = recognised(dog())
    assert not recognition.sure
    question = question_about(recognition)
    assert "a spine" in question.message
    best = recognition.likely[0]
    assert (best.trunk, sorted(leg.name for leg in best.legs)) == ("chest", sorted(ALL_FEET))
    trunks = {reading.trunk for reading in recognition.likely if len(reading.legs) == 4}
    assert trunks == {"chest", "pelvis"}
    assert best.options in (question.hint or "")


@pytest.mark.parametrize("trunk", ["chest", "pelvis"])
def test_a_robot_with_a_spine_stands_once_its_trunk_is_specified(tmp_path, trunk):
    standing = read_file(tmp_path, dog(), trunk=trunk, legs=ALL_FEET)
    assert standing.trunk == trunk
    assert standing.standing_height == pytest.approx(0.32, abs=1e-4)
    assert [standing.posture[name] for name in ("spine_1", "spine_2")] == [0.0, 0.0]
    assert {leg.name: standing.tree.bodies[leg.base].name for leg in standing.legs} == {
        "fl_foot": "chest",
        "fr_foot": "chest",
        "hl_foot": "pelvis",
        "hr_foot": "pelvis",
    }
    assert any("a spine" in warning for warning in standing.warnings)


def test_specified_legs_alone_leave_the_end_of_a_spine_open():
    recognition = recognise(read(dog()), legs=ALL_FEET)
    assert {reading.trunk for reading in recognition.likely} == {"chest", "pelvis"}


HOPPER = """<mujoco model="hopper"><compiler angle="degree"/><worldbody>
  <body name="torso" pos="0 0 1.25">
    <joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide" axis="0 0 1"/>
    <joint name="turn" axis="0 1 0"/>
    <geom type="capsule" fromto="0 0 0.2 0 0 -0.2" size="0.05"/>
    <body name="thigh" pos="0 0 -0.2"><joint name="hip" axis="0 -1 0" range="-150 0"/>
      <geom type="capsule" fromto="0 0 0 0 0 -0.45" size="0.05"/>
      <body name="shank" pos="0 0 -0.45"><joint name="knee" axis="0 -1 0" range="-150 0"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.5" size="0.04"/>
        <body name="foot" pos="0 0 -0.5"><joint name="ankle" axis="0 -1 0" range="-45 45"/>
          <geom type="capsule" fromto="-0.13 0 -0.1 0.26 0 -0.1" size="0.06" density="3000"/>
        </body></body></body></body></worldbody></mujoco>"""


def test_the_trunk_of_a_hopper_is_not_its_heavy_foot(tmp_path):
    path = tmp_path / "hopper.xml"
    path.write_text(HOPPER)
    hopper = read_robot(path)
    heaviest = max(hopper.tree.bodies, key=lambda body: body.mass_properties.mass)
    assert heaviest.name == "foot"
    assert hopper.trunk == "torso"
    assert [leg.name for leg in hopper.legs] == ["foot"]
    assert hopper.recognition.sure


def test_closed_chains_of_a_model_raise_a_warning(tmp_path):
    loop = '</worldbody><equality><connect body1="foot" body2="torso" anchor="0 0 0"/></equality>'
    path = tmp_path / "loop.xml"
    path.write_text(HOPPER.replace("</worldbody>", loop))
    assert any("cut open" in warning for warning in read_robot(path).warnings)


@pytest.mark.parametrize(
    ("legs", "message"),
    [
        (["fl_foot", "fl_thigh"], "links of one limb"),
        (["trunk", "fl_foot"], "links of one limb"),
        (["fl_foot", "nowhere"], "no link 'nowhere'"),
    ],
)
def test_impossible_legs_are_refused(tmp_path, legs, message):
    with pytest.raises(RobotError, match=message):
        read_file(tmp_path, quadruped(*ZEROS["hanging"]), legs=legs)


def test_specified_legs_are_those_that_are_recognised():
    tree = read(quadruped(*ZEROS["bent"]))
    unaided, specified = recognise(tree), recognise(tree, legs=ALL_FEET)
    assert [leg.joints for leg in specified.reading.legs] == [
        leg.joints for leg in unaided.reading.legs
    ]
    # Any link of the foot's body names it, and a pair of legs is a biped.
    biped = recognise(tree, legs=["fl_shank", "fr_foot"])
    assert feet(biped) == ["fl_foot", "fr_foot"]
    assert biped.specified == {"legs"}


def test_no_legs_can_be_specified(tmp_path):
    bare = read_file(tmp_path, quadruped(*ZEROS["hanging"]), legs=[])
    assert (bare.legs, bare.posture_name, bare.standing_height) == ((), "zero", None)


@pytest.mark.parametrize(
    ("joints", "sure"),
    [("", False), ('<joint axis="0 0 1"/>', False), ("<freejoint/>", True)],
    ids=["bolted", "turns", "flies"],
)
def test_a_fixed_robot_without_legs_raises_a_question(tmp_path, joints, sure):
    path = tmp_path / "base.xml"
    path.write_text(
        f'<mujoco><worldbody><body name="base">{joints}<geom size=".2"/><body pos="0 0 .2">'
        '<joint axis="0 1 0"/><geom size=".1"/></body></body></worldbody></mujoco>'
    )
    recognition = read_robot(path).recognition
    assert recognition.sure == sure
    assert recognition.reading.trunk == "base"


def test_a_heaviest_link_that_is_not_the_root_raises_a_question():
    elements = [
        link("wrist", inertial(0.1)),
        link("tip", inertial(0.6)),
        link("thumb", inertial(0.1)),
    ]
    joints = [hinge("a", "wrist", "tip", "0.1 0 0"), hinge("b", "wrist", "thumb", "0 0.1 0")]
    recognition = recognised([*elements, *joints])
    assert [reading.options for reading in recognition.likely] == [
        "--trunk tip --legs none",
        "--trunk wrist --legs none",
    ]


def test_limbs_that_a_model_ties_together_raise_a_question(tmp_path):
    def limb(name, x):
        return (
            f'<body name="{name}1" pos="{x} 0 0"><joint axis="0 1 0"/>'
            f'<geom type="capsule" fromto="0 0 0 0 0 -.2" size=".02"/>'
            f'<body name="{name}2" pos="0 0 -.2"><joint axis="0 1 0"/>'
            '<geom type="capsule" fromto="0 0 0 0 0 -.2" size=".02"/></body></body>'
        )

    path = tmp_path / "loop.xml"
    model = (
        '<mujoco><worldbody><body name="base"><freejoint/><geom size=".1"/>'
        f"{limb('a', 0.1)}{limb('b', -0.1)}</body></worldbody>{{}}</mujoco>"
    )
    tie = '<equality><connect body1="a2" body2="b2" anchor="0 0 -.2"/></equality>'
    sure = {}
    for loop in ("", tie):
        path.write_text(model.format(loop))
        recognition = read_robot(path).recognition
        sure[loop] = recognition.sure
    assert sure == {"": True, tie: False}


def test_a_robot_that_its_file_fixes_to_the_world_has_its_own_trunk(tmp_path):
    world = joint("hang", "world", "trunk", '<origin xyz="0 0 1"/>', kind="fixed")
    free = read_file(tmp_path, quadruped(*ZEROS["bent"]))
    fixed = read_file(tmp_path, [link("world"), world, *quadruped(*ZEROS["bent"])])
    assert fixed.trunk == "trunk"
    assert fixed.standing_height == pytest.approx(free.standing_height, abs=1e-12)
    np.testing.assert_allclose(fixed.com, free.com, atol=1e-12)
