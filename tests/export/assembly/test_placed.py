"""Line art, and pieces in their places."""

from dataclasses import replace

import numpy as np
import pytest
from built_devices import DEVICES, device_in_layout
from manifold3d import Manifold, Mesh64

from ocs_design.device.layout import Layout, LayoutName
from ocs_design.export.assembly.placed import module_pieces, placed_parts
from ocs_design.export.assembly.views import section_lines, visible_lines
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
def test_pieces_and_screws_have_the_mass_of_the_carrier(name):
    """All fixed parts; the rotating parts, sized without their holes, are left out."""
    device = DEVICES[name]
    rotating = {"flywheel", "rim", "hub"}
    pieces = sum(
        part.mass_properties().mass
        for name, (part, _) in placed_parts(device).items()
        if name not in rotating
    )
    screws = sum(screwed.fastening.mass for screwed in device.mount.screwed)
    screws += LID_SCREWS.mass + trunk_screws(device.foot_plate).mass
    assert pieces + screws == pytest.approx(device.carrier.mass, rel=1e-9)


def test_tilted_modules_have_the_screws_of_their_feet():
    """They have no holes in the drilling template, but a booklet."""
    device = device_in_layout(Layout(LayoutName.PYRAMID))
    assert not foot_holes(device)
    (feet,) = (
        piece
        for piece in module_pieces(device)
        if piece.fastening == trunk_screws(device.foot_plate)
    )
    assert feet.modules == len(device.modules)


def test_a_gear_has_a_wheel_on_each_axis():
    placed = placed_parts(DEVICES["gear"])
    assert {"gear", "gear_2", "motor"} <= set(placed)
    heights = [placed[name][1].position[1] for name in ("gear", "gear_2")]
    assert heights == pytest.approx([0.0, -0.03])
    gears = sum(placed[name][0].mass_properties().mass for name in ("gear", "gear_2"))
    assert gears == pytest.approx(0.02)


def _overlap(a, b):
    """Volume that two pieces share [m^3]."""
    first, second = (
        Manifold(Mesh64(piece.mesh.vertices, piece.mesh.triangles.astype(np.uint64)))
        for piece in (a, b)
    )
    return float((first ^ second).volume())


@pytest.mark.parametrize("name", BUILT)
def test_screws_overlap_only_the_part_with_their_thread(name):
    """The overlap is with one piece, over the length beyond the clamped parts. A head within a part
    or a tip in two parts would overlap more."""
    pieces = module_pieces(DEVICES[name])
    for screw in (piece for piece in pieces if piece.fastening is not None):
        fastening = screw.fastening
        shared = [_overlap(screw, piece) for piece in pieces if piece.fastening is None]
        in_thread = fastening.length - fastening.thickness
        limit = fastening.count * np.pi / 4.0 * fastening.screw.diameter**2 * in_thread
        assert sum(volume > 1e-12 for volume in shared) <= 1, fastening.purpose
        assert max(shared) <= limit * (1.0 + 1e-6), fastening.purpose


def test_the_shaft_fills_the_hub_that_is_bonded_on_it():
    parts = placed_parts(DEVICES["by its face"])
    (body, shaft), place = parts["motor"][0].joined, parts["motor"][1]
    wheel = DEVICES["by its face"].flywheel
    assert place.position == pytest.approx(0.0)
    assert shaft.profile[:, 0].max() == pytest.approx(wheel.web.hub.bore_radius, rel=1e-6)
    assert shaft.profile[:, 1].min() == pytest.approx(body.profile[:, 1].max())
    assert shaft.profile[:, 1].max() == pytest.approx(wheel.web.hub.height / 2.0)


@pytest.mark.parametrize("length", [0.003, 0.009, 0.05])
def test_a_shaft_is_cut_where_it_would_run_into_the_lid(length):
    """A shaft of any length is clear of the lid, and a cut one still fills the hub."""
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
    notes = [note for note in drive_notes(device) if "run into the lid" in note]
    if front + length <= lid - CLEARANCE:
        assert cut == pytest.approx(0.0, abs=1e-9)
        assert not notes
    else:
        assert tip == pytest.approx(hub)
        (note,) = notes
        assert f"cut {1e3 * cut:.3g} mm off" in note


def test_heads_of_screws_are_on_the_clamped_part():
    """Screws of the lid: the tips are in the drum, the heads above the lid."""
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


def visible_in(*meshes, view=VIEW):
    rotated = [Mesh(mesh.vertices @ view.T, mesh.triangles) for mesh in meshes]
    return visible_lines(rotated)


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


def test_nine_edges_of_a_cube_are_visible():
    """Three of each direction; those that meet in the hidden corner are not visible."""
    (chains,) = visible_in(box())
    assert length(chains) == pytest.approx(3.0 * 0.02 * sum(projected(np.eye(3))), rel=0.02)


def test_a_part_behind_another_is_hidden():
    near, far = box(), box(0.012)
    behind = Mesh(far.vertices - 0.05 * VIEW[2], far.triangles)
    front, hidden = visible_in(near, behind)
    assert length(front) == pytest.approx(length(visible_in(near)[0]))
    assert length(hidden) < 0.05 * length(front)


def test_a_cylinder_shows_its_end_and_its_sides():
    """In a side view: two sides and a straight line for each end."""
    (chains,) = visible_in(
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
