"""Elements of the report's page, its bodies and colours."""

import json
import re
from itertools import combinations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from pages import Page
from robots import SOLO12
from wheels import paper_device

from ocs_design.common.frames import Placement
from ocs_design.export.glb import robot_glb
from ocs_design.export.robot_model import robot_model
from ocs_design.export.templates import template_text
from ocs_design.report.bodies import ShownBody, Surface, read_bodies
from ocs_design.report.charts.chart import SERIES
from ocs_design.report.html.decimation import clustered, decimated
from ocs_design.report.html.elements import Markup, element, items, json_element, table
from ocs_design.report.table import CellTable, Tone, Toned, columns
from ocs_design.robot.reader import read_robot

UPRIGHT = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


@pytest.fixture(scope="module")
def glb(tmp_path_factory):
    robot = read_robot(SOLO12)
    path = tmp_path_factory.mktemp("glb") / "robot.glb"
    path.write_bytes(robot_glb(robot_model(robot, paper_device()).compiled, robot.posture))
    return path


def corners(bodies):
    """Corners of all triangles in B [m], shape (n, 3, 3)."""
    return np.concatenate(
        [
            (s.vertices @ body.placement.rotation.T + body.placement.position)[s.faces]
            for body in bodies
            for s in body.surfaces
        ]
    )


def test_triangles_are_those_of_trimesh(glb):
    scene = trimesh.load(glb).to_geometry()
    expected = np.sort(scene.triangles_center @ UPRIGHT, axis=0)
    centres = np.sort(corners(read_bodies(glb.read_bytes())).mean(axis=1), axis=0)
    np.testing.assert_allclose(centres, expected, atol=1e-6)


def test_bodies_have_the_names_of_the_links(glb):
    names = [body.name for body in read_bodies(glb.read_bytes())]
    assert {"base_link", "ocs_left_flywheel", "ocs_right_flywheel"} <= set(names)
    assert len(set(names)) == len(names)


GREY = (0.5, 0.5, 0.5, 1.0)


def body(mesh, name="link"):
    surface = Surface(np.array(mesh.vertices), np.array(mesh.faces), GREY)
    return ShownBody(name, Placement.identity(), (surface,))


def mesh_of(shown_body):
    (surface,) = shown_body.surfaces
    return trimesh.Trimesh(surface.vertices, surface.faces, process=False)


def triangles_of(bodies):
    return sum(len(surface.faces) for body in bodies for surface in body.surfaces)


@pytest.fixture(scope="module")
def box():
    mesh = trimesh.creation.box(extents=(0.3, 0.2, 0.1))
    for _ in range(5):
        mesh = mesh.subdivide()
    return mesh


def test_a_box_keeps_its_edges_and_its_volume(box):
    (coarse,) = decimated([body(box)], 1500)
    assert len(box.faces) > 12_000
    assert triangles_of([coarse]) <= 1500
    mesh = mesh_of(coarse)
    np.testing.assert_allclose(mesh.bounds, box.bounds, atol=1e-9)
    assert mesh.volume == pytest.approx(box.volume, rel=5e-3)


def test_a_ball_stays_round():
    fine = trimesh.creation.icosphere(subdivisions=5, radius=0.2)
    (coarse,) = decimated([body(fine)], 2000)
    radii = np.linalg.norm(mesh_of(coarse).vertices, axis=1)
    np.testing.assert_allclose(radii, 0.2, rtol=0.02)


def test_a_small_mesh_keeps_its_triangles_with_merged_vertices():
    box_mesh = trimesh.creation.box()
    separate = trimesh.Trimesh(
        box_mesh.triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3), process=False
    )
    (merged,) = decimated([body(separate)], 100)
    (surface,) = merged.surfaces
    assert (len(surface.vertices), len(surface.faces)) == (8, 12)
    assert mesh_of(merged).volume == pytest.approx(1.0, rel=1e-3)


def test_the_device_keeps_more_triangles_than_its_robot():
    ball = trimesh.creation.icosphere(subdivisions=4, radius=0.2)
    robot, device = decimated([body(ball), body(ball, "ocs_left_flywheel")], 4000)
    assert triangles_of([device]) > 3 * triangles_of([robot])


def test_no_triangle_is_degenerate_or_repeated(box):
    surface = clustered(body(box).surfaces[0], 0.013)
    assert (mesh_of(ShownBody("x", Placement.identity(), (surface,))).area_faces > 0.0).all()
    assert len(np.unique(np.sort(surface.faces, axis=1), axis=0)) == len(surface.faces)


TABLE = CellTable(columns("<name", "time [s]"), (("torque", Toned("1.2", Tone.OPEN)),))
TEXT = st.text(st.characters(exclude_categories=["Cs", "Cc"]))


@given(TEXT, TEXT)
def test_text_is_escaped_in_elements_and_attributes(text, value):
    page = Page(element("p", text, title=value, hidden=True))
    assert page.tags == ["p"]
    assert page.attributes == ([("title", value)] if value else []) + [("hidden", None)]
    for power, letter in (("²", "2"), ("³", "3")):
        text = text.replace(power, letter)
        page.texts = [part.replace(power, letter) for part in page.texts]
    assert "".join(page.texts) == text


@settings(max_examples=30)
@given(st.dictionaries(TEXT, TEXT))
def test_embedded_data_cannot_close_its_element(value):
    page = Page(json_element("design", json.dumps(value, ensure_ascii=False)))
    assert page.tags == ["script"]
    assert json.loads("".join(page.texts)) == value


def test_markup_is_not_escaped_and_units_get_superscripts():
    assert element("p", Markup("<b>x</b>"), "<b>") == "<p><b>x</b>&lt;b&gt;</p>"
    raised = element("p", "4 kg m2, 5 kg m^2, robot_m2, 3 rad/s2")
    assert raised == "<p>4 kg m², 5 kg m², robot_m2, 3 rad/s²</p>"


def test_empty_lists_are_omitted():
    assert items([]) == ""
    assert Page(items(["a", "b"])).tags == ["ul", "li", "li"]


def test_tables_have_a_caption_and_column_headers():
    page = Page(table("Margins", TABLE))
    assert " ".join(page.tags) == "div table caption thead tr th th tbody tr td td span"
    assert page.texts == ["Margins", "name", "time [s]", "torque", "1.2"]
    pairs = (("scope", "col"), ("class", "number"), ("class", "mark open"))
    assert [page.attributes.count(pair) for pair in pairs] == [2, 2, 1]


# Matrices for linear sRGB, severity 1: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A
# Physiologically-based Model for Simulation of Color Vision Deficiency", IEEE TVCG 15(6), 2009.
VISION = {
    "all cones": np.eye(3),
    "no red cones": np.array([
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ]),
    "no green cones": np.array([
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ]),
    "no blue cones": np.array([
        [1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ]),
}  # fmt: skip
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def palettes():
    """Palettes of the page by colour scheme."""
    style = template_text("report/report.css")
    blocks = re.findall(r":root \{(.*?)\}", style, re.DOTALL)[:2]
    return {
        scheme: dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", block))
        for scheme, block in zip(("light", "dark"), blocks, strict=True)
    }


def linear(color):
    """Linear intensities of an sRGB colour (IEC 61966-2-1)."""
    code = np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def lab(intensity):
    """CIE L*a*b* of linear sRGB under D65."""
    to_xyz = np.array([
        [0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ])  # fmt: skip
    ratio = to_xyz @ np.clip(intensity, 0.0, 1.0) / [0.95047, 1.0, 1.08883]
    f = np.where(ratio > 216 / 24389, np.cbrt(ratio), (24389 / 27 * ratio + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def contrast(one, other):
    """Ratio of WCAG 2.2, success criterion 1.4.3."""
    light, dark = sorted((LUMINANCE @ linear(color) for color in (one, other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("vision", VISION)
def test_curves_are_distinguishable(scheme, vision):
    palette = palettes()[scheme]
    colors = {ink: lab(VISION[vision] @ linear(palette[ink])) for ink in SERIES}
    for one, other in combinations(SERIES, 2):
        # A just noticeable difference is 2.3 (M. Mahy and others, 1994).
        assert np.linalg.norm(colors[one] - colors[other]) > 4.0 * 2.3, (one, other)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_and_curves_have_enough_contrast(scheme):
    palette = palettes()[scheme]
    for ink in ("text", "soft", "accent"):
        for background in ("paper", "page"):
            assert contrast(palette[ink], palette[background]) >= 4.5, (ink, background)
    for state in ("good", "bad", "open"):
        assert contrast(palette[state], palette[f"{state}-back"]) >= 4.5, state
    # The last two inks are for a fifth and a sixth curve, which the legend names.
    for ink in SERIES[:4]:
        assert contrast(palette[ink], palette["paper"]) >= 3.0, ink
