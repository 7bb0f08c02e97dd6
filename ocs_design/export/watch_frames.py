"""MuJoCo's viewer on robots that move as recorded, one window after the other.

A program of its own, for a process of its own: without a display GLFW ends the process, and with
one it may crash as it ends.

    python -m ocs_design.export.watch_frames SECONDS_PER_POSE MODEL.mjb QPOS.npy ...
"""

import os
import sys
import time

import mujoco
import mujoco.viewer
import numpy as np

from ocs_design.arrays import FloatArray

PAUSE = 1.0
"""Between the end of a run and its next beginning [s]."""


def watch(model: mujoco.MjModel, qpos: FloatArray, seconds: float, parent: int) -> None:
    """Play a run in real time, again and again, until the window is closed.

    Or until the command that asked for it is no more: nobody would close it for that.

    Args:
        model: see `film_model`.
        qpos: of each pose, shape (n, nq).
        seconds: from one pose to the next [s].
        parent: process that asked for it.
    """
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    quiet = {"show_left_ui": False, "show_right_ui": False}
    with mujoco.viewer.launch_passive(model, data, **quiet) as viewer:
        viewer.cam.type = mujoco.mjtCamera.mjCAMERA_TRACKING
        viewer.cam.trackbodyid = 1
        start, whole = time.monotonic(), len(qpos) * seconds + PAUSE
        while viewer.is_running() and os.getppid() == parent:
            pose = int((time.monotonic() - start) % whole / seconds)
            with viewer.lock():
                data.qpos[:] = qpos[min(pose, len(qpos) - 1)]
                data.time = pose * seconds
                mujoco.mj_forward(model, data)
            viewer.sync()
            time.sleep(seconds)


def main(arguments: list[str]) -> None:
    """One window for every two paths: model and joint positions."""
    (seconds, *paths), parent = arguments, os.getppid()
    for model, qpos in zip(*(iter(paths),) * 2, strict=True):
        watch(mujoco.MjModel.from_binary_path(model), np.load(qpos), float(seconds), parent)


if __name__ == "__main__":
    main(sys.argv[1:])
    sys.stdout.flush()
    # The viewer's own thread may still hold the display: nothing is left to tidy up.
    os._exit(0)
