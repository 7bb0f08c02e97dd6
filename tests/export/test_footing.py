"""What is said of the holes that the trunk needs, and where the plate under the feet is written."""

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
from robots import SOLO12
from wheels import driven_device

from ocs_design.export.assembly_notes import trunk_notes
from ocs_design.export.formats import Subject
from ocs_design.export.robot_model import robot_model
from ocs_design.export.snippets import snippets
from ocs_design.robot.reader import read_robot
from ocs_design.sizing.footing.standing import stand_on_trunk

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "solo12.urdf"


@pytest.fixture(scope="module")
def robot():
    return read_robot(SOLO12)


@pytest.fixture(scope="module")
def plated(robot):
    return stand_on_trunk(driven_device(), robot, stated=False)


def test_the_holes_of_the_plate_are_told(robot, plated):
    (said,) = trunk_notes(plated, robot)
    x, y = plated.plate.trunk[0]
    x += plated.plate.position[0]
    assert f"({1e3 * x:.1f}, {1e3 * y:.1f})" in said
    assert "M3" in said


def test_feet_on_the_trunk_need_threads_in_it_and_wheels_without_feet_none(robot, plated):
    (said,) = trunk_notes(replace(plated, plate=None), robot)
    assert "threads M3" in said
    bare = replace(plated, carrier=replace(plated.carrier, mass=0.0))
    assert trunk_notes(bare, robot) == ()


def test_the_frame_is_found_by_the_trunk_s_ends(plated):
    """Boxes of its link that are not turned, and cylinders that lie forward."""
    (said,) = trunk_notes(plated, read_robot(EXAMPLE))
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
    found = re.findall(r"(?:= | to )(-?[\d.]+)", said.split("reaches from")[1])
    expected = [low[0], high[0], low[1], high[1], high[2]]
    np.testing.assert_allclose(np.array(found, dtype=float), expected, atol=1.0)


def test_mujoco_weighs_it_where_it_is(robot, plated):
    model = robot_model(robot, plated).compiled
    bare = robot_model(robot, replace(plated, plate=None)).compiled
    assert sum(model.body_mass) - sum(bare.body_mass) == pytest.approx(plated.plate.mass)
    body, own = model.body("ocs_plate"), plated.plate.own_mass_properties()
    np.testing.assert_allclose(body.pos, plated.plate.position, atol=1e-9)
    np.testing.assert_allclose(body.ipos, own.com, atol=1e-9)
    moments = np.linalg.eigvalsh(own.inertia)
    np.testing.assert_allclose(sorted(body.inertia), moments, rtol=1e-6)


@pytest.mark.parametrize("name", ["ocs.urdf", "ocs.xml"])
def test_snippets_weigh_it_too(robot, plated, name):
    masses = []
    for device in (plated, replace(plated, plate=None)):
        text = snippets(device, robot)[name]
        assert ("plate" in text) == (device.plate is not None)
        spec = mujoco.MjSpec.from_string(text)
        spec.compiler.fusestatic = False
        masses.append(sum(spec.compile().body_mass))
    assert masses[0] - masses[1] == pytest.approx(plated.plate.mass)


def test_its_outline_is_a_drawing(robot, plated, tmp_path):
    ezdxf = pytest.importorskip("ezdxf")
    from ocs_design.export.dxf import write

    write(Subject.of(robot, plated, "solo12"), tmp_path)
    space = ezdxf.readfile(tmp_path / "plate.dxf").modelspace()
    layers = [entity.dxf.layer for entity in space]
    # Two windows, four threads and four holes.
    assert (layers.count("OUTLINE"), layers.count("HOLES")) == (1, 10)
