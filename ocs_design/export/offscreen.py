"""Program that draws MuJoCo models: sheets of views, frames of films, and a trial of OpenGL.

It runs in a process of its own: where OpenGL does not work, it may end the process.

    MUJOCO_GL=egl python -m ocs_design.export.offscreen views MODEL.mjb QPOS.npy SHEET.png ...
    MUJOCO_GL=egl python -m ocs_design.export.offscreen frames MODEL.mjb QPOS.npy FRAMES.npy ...
    MUJOCO_GL=egl python -m ocs_design.export.offscreen trial
"""

import sys
from itertools import product
from pathlib import Path
from typing import NamedTuple, TypeAlias

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray
from ocs_design.device.bodies import IMU
from ocs_design.export.raster import png_bytes

FIELD_OF_VIEW = 30.0
"""Angle of views in perspective from the top to the bottom [deg]."""

WIDTH, HEIGHT = 640, 480
"""Size of each view of a sheet [pixels]."""

OVERSAMPLING = 2
"""Factor by which views are drawn larger, so that edges come out smooth."""

ROOM = 1.08
"""Size of a view over the size of what it shows."""

FRAME_WIDTH, FRAME_HEIGHT = 480, 440
"""Size of a film's frame [pixels]; even, as encoders want it."""

AZIMUTH, ELEVATION = 125.0, -12.0
"""Direction of the camera, as MuJoCo counts [deg]: from the right of the front, a little down."""

FRAME_ROOM = 1.05
"""Size of a frame over the sphere around the robot, in which it turns over."""

SHADE, SHADE_RADIUS, ABOVE_FLOOR = (0.2, 0.2, 0.25, 0.35), 0.4, 0.02
"""Colour of a disc on the floor below the robot, and its size over the sphere's radius.

It shows how high the robot is; true shadows take ten times as long without a graphics card.
"""

WHITE, EDGE = 255, 40
"""Grey of the background, and of the lines around each geom."""

_SHOWN_GROUPS = 3
"""Groups of geoms that viewers show, of six."""

Box: TypeAlias = tuple[FloatArray, FloatArray]
"""Lower and upper corner [m]."""


class View(NamedTuple):
    """Direction of a camera, as MuJoCo counts [deg]: from x towards y, and over the horizon."""

    azimuth: float
    elevation: float
    perspective: bool = False


VIEWS = (
    (View(180.0, 0.0), View(90.0, 0.0)),
    (View(180.0, -90.0), View(143.0, -24.0, perspective=True)),
)
"""First-angle projection (ISO 5456-2): from the front; right of it from the right of the robot,
which the viewer has at the left; below it from above."""


def sheet_of_views(model: mujoco.MjModel, qpos: FloatArray) -> NDArray[np.uint8]:
    """All views on one sheet, those with parallel rays to one scale, shape (h, w, 3)."""
    view = model.vis
    # Many samples of each pixel would do what is done by drawing larger, and take longer.
    view.quality.shadowsize = view.quality.offsamples = 0
    view.global_.offwidth, view.global_.offheight = WIDTH * OVERSAMPLING, HEIGHT * OVERSAMPLING
    # Even light from the camera.
    view.headlight.active = 1
    view.headlight.ambient, view.headlight.diffuse = [0.4] * 3, [0.45] * 3
    view.headlight.specular = [0.1] * 3
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    box = shown_box(model, data)
    renderer = mujoco.Renderer(model, HEIGHT * OVERSAMPLING, WIDTH * OVERSAMPLING)
    rows = []
    for row in VIEWS:
        images = []
        for each in row:
            # Before white, whatever the model has behind it, with a line around each geom.
            renderer.update_scene(data, _camera(model, each, box))
            image = renderer.render()
            renderer.enable_segmentation_rendering()
            geoms = renderer.render()[:, :, 0]
            renderer.disable_segmentation_rendering()
            image[geoms < 0] = WHITE
            image[:, 1:][geoms[:, 1:] != geoms[:, :-1]] = EDGE
            image[1:][geoms[1:] != geoms[:-1]] = EDGE
            # Each pixel is the mean of those that it was drawn with.
            k = OVERSAMPLING
            total = image.reshape(HEIGHT, k, WIDTH, k, 3).sum(axis=(1, 3), dtype=np.uint16)
            images.append(np.asarray(total // k**2, dtype=np.uint8))
        rows.append(np.concatenate(images, axis=1))
    renderer.close()
    return np.concatenate(rows)


def shown_box(model: mujoco.MjModel, data: mujoco.MjData) -> Box:
    """Box around all that is shown."""
    shown = model.geom_group < _SHOWN_GROUPS
    rotations = data.geom_xmat[shown].reshape(-1, 3, 3)
    boxes = model.geom_aabb[shown]
    middles = data.geom_xpos[shown] + np.einsum("nij,nj->ni", rotations, boxes[:, :3])
    halves = np.einsum("nij,nj->ni", np.abs(rotations), boxes[:, 3:])
    return np.min(middles - halves, axis=0), np.max(middles + halves, axis=0)


def _camera(model: mujoco.MjModel, view: View, box: Box) -> mujoco.MjvCamera:
    """Camera that sees the whole box; the model's own setting is the height that it sees."""
    low, high = box
    size = high - low
    camera = mujoco.MjvCamera()
    camera.lookat = (low + high) / 2.0
    camera.azimuth, camera.elevation = view.azimuth, view.elevation
    camera.orthographic = not view.perspective
    if not view.perspective:
        # Parallel rays only have to begin in front of everything.
        camera.distance = 2.0 * np.linalg.norm(size)
        # Height of a view in which each of the three fits [m].
        x, y, z = size
        model.vis.global_.fovy = float(ROOM * max(z, x, max(x, y) * HEIGHT / WIDTH))
        return camera
    # From where all corners of the box are within the view.
    azimuth, elevation = np.radians([view.azimuth, view.elevation])
    right = np.array([np.sin(azimuth), -np.cos(azimuth), 0.0])
    level = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    forward = np.cos(elevation) * level + np.sin(elevation) * np.array([0.0, 0.0, 1.0])
    corners = size / 2.0 * np.array(list(product((-1.0, 1.0), repeat=3)))
    tangent = np.tan(np.radians(FIELD_OF_VIEW / 2.0))
    sideways = np.abs(corners @ right) * HEIGHT / WIDTH
    upwards = np.abs(corners @ np.cross(right, forward))
    away = ROOM * np.maximum(sideways, upwards) / tangent - corners @ forward
    camera.distance = float(np.max(away))
    model.vis.global_.fovy = FIELD_OF_VIEW
    return camera


def frames(model: mujoco.MjModel, qpos: FloatArray) -> NDArray[np.uint8]:
    """Frame of each row of `qpos`, the camera going along, shape (n, height, width, 3)."""
    view = model.vis
    view.quality.shadowsize = view.quality.offsamples = 0
    view.global_.offwidth, view.global_.offheight = FRAME_WIDTH, FRAME_HEIGHT
    view.global_.fovy = FIELD_OF_VIEW
    view.headlight.ambient, view.headlight.diffuse = [0.35] * 3, [0.25] * 3
    view.headlight.specular = [0.0] * 3
    view.map.znear, view.map.zfar = 0.05, 100.0
    data = mujoco.MjData(model)
    _pose(model, data, qpos[0])
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation = AZIMUTH, ELEVATION
    # Radius of the sphere around the robot, about its base frame [m].
    robot = model.geom_bodyid > 0
    far = np.linalg.norm(data.geom_xpos[robot] - data.site(IMU).xpos, axis=1)
    reach = float(np.max(far + model.geom_rbound[robot]))
    radius = SHADE_RADIUS * reach
    camera.distance = FRAME_ROOM * reach / np.sin(np.radians(FIELD_OF_VIEW / 2.0))
    drawn = np.empty((len(qpos), FRAME_HEIGHT, FRAME_WIDTH, 3), dtype=np.uint8)
    with mujoco.Renderer(model, FRAME_HEIGHT, FRAME_WIDTH) as renderer:
        for frame, pose in zip(drawn, qpos, strict=True):
            _pose(model, data, pose)
            over = data.site(IMU).xpos
            camera.lookat = over
            renderer.update_scene(data, camera)
            # A disc on the floor below the robot stands for its shadow.
            mujoco.mjv_initGeom(
                renderer.scene.geoms[renderer.scene.ngeom],
                mujoco.mjtGeom.mjGEOM_CYLINDER,
                np.array([radius, ABOVE_FLOOR * radius / 2.0, 0.0]),
                np.array([over[0], over[1], ABOVE_FLOOR * radius]),
                np.eye(3).ravel(),
                np.array(SHADE, dtype=np.float32),
            )
            renderer.scene.ngeom += 1
            renderer.render(out=frame)
    return drawn


def _pose(model: mujoco.MjModel, data: mujoco.MjData, qpos: FloatArray) -> None:
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)


TRIAL = '<mujoco><worldbody><geom type="box" size="1 1 1" rgba="1 0 0 1"/></worldbody></mujoco>'


def try_opengl() -> None:
    """Draw one box, and end with an error if it is not to be seen."""
    model = mujoco.MjModel.from_xml_string(TRIAL)
    sheet = sheet_of_views(model, model.qpos0)
    if min(sheet[sheet.shape[0] // 4, sheet.shape[1] // 4]) == WHITE:
        sys.exit("a box was rendered but is not visible")


def main(arguments: list[str]) -> None:
    """Draw one sheet or film for every three paths: model, joint positions, result."""
    what, *paths = arguments
    if what == "trial":
        try_opengl()
    for file, poses, target in zip(*(iter(paths),) * 3, strict=True):
        model, qpos = mujoco.MjModel.from_binary_path(file), np.load(poses)
        if what == "views":
            Path(target).write_bytes(png_bytes(sheet_of_views(model, qpos[0])))
        else:
            # By its name, the file would be called .npy.
            with Path(target).open("wb") as stream:
                np.save(stream, frames(model, qpos))


if __name__ == "__main__":
    main(sys.argv[1:])
