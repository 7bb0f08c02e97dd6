"""Frames of MuJoCo models that move, seen by a camera that goes along.

A program of its own, for a process of its own: where OpenGL does not work, it may end the process.

    MUJOCO_GL=egl python -m ocs_design.export.film_frames MODEL.mjb QPOS.npy FRAMES.npy ...
"""

import sys
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.export.naming import IMU

WIDTH, HEIGHT = 480, 440
"""Of a frame [pixels]; even, as encoders want it."""

FIELD_OF_VIEW = 30.0
"""From the top to the bottom [deg]."""

AZIMUTH, ELEVATION = 125.0, -12.0
"""Of where the camera looks, as MuJoCo counts [deg]: from the right of the front, a little down."""

ROOM = 1.05
"""Around the sphere that the robot is in, as it turns over."""

SHADE, SHADE_RADIUS, ABOVE_FLOOR = (0.2, 0.2, 0.25, 0.35), 0.4, 0.02
"""Of a disc on the floor below the robot, over the radius of its sphere.

It shows how high the robot is; true shadows take ten times as long without a graphics card.
"""


def frames(model: mujoco.MjModel, qpos: FloatArray) -> NDArray[np.uint8]:
    """One for each row of `qpos`, shape (n, HEIGHT, WIDTH, 3)."""
    _prepare(model)
    data = mujoco.MjData(model)
    _pose(model, data, qpos[0])
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation = AZIMUTH, ELEVATION
    reach = _reach(model, data)
    camera.distance = ROOM * reach / np.sin(np.radians(FIELD_OF_VIEW / 2.0))
    drawn = np.empty((len(qpos), HEIGHT, WIDTH, 3), dtype=np.uint8)
    with mujoco.Renderer(model, HEIGHT, WIDTH) as renderer:
        for frame, pose in zip(drawn, qpos, strict=True):
            _pose(model, data, pose)
            camera.lookat = data.site(IMU).xpos
            renderer.update_scene(data, camera)
            _shade(renderer.scene, data.site(IMU).xpos, SHADE_RADIUS * reach)
            renderer.render(out=frame)
    return drawn


def _prepare(model: mujoco.MjModel) -> None:
    """Some light from the camera, and no true shadows."""
    view = model.vis
    view.quality.shadowsize = view.quality.offsamples = 0
    view.global_.offwidth, view.global_.offheight, view.global_.fovy = WIDTH, HEIGHT, FIELD_OF_VIEW
    view.headlight.ambient, view.headlight.diffuse = [0.35] * 3, [0.25] * 3
    view.headlight.specular = [0.0] * 3
    view.map.znear, view.map.zfar = 0.05, 100.0


def _pose(model: mujoco.MjModel, data: mujoco.MjData, qpos: FloatArray) -> None:
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)


def _shade(scene: mujoco.MjvScene, over: FloatArray, radius: float) -> None:
    """Add the disc below a point."""
    mujoco.mjv_initGeom(
        scene.geoms[scene.ngeom],
        mujoco.mjtGeom.mjGEOM_CYLINDER,
        np.array([radius, ABOVE_FLOOR * radius / 2.0, 0.0]),
        np.array([over[0], over[1], ABOVE_FLOOR * radius]),
        np.eye(3).ravel(),
        np.array(SHADE, dtype=np.float32),
    )
    scene.ngeom += 1


def _reach(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Radius of the sphere around the robot, about its base frame [m]."""
    robot = model.geom_bodyid > 0
    far = np.linalg.norm(data.geom_xpos[robot] - data.site(IMU).xpos, axis=1)
    return float(np.max(far + model.geom_rbound[robot]))


def main(arguments: list[str]) -> None:
    """Draw one film for every three paths: model, joint positions, frames."""
    for model, qpos, target in zip(*(iter(arguments),) * 3, strict=True):
        found = frames(mujoco.MjModel.from_binary_path(model), np.load(qpos))
        np.save(Path(target), found)


if __name__ == "__main__":
    main(sys.argv[1:])
