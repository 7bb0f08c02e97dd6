"""Films of flights: contents, duration, and the reason where there are none."""

import subprocess
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import imageio_ffmpeg
import mujoco
import numpy as np
import pytest
from built_devices import DEVICES
from PIL import Image
from wheels import EC45, driven_device

from ocs_design.common.errors import MissingToolError
from ocs_design.device.bodies import PLATE, device_bodies
from ocs_design.export.film import Take, film_model, render_takes
from ocs_design.report import video
from ocs_design.report.video import BAD, GOOD, captioned, encode, film_if_possible
from ocs_design.requirement.turns import Drop
from ocs_design.robot.manual import robot_by_hand
from ocs_design.robot.mujoco_bodies import HIDDEN_GROUP

ROBOT = robot_by_hand(2.5, (0.03, 0.05, 0.07, 0.0, 0.0, 0.0))
UP = np.array([0.0, 0.0, 0.2])
LOW = driven_device(drive=EC45)
DEVICE = replace(LOW, modules=tuple(replace(m, position=m.position + UP) for m in LOW.modules))
"""A device above the box that stands for a robot by hand."""

DROP = Drop(name="drop", gravity=9.81, incidence=None, height=1.0, pitch=0.5)
SHADES = [np.full((44, 96, 3), 20 * k, dtype=np.uint8) for k in range(12)]


def flown(ocs, frames):
    """A run with the fields that a film needs."""
    model = film_model(ROBOT, DEVICE, ocs=ocs)
    qpos = np.tile(model.qpos0, (frames, 1))
    qpos[:, 2] = np.linspace(0.5, 0.1, frames)
    time, control_time = 0.015 * np.arange(frames), 0.005 * np.arange(3 * frames)
    speeds = np.column_stack([100.0 * control_time, -100.0 * control_time])
    series = SimpleNamespace(
        time=control_time, roll=0.0 * control_time, pitch=control_time, wheel_speed=speeds
    )
    poses = SimpleNamespace(time=time, qpos=qpos)
    return SimpleNamespace(scenario="drop", ocs=ocs, passed=ocs, poses=poses, series=series)


@pytest.fixture(scope="module")
def frames():
    """Frames with and without the device, low and high over the floor."""
    takes = []
    for ocs in (True, False):
        model = film_model(ROBOT, DEVICE, ocs=ocs)
        low, high = np.tile(model.qpos0, (2, 1))
        low[2], high[2] = 0.3, 2.0
        takes.append(Take(model, np.array([low, high])))
    try:
        return render_takes(takes)
    except MissingToolError as error:
        pytest.skip(str(error))


def test_without_the_device_its_geoms_are_hidden():
    """The plate, which belongs to no module, is hidden too."""
    device = DEVICES["on a plate"]
    for ocs in (True, False):
        model = film_model(ROBOT, device, ocs=ocs)
        bodies = [model.body(part.name).id for part in device_bodies(device)]
        shown = model.geom_group[np.isin(model.geom_bodyid, bodies)] != HIDDEN_GROUP
        assert shown.any() == ocs
        plate = model.geom_bodyid == model.body(PLATE).id
        assert (model.geom_group[plate] == HIDDEN_GROUP).all() == (not ocs)


def is_blue(frame):
    """Pixels of the housing, which alone is blue."""
    red, _, blue = (frame[..., i].astype(int) for i in range(3))
    return blue - red > 20


def test_only_one_side_shows_the_device(frames):
    with_device, without = frames
    assert is_blue(with_device[0]).sum() > 1000
    assert not is_blue(without).any()


def test_the_camera_follows_the_robot(frames):
    blue = [np.argwhere(is_blue(frame)).mean(axis=0) for frame in frames[0]]
    np.testing.assert_allclose(blue[0], blue[1], atol=3.0)
    assert np.abs(frames[0][0].astype(int) - frames[0][1]).mean() > 1.0


def test_both_models_take_the_same_positions():
    models = [film_model(ROBOT, DEVICE, ocs=ocs) for ocs in (True, False)]
    names = [[model.joint(i).name for i in range(model.njnt)] for model in models]
    assert names[0] == names[1]
    assert {"ocs_left", "ocs_right"} < set(names[0])
    floors = [model.geom("ocs_floor").type[0] for model in models]
    assert floors == [mujoco.mjtGeom.mjGEOM_PLANE] * 2


def test_captions_have_their_title_in_color():
    plain = np.full((120, 300, 3), 255, dtype=np.uint8)
    for good, color in ((True, GOOD), (False, BAD)):
        picture = captioned(plain, "title", good, ("one", "two"))
        assert picture.shape == plain.shape
        assert (picture == color).all(axis=2).any()
        written = np.flatnonzero((picture < 128).any(axis=(1, 2)))
        assert written.max() - written.min() > 80
    assert (plain == 255).all()


def test_an_mp4_has_all_frames_in_real_time(tmp_path):
    path = encode(SHADES, 0.03, tmp_path / "film")
    assert path.name == "film.mp4"
    count, seconds = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert count == len(SHADES)
    assert seconds == pytest.approx(len(SHADES) * 0.03, abs=0.01)


def failing_ffmpeg(program, **options):
    return subprocess.CompletedProcess(program, 1, b"", b"no libx264")


def hanging_ffmpeg(program, **options):
    Path(program[-1]).write_bytes(b"half a film")
    raise subprocess.TimeoutExpired(program, 300.0)


@pytest.mark.parametrize("ffmpeg", [None, failing_ffmpeg, hanging_ffmpeg])
def test_a_gif_in_real_time_where_there_is_no_mp4(tmp_path, monkeypatch, ffmpeg):
    monkeypatch.setattr(video, "ffmpeg_program", lambda: ffmpeg and "ffmpeg")
    monkeypatch.setattr(video.subprocess, "run", ffmpeg)
    path = encode(SHADES, 0.03, tmp_path / "film")
    assert [file.name for file in tmp_path.iterdir()] == ["film.gif"]
    with Image.open(path) as image:
        assert image.n_frames == len(SHADES) // 2
        assert image.info["duration"] == 60
        image.seek(3)
        shown = np.asarray(image.convert("RGB"))
    assert np.abs(shown.astype(int) - SHADES[6]).max() <= 12


def test_the_shorter_flight_waits_at_its_last_frame(tmp_path, monkeypatch):
    runs, encoded = [flown(True, 6), flown(False, 10)], {}

    def keep(pictures, seconds, stem):
        encoded.update(pictures=pictures, seconds=seconds, stem=stem)
        return stem.with_suffix(".mp4")

    def blank(takes):
        return [np.zeros((len(take.qpos), 440, 480, 3), dtype=np.uint8) for take in takes]

    monkeypatch.setattr(video, "encode", keep)
    monkeypatch.setattr(video, "render_takes", blank)
    assert film_if_possible(ROBOT, DEVICE, [DROP], runs, tmp_path) == ()
    assert len(encoded["pictures"]) == 5
    assert encoded["pictures"][0].shape == (440, 960, 3)
    assert (encoded["seconds"], encoded["stem"]) == (pytest.approx(0.03), tmp_path / "drop")
    left, right = encoded["pictures"][-1][:, :480], encoded["pictures"][-1][:, 480:]
    np.testing.assert_array_equal(left, encoded["pictures"][-2][:, :480])
    assert (right != encoded["pictures"][-2][:, 480:]).any()


def test_without_opengl_the_note_has_the_cure(tmp_path, monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "none such")
    (note,) = film_if_possible(ROBOT, DEVICE, [DROP], [flown(True, 3)], tmp_path)
    assert note.startswith("no video, because none such:")
    assert "apt install" in note
    assert not list(tmp_path.iterdir())


def test_a_gif_has_a_note(tmp_path, monkeypatch):
    monkeypatch.setattr(video, "film_flights", lambda *arguments: (tmp_path / "drop.gif",))
    (note,) = film_if_possible(ROBOT, DEVICE, [], [], tmp_path)
    assert "pip install 'ocs-design[video]'" in note
