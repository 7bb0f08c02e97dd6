"""Commands ask which links are trunk and legs, accept the answer, and draw what they recognised."""

import xml.etree.ElementTree as ET
from errno import ENOSPC
from pathlib import Path

import pytest
from commands import BY_HAND, SOLO12, failure, run
from PIL import Image
from urdf_text import hinge, inertial, leg, link, robot

DOWN = (0.0, 0.0, -0.2)
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def dog(tmp_path):
    """A chest and a pelvis with a hinge between them, two legs on each."""
    elements = [
        link("chest", inertial(4.0, "0.02 0.03 0.03")),
        link("pelvis", inertial(2.0, "0.01 0.01 0.01")),
        hinge("spine", "chest", "pelvis", "-0.3 0 0"),
    ]
    for parent in ("chest", "pelvis"):
        for side, y in (("l", 0.1), ("r", -0.1)):
            elements += leg(f"{parent[0]}{side}", (0.0, y, 0.0), DOWN, DOWN, parent)
    path = tmp_path / "dog.urdf"
    path.write_bytes(robot(*elements))
    return path


FEET = "pl_foot,pr_foot,cl_foot,cr_foot"
"""In the order of the tree."""


@pytest.mark.parametrize("command", ["size", "pareto"])
def test_a_command_that_designs_asks_without_writing(dog, tmp_path, command):
    message = failure(3, command, dog, "-o", tmp_path / "out")
    for part in ("trunk and legs are not clear", "--trunk chest", "--trunk pelvis"):
        assert part in message
    assert not (tmp_path / "out").exists()


def test_inspect_reports_the_question_without_failing(dog):
    result = run("inspect", dog)
    assert result.code == 0
    assert f"--trunk chest --legs {FEET}" in result.stdout + result.stderr
    recognition = run("inspect", dog, "--json").document["recognition"]
    assert recognition["likely"][0] == {
        "trunk": "chest",
        "legs": FEET.split(","),
        "confidence": pytest.approx(recognition["confidence"]),
    }


def test_the_answer_is_accepted(dog):
    document = run("inspect", dog, "--trunk", "pelvis", "--legs", FEET, "--json").document
    recognition = document["recognition"]
    assert document["robot"]["trunk"] == "pelvis"
    assert [leg["foot"] for leg in recognition["legs"]] == FEET.split(",")
    assert recognition["stated"] == ["legs", "trunk"]
    assert recognition["likely"] == []
    assert any("a spine" in warning for warning in document["robot"]["warnings"])


def test_no_legs_is_an_answer():
    document = run("inspect", SOLO12, "--legs", "none", "--json").document
    assert document["robot"]["legs"] == []
    assert document["robot"]["posture_name"] == "zero"


def test_the_legs_of_a_specification(dog, tmp_path):
    feet = ", ".join(f'"{foot}"' for foot in FEET.split(","))
    specification = tmp_path / "spec.toml"
    specification.write_text(
        f'[robot]\nfile = "dog.urdf"\ntrunk = "chest"\nlegs = [{feet}]\n', encoding="utf-8"
    )
    recognition = run("inspect", "--spec", specification, "--json").document["recognition"]
    assert [leg["foot"] for leg in recognition["legs"]] == FEET.split(",")


def test_an_unknown_foot_is_refused_with_a_suggestion():
    message = failure(3, "inspect", SOLO12, "--legs", "FL_FOOT,FR_TOE")
    assert "no link 'FR_TOE'" in message
    assert "FR_FOOT" in message


def test_the_picture_names_feet_and_directions(tmp_path):
    path = tmp_path / "solo12.svg"
    assert run("inspect", SOLO12, "--picture", path).code == 0
    words = [text.text for text in ET.parse(path).iter(f"{SVG}text")]
    feet = ("FL_FOOT", "FR_FOOT", "HL_FOOT", "HR_FOOT")
    # Views from the right, the front and above.
    assert [words.count(foot) for foot in feet] == [3, 3, 3, 3]
    assert [words.count(direction) for direction in ("forward", "left", "up")] == [2, 2, 2]
    circles = list(ET.parse(path).iter(f"{SVG}circle"))
    ground = {round(float(circle.get("cy")), 1) for circle in circles[:4]}
    # Seen from the right: all feet on one ground, the front ones ahead of the hind ones.
    assert len(ground) == 1
    front, hind = (float(circles[i].get("cx")) for i in (0, 2))
    assert front > hind


def test_the_picture_as_png_is_the_svg_at_twice_the_size(tmp_path):
    pictures = [tmp_path / "solo12.svg", tmp_path / "solo12.png"]
    assert [run("inspect", SOLO12, "--picture", path).code for path in pictures] == [0, 0]
    width, height = (float(ET.parse(pictures[0]).getroot().get(n)) for n in ("width", "height"))
    with Image.open(pictures[1]) as image:
        assert image.size == pytest.approx((2 * width, 2 * height), abs=2)
        assert len(image.convert("RGB").getcolors(1 << 20)) > 20


def test_a_failed_picture_leaves_the_previous_one(tmp_path, monkeypatch):
    path = tmp_path / "solo12.svg"
    path.write_text("before")

    def full(*_, **__):
        raise OSError(ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    result = run("inspect", SOLO12, "--picture", path)
    assert (result.code, path.read_text()) == (3, "before")
    assert "free some space" in result.output
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        ((SOLO12, "--picture", "solo12.gif"), 2, "name a file *.svg or *.png"),
        ((SOLO12, "--picture", "nowhere/at/all.svg"), 3, "no such folder"),
        ((*BY_HAND, "--picture", "box.svg"), 2, "nothing to draw"),
    ],
)
def test_impossible_pictures_are_refused(arguments, code, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert message in failure(code, "inspect", *arguments)
