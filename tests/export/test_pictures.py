"""Pictures by OpenGL, errors where it is missing, and the search for ffmpeg."""

import subprocess

import imageio_ffmpeg
import mujoco
import numpy as np
import pytest
from robots import SOLO12
from wheels import paper_device

from ocs_design.common.errors import MissingToolError
from ocs_design.export import programs
from ocs_design.export.film import Take
from ocs_design.export.offscreen import HEIGHT, WIDTH, shown_box
from ocs_design.export.pictures import draw_pictures, render_views
from ocs_design.export.programs import ffmpeg_program
from ocs_design.export.raster import png_bytes
from ocs_design.export.robot_model import robot_model
from ocs_design.robot.reader import read_robot

BOX = """<mujoco><worldbody><body>
  <geom type="box" size="0.1 0.2 0.3" rgba="1 0 0 1"/>
  <geom type="sphere" size="3" group="3"/>
</body></worldbody></mujoco>"""


def box_scene():
    model = mujoco.MjModel.from_xml_string(BOX)
    return Take(model, model.qpos0[None])


def rendered(scenes):
    try:
        return render_views(scenes)
    except MissingToolError as error:
        pytest.skip(str(error))


def pixels(png):
    image = pytest.importorskip("matplotlib.image")
    from io import BytesIO

    return np.rint(255.0 * image.imread(BytesIO(png), format="png")[:, :, :3]).astype(int)


def extents(view):
    """Width and height of the part that is not white [pixels]."""
    shown = np.argwhere(np.any(view < 250, axis=2))
    height, width = np.ptp(shown, axis=0) + 1
    return width, height


def test_png_keeps_every_pixel():
    image = np.random.default_rng(0).integers(0, 256, (7, 11, 3), dtype=np.uint8)
    np.testing.assert_array_equal(pixels(png_bytes(image)), image)


@pytest.mark.slow
def test_the_three_views_are_to_one_scale_and_in_first_angle():
    sheet = pixels(rendered({"box": box_scene()})["box"])
    assert sheet.shape == (2 * HEIGHT, 2 * WIDTH, 3)
    front, side = extents(sheet[:HEIGHT, :WIDTH]), extents(sheet[:HEIGHT, WIDTH:])
    top = extents(sheet[HEIGHT:, :WIDTH])
    # Of 0.2 x 0.4 x 0.6 m: the front shows y and z, the side x and z, the view from above y and x.
    per_metre = front[1] / 0.6
    for extent, expected in ((front, (0.4, 0.6)), (side, (0.2, 0.6)), (top, (0.4, 0.2))):
        np.testing.assert_allclose(extent, np.array(expected) * per_metre, atol=3.0)
    width, height = extents(sheet[HEIGHT:, WIDTH:])
    assert max(width / WIDTH, height / HEIGHT) > 0.6


def test_the_shown_box_is_in_its_pose_and_excludes_hidden_geoms():
    model = mujoco.MjModel.from_xml_string(
        BOX.replace("<body>", '<body pos="1 2 3" euler="0 0 90">')
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    low, high = shown_box(model, data)
    np.testing.assert_allclose(low, [0.8, 1.9, 2.7], atol=1e-9)
    np.testing.assert_allclose(high, [1.2, 2.1, 3.3], atol=1e-9)


@pytest.mark.slow
def test_a_robot_with_its_device():
    robot, device = read_robot(SOLO12), paper_device()
    try:
        pictures = draw_pictures(device, robot, robot_model(robot, device))
    except MissingToolError as error:
        pytest.skip(str(error))
    # The paper's device has no carriers, so that a module is its wheel.
    assert list(pictures) == ["wheel", "robot"]
    wheel = pixels(pictures["wheel"])
    width, _ = extents(wheel[:HEIGHT, :WIDTH])
    side, height = extents(wheel[:HEIGHT, WIDTH:])
    assert side == pytest.approx(height, abs=2)
    assert width / side == pytest.approx(
        device.flywheel.height / (2.0 * device.flywheel.outer_radius), abs=0.02
    )


def test_without_opengl_the_error_has_the_reason(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "none such")
    with pytest.raises(MissingToolError, match=r"no pictures, because none such: .*invalid value"):
        render_views({"box": box_scene()})


def test_a_driver_that_crashes_or_hangs_is_an_error(monkeypatch):
    def killed(command, **options):
        return subprocess.CompletedProcess(command, -11, b"", b"")

    monkeypatch.setattr(programs.subprocess, "run", killed)
    with pytest.raises(MissingToolError, match="exit code -11"):
        render_views({"box": box_scene()})

    def hanging(command, **options):
        raise subprocess.TimeoutExpired(command, 1.0)

    monkeypatch.setattr(programs.subprocess, "run", hanging)
    with pytest.raises(MissingToolError, match="timed out"):
        render_views({"box": box_scene()})


@pytest.mark.parametrize("installed", ["system", "extra", "no binary", "nothing"])
def test_ffmpeg_of_the_system_precedes_that_of_the_extra(installed, tmp_path, monkeypatch):
    def refuse():
        raise RuntimeError("No ffmpeg exe could be found")

    program = tmp_path / "ffmpeg"
    monkeypatch.setenv("PATH", str(tmp_path))
    if installed == "system":
        program.write_text("#!/bin/sh\n")
        program.chmod(0o755)
        assert ffmpeg_program() == str(program)
    elif installed == "extra":
        process = subprocess.run([ffmpeg_program(), "-version"], capture_output=True, check=True)
        assert process.stdout.startswith(b"ffmpeg version")
    else:
        monkeypatch.setattr(imageio_ffmpeg, "get_ffmpeg_exe", refuse)
        if installed == "nothing":
            monkeypatch.setattr(programs, "find_spec", lambda name: None)
        assert ffmpeg_program() is None
