"""MuJoCo's viewer on a display, and the error where there is none."""

import os
import shutil
import subprocess
import sys

import mujoco
import numpy as np
import pytest
from commands import run

from ocs_design.common.errors import MissingToolError
from ocs_design.export import watching
from ocs_design.export.film import Take
from ocs_design.export.watching import watch_takes

BALL = """<mujoco><worldbody><geom type="plane" size="1 1 .1"/>
<body><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""


@pytest.fixture
def take():
    model = mujoco.MjModel.from_xml_string(BALL)
    return Take(model, np.tile(model.qpos0, (3, 1)) + np.linspace(0.0, 1.0, 3)[:, None])


@pytest.fixture
def no_display(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a display")
def test_without_a_display_the_command_stops_before_any_flight(no_display):
    result = run("validate", "nowhere", "--view")
    assert result.code == 5
    assert "needs a display" in result.output
    assert "apt install xvfb" in result.output


@pytest.mark.slow
def test_a_missing_display_is_an_error(take, monkeypatch):
    monkeypatch.setenv("DISPLAY", ":9999")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(MissingToolError, match="could not initialize GLFW"):
        watch_takes([take], 0.01)


def test_every_take_is_passed_to_the_viewer_process(take, monkeypatch):
    """A fake process reads the files that the viewer would read."""
    commands: list[list[str]] = []

    def fake(command, **options):
        commands.append(command)
        assert options["env"]["MUJOCO_GL"] == "glfw"
        for model, qpos in zip(command[4::2], command[5::2], strict=True):
            assert mujoco.MjModel.from_binary_path(model).nq == np.load(qpos).shape[1] == 7
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(watching.subprocess, "run", fake)
    watch_takes([take, take], 0.25)
    assert commands[0][2:4] == ["ocs_design.export.watching", "0.25"]
    assert len(commands[0]) == 8


CLOSES = """
import sys, threading
import mujoco, mujoco.viewer
from ocs_design.export import watching
seen, launch = [], mujoco.viewer.launch_passive
def launched(model, data, **options):
    handle = launch(model, data, **options)
    def end():
        seen.append(float(data.qpos[2]))
        handle.close()
    threading.Timer(1.5, end).start()
    return handle
mujoco.viewer.launch_passive = launched
watching.main(sys.argv[1:])
print("seen", seen, flush=True)
import os
os._exit(0)
"""


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("xvfb-run") is None, reason="Xvfb is not installed")
def test_a_window_opens_and_plays_until_it_is_closed(take, tmp_path):
    files = watching.written_take(take, tmp_path / "take")
    command = ["xvfb-run", "-a", sys.executable, "-c", CLOSES, "0.05", *map(str, files)]
    environment = {**os.environ, "MUJOCO_GL": "glfw"}
    process = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert process.returncode == 0, process.stderr
    assert "seen [1.0]" in process.stdout
