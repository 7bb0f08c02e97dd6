"""Notes on holes in the trunk, and the plate under the feet in every file."""

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
from robots import SOLO12
from wheels import driven_device, stand_on_trunk

from ocs_design.export.assembly_notes import trunk_notes
from ocs_design.export.formats import Subject
from ocs_design.export.robot_model import robot_model
from ocs_design.export.snippets import snippets
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.reader import read_robot

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "solo12.urdf"


@pytest.fixture(scope="module")
def robot():
    return read_robot(SOLO12)


@pytest.fixture(scope="module")
def plated(robot):
    return stand_on_trunk(driven_device(), robot, specified=False)


def test_the_holes_of_the_plate_are_noted(robot, plated):
    note, _ = trunk_notes(plated, robot)
    x, y = plated.plate.trunk[0]
    x += plated.plate.position[0]
    assert f"({1e3 * x:.1f}, {1e3 * y:.1f})" in note
    assert "M3" in note
    assert note.startswith("a plate carries the feet")
    two = replace(plated.plate, rows=(0.09, -0.09))
    note, _ = trunk_notes(replace(plated, plate=two), robot)
    assert note.startswith("2 plates carry the feet")


def test_feet_on_the_trunk_need_threads_in_it_and_wheels_without_feet_none(robot, plated):
    note, _ = trunk_notes(replace(plated, plate=None), robot)
    assert "threads M3" in note
    bare = replace(plated, carrier=replace(plated.carrier, mass=0.0))
    assert trunk_notes(bare, robot) == ()


def test_the_frame_is_located_by_the_ends_of_the_trunk(plated):
    """The trunk link has boxes along its axes and cylinders along x."""
    _, note = trunk_notes(plated, read_robot(EXAMPLE))
    lows, highs = [], []
    for visual in ElementTree.parse(EXAMPLE).findall("link[@name='base_link']/visual"):
        middle = np.array(visual.find("origin").get("xyz").split(), dtype=float)
        (shape,) = visual.find("geometry")
        if shape.tag == "box":
            half = np.array(shape.get("size").split(), dtype=float) / 2.0
        else:
            along, radius = float(shape.get("length")) / 2.0, float(shape.get("radius"))
            half = np.array([along, radius, radius])
        lows.append(middle - half)
        highs.append(middle + half)
    low, high = 1e3 * np.min(lows, axis=0), 1e3 * np.max(highs, axis=0)
    distances = re.findall(r"([\d.]+) mm", note)
    expected = [high[0], -low[0], high[1], -low[1], high[2]]
    assert min(expected) > 0.0
    assert f"{expected[0]:.1f} mm behind the front end" in note
    np.testing.assert_allclose(np.array(distances, dtype=float), expected, atol=1.0)


@pytest.mark.parametrize(
    ("above", "words"), [(0.0, "stand on its top"), (0.049, "stand 49.0 mm above its top")]
)
def test_without_a_file_the_notes_locate_the_box_of_the_trunk(above, words):
    """A robot of 30 kg, whose box is 224 mm high, with its origin at the centre of mass."""
    robot, device = robot_by_hand(30.0, (0.55, 1.6, 1.9)), driven_device()
    height = 0.5 * np.sqrt(6.0 * (0.55 + 1.6 - 1.9) / 30.0) + device.foot.wheel_height + above
    modules = tuple(
        replace(module, position=np.array([*module.position[:2], height]))
        for module in device.modules
    )
    _, note = trunk_notes(replace(device, modules=modules), robot)
    assert "the origin of the base frame is the robot's centre of mass" in note
    assert "a box of 768 x 412 x 224 mm" in note
    assert "its top is at z = 111.8 mm" in note
    assert words in note


def test_mujoco_has_the_plate_with_its_mass_and_place(robot, plated):
    model = robot_model(robot, plated).compiled
    bare = robot_model(robot, replace(plated, plate=None)).compiled
    assert sum(model.body_mass) - sum(bare.body_mass) == pytest.approx(plated.plate.mass)
    body, expected = model.body("ocs_plate"), plated.plate.own_mass_properties()
    np.testing.assert_allclose(body.pos, plated.plate.position, atol=1e-9)
    np.testing.assert_allclose(body.ipos, expected.com, atol=1e-9)
    moments = np.linalg.eigvalsh(expected.inertia)
    np.testing.assert_allclose(sorted(body.inertia), moments, rtol=1e-6)


@pytest.mark.parametrize("name", ["ocs.urdf", "ocs.xml"])
def test_snippets_have_the_mass_of_the_plate(robot, plated, name):
    masses = []
    for device in (plated, replace(plated, plate=None)):
        text = snippets(device, robot)[name]
        assert ("plate" in text) == (device.plate is not None)
        spec = mujoco.MjSpec.from_string(text)
        spec.compiler.fusestatic = False
        masses.append(sum(spec.compile().body_mass))
    assert masses[0] - masses[1] == pytest.approx(plated.plate.mass)


def test_the_dxf_has_outline_and_holes_of_the_plate(robot, plated, tmp_path):
    ezdxf = pytest.importorskip("ezdxf")
    from ocs_design.export.dxf import write

    write(Subject.of(robot, plated, "solo12"), tmp_path)
    space = ezdxf.readfile(tmp_path / "plate.dxf").modelspace()
    layers = [entity.dxf.layer for entity in space]
    # Two windows, four threads and four holes.
    assert (layers.count("OUTLINE"), layers.count("HOLES")) == (1, 10)
