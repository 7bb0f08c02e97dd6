import numpy as np
import pytest
import trimesh

from ocs_design.common.frames import Placement
from ocs_design.export.snapshot import HEIGHT, WIDTH
from ocs_design.report.bodies import ShownBody, Surface, still_picture

RED, BLUE = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)


def body(mesh, color, at=(0.0, 0.0, 0.0)):
    surface = Surface(np.array(mesh.vertices), np.array(mesh.faces), color)
    return ShownBody("link", Placement(np.eye(3), np.array(at)), (surface,))


def not_white(image):
    return (image < 250).any(axis=2)


def test_a_ball_is_a_disc_that_fills_the_picture():
    image = still_picture([body(trimesh.creation.icosphere(subdivisions=4), RED)])
    assert image.shape == (HEIGHT, WIDTH, 3)
    width, height = (np.ptp(np.flatnonzero(not_white(image).any(axis=axis))) + 1 for axis in (0, 1))
    assert width == pytest.approx(height, abs=2)
    assert height == pytest.approx(HEIGHT / 1.06, rel=0.01)
    assert not_white(image).sum() == pytest.approx(np.pi / 4.0 * height**2, rel=0.01)


def test_a_body_in_front_hides_one_behind():
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    towards = np.array([np.cos(0.38) * np.cos(-0.65), np.cos(0.38) * np.sin(-0.65), np.sin(0.38)])
    for near, far in ((RED, BLUE), (BLUE, RED)):
        image = still_picture([body(ball, far), body(ball, near, at=2.0 * towards)])
        middle = image[HEIGHT // 2, WIDTH // 2].astype(int)
        assert np.argmax(middle) == np.argmax(near[:3])


def test_glass_is_left_out_and_an_empty_picture_is_white():
    glass = body(trimesh.creation.box(), (0.0, 0.0, 0.0, 0.3))
    assert not not_white(still_picture([glass])).any()
    assert not not_white(still_picture([])).any()
