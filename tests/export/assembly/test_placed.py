"""Drawn parts: line art and pieces in their places."""

from dataclasses import replace

import numpy as np
import pytest
from built_devices import DEVICES, device_in_layout
from manifold3d import Manifold, Mesh64

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.device.solids import motor_mount
from ocs_design.export.assembly.line_art import section_lines, visible_lines
from ocs_design.export.assembly.placed import module_pieces, placed_parts
from ocs_design.export.assembly_notes import drive_notes
from ocs_design.export.device_parts import foot_holes
from ocs_design.export.meshes import Mesh, solid_mesh
from ocs_design.export.raster import view_of
from ocs_design.parts.housing import LID_SCREWS
from ocs_design.parts.printed import CLEARANCE, trunk_screws
from ocs_design.parts.shapes import Rectangle
from ocs_design.parts.solids import Prism, hollow_cylinder

BUILT = ("caged", "by its face", "unknown threads", "in a guard ring")


@pytest.mark.parametrize("name", BUILT)
def test_pieces_and_screws_weigh_what_stands_still(name):
    """All of them together; what turns was sized without its holes, and is left out."""
    device = DEVICES[name]
    turning = {"flywheel", "rim", "hub"}
    pieces = sum(
        part.mass_properties().mass
        for name, (part, _) in placed_parts(device).items()
        if name not in turning
    )
    screws = sum(each.fastening.mass for each in motor_mount(device).screwed)
    screws += LID_SCREWS.mass + trunk_screws(device.foot_plate).mass
    assert pieces + screws == pytest.approx(device.carrier.mass, rel=1e-9)


def test_wheels_that_lean_on_nothing_have_the_screws_of_their_feet():
    """No drilling sheet has holes for them, and the booklet is written all the same."""
    device = device_in_layout(Layout(LayoutName.PYRAMID))
    assert not foot_holes(device)
    (feet,) = (
        each for each in module_pieces(device) if each.fastening == trunk_screws(device.foot_plate)
    )
    assert feet.modules == len(device.modules)


def test_a_gear_has_a_wheel_at_either_axis():
    placed = placed_parts(DEVICES["gear"])
    assert {"gear", "gear_2", "motor"} <= set(placed)
    heights = [placed[name][1].position[1] for name in ("gear", "gear_2")]
    assert heights == pytest.approx([0.0, -0.03])
    gears = sum(placed[name][0].mass_properties().mass for name in ("gear", "gear_2"))
    assert gears == pytest.approx(0.02)


def _overlap(a, b):
    """Volume that two pieces share [m^3]."""
    first, second = (
        Manifold(Mesh64(each.mesh.vertices, each.mesh.triangles.astype(np.uint64)))
        for each in (a, b)
    )
    return float((first ^ second).volume())


@pytest.mark.parametrize("name", BUILT)
def test_screws_cut_into_nothing_but_what_their_threads_are_in(name):
    """All of them: only into one piece each, and there only as far as they reach beyond what they
    hold. A head in a part, or a tip in two, shares more, or with another."""
    pieces = module_pieces(DEVICES[name])
    for screw in (each for each in pieces if each.fastening is not None):
        held = screw.fastening
        shared = [_overlap(screw, each) for each in pieces if each.fastening is None]
        in_thread = held.length - held.thickness
        most = held.count * np.pi / 4.0 * held.screw.diameter**2 * in_thread
        assert sum(each > 1e-12 for each in shared) <= 1, held.purpose
        assert max(shared) <= most * (1.0 + 1e-6), held.purpose


def test_a_shaft_reaches_into_the_hub_that_is_bonded_on_it():
    parts = placed_parts(DEVICES["by its face"])
    (body, shaft), place = parts["motor"][0].joined, parts["motor"][1]
    wheel = DEVICES["by its face"].flywheel
    assert place.position == pytest.approx(0.0)
    assert shaft.profile[:, 0].max() == pytest.approx(wheel.web.hub.bore_radius, rel=1e-6)
    assert shaft.profile[:, 1].min() == pytest.approx(body.profile[:, 1].max())
    assert shaft.profile[:, 1].max() == pytest.approx(wheel.web.hub.height / 2.0)


@pytest.mark.parametrize("length", [0.003, 0.009, 0.05])
def test_a_shaft_is_cut_where_it_would_run_into_the_lid(length):
    """Whatever its length it is clear of the lid, and one that is cut still fills the hub."""
    device = DEVICES["by its face"]
    mounting = replace(device.motor.mounting, shaft_length=length)
    device = replace(device, motor=replace(device.motor, mounting=mounting))
    pieces = {piece.key: piece for piece in module_pieces(device)}
    tip = pieces["motor"].mesh.vertices[:, 2].max()
    lid = pieces["lid"].mesh.vertices[:, 2].min()
    hub = device.flywheel.web.hub.height / 2.0
    assert tip < lid
    front = placed_parts(device)["motor"][0].joined[0].profile[:, 1].max()
    cut = length - (tip - front)
    told = [note for note in drive_notes(device) if "run into the lid" in note]
    if front + length <= lid - CLEARANCE:
        assert cut == pytest.approx(0.0, abs=1e-9)
        assert not told
    else:
        assert tip == pytest.approx(hub)
        (note,) = told
        assert f"cut {1e3 * cut:.3g} mm off" in note


def test_the_screws_heads_stand_on_what_they_hold():
    """Those of the lid: their tips are in the drum, their heads above the lid."""
    pieces = {piece.key: piece for piece in module_pieces(DEVICES["caged"])}
    lid = pieces["lid"].mesh.vertices[:, 2]
    along = pieces[LID_SCREWS].mesh.vertices[:, 2]
    assert along.max() == pytest.approx(lid.max() + 0.002)
    assert along.min() == pytest.approx(lid.max() - 0.006)
    assert np.hypot(*pieces[LID_SCREWS].mesh.vertices[:, :2].T).min() > 0.04


VIEW = view_of((1.0, 0.7, 0.5), (0.0, 0.0, 1.0))


def box(size=0.02, low=0.0):
    square = Rectangle(-size / 2.0, size / 2.0, -size / 2.0, size / 2.0)
    return solid_mesh(Prism(square, low, low + size))


def seen(*meshes, view=VIEW):
    turned = [Mesh(mesh.vertices @ view.T, mesh.triangles) for mesh in meshes]
    return visible_lines(turned)


def length(chains):
    return sum(float(np.linalg.norm(np.diff(chain, axis=0), axis=1).sum()) for chain in chains)


def projected(vectors):
    return [float(np.linalg.norm((VIEW @ vector)[:2])) for vector in vectors]


def test_the_view_is_a_rotation_with_up_upright():
    np.testing.assert_allclose(VIEW @ VIEW.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(VIEW) == pytest.approx(1.0)
    x, y, _ = VIEW @ [0.0, 0.0, 1.0]
    assert x == pytest.approx(0.0)
    assert y > 0.0


def test_of_a_cube_nine_edges_are_seen():
    """Three of each direction: the three that meet in the hidden corner are not."""
    (chains,) = seen(box())
    assert length(chains) == pytest.approx(3.0 * 0.02 * sum(projected(np.eye(3))), rel=0.02)


def test_what_is_behind_another_is_not_seen():
    near, far = box(), box(0.012)
    behind = Mesh(far.vertices - 0.05 * VIEW[2], far.triangles)
    front, hidden = seen(near, behind)
    assert length(front) == pytest.approx(length(seen(near)[0]))
    assert length(hidden) < 0.05 * length(front)


def test_a_cylinder_shows_its_end_and_its_sides():
    """Seen across its axis: two sides, a straight line for each end."""
    (chains,) = seen(
        solid_mesh(hollow_cylinder(0.0, 0.01, 0.0, 0.03), 64),
        view=view_of((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    )
    points = np.concatenate(chains)
    assert np.ptp(points, axis=0) == pytest.approx([0.02, 0.03], rel=0.01)


def test_the_section_of_a_tube_is_two_rectangles():
    chains = section_lines(solid_mesh(hollow_cylinder(0.01, 0.015, 0.0, 0.03), 64))
    assert len(chains) == 2
    assert length(chains) == pytest.approx(2.0 * 2.0 * (0.005 + 0.03), rel=0.01)
    for chain in chains:
        assert chain[0] == pytest.approx(chain[-1], abs=1e-7)
