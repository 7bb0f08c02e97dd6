"""Program that renders MuJoCo models: sheets of views, film frames, and a test of OpenGL.

It runs in a separate process, because a broken OpenGL may end the process.

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
from ocs_design.export.raster import png_bytes, view_of

FIELD_OF_VIEW = 30.0
"""Vertical field of view of perspective views [deg]."""

WIDTH, HEIGHT = 640, 480
"""Size of each view of a sheet [pixels]."""

OVERSAMPLING = 2
"""Factor by which views are rendered larger, so that edges are smooth."""

ROOM = 1.08
"""Size of a view relative to its content."""

FRAME_WIDTH, FRAME_HEIGHT = 480, 440
"""Size of a film's frame [pixels]; even, as encoders require."""

AZIMUTH, ELEVATION = 125.0, -12.0
"""Camera angles in MuJoCo's convention [deg]: from the front right, looking slightly down."""

FRAME_ROOM = 1.05
"""Size of a frame relative to the sphere in which the robot turns over."""

SHADE, SHADE_RADIUS, ABOVE_FLOOR = (0.2, 0.2, 0.25, 0.35), 0.4, 0.02
"""Disc on the floor below the robot: colour, radius over the sphere's, and height over its radius.

It shows how high the robot is; true shadows take ten times as long without a graphics card.
"""

WHITE, EDGE = 255, 40
"""Grey of the background, and of the lines around each geom."""

_SHOWN_GROUPS = 3
"""Number of geom groups, of six, that viewers show."""

Box: TypeAlias = tuple[FloatArray, FloatArray]
"""Lower and upper corner [m]."""


class View(NamedTuple):
    """Camera angles in MuJoCo's convention [deg]: azimuth from x to y, and elevation."""

    azimuth: float
    elevation: float
    perspective: bool = False


VIEWS = (
    (View(180.0, 0.0), View(90.0, 0.0)),
    (View(180.0, -90.0), View(143.0, -24.0, perspective=True)),
)
"""First-angle projection (ISO 5456-2): front view; to its right the view from the robot's right,
which is on the viewer's left; below it the top view."""


def sheet_of_views(model: mujoco.MjModel, qpos: FloatArray) -> NDArray[np.uint8]:
    """All views on one sheet, the orthographic ones to a common scale, shape (h, w, 3)."""
    view = model.vis
    # Multisampling would do the same as rendering larger, but takes longer.
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
        for shot in row:
            # On white, whatever the model's background, with a line around each geom.
            renderer.update_scene(data, _camera(model, shot, box))
            image = renderer.render()
            renderer.enable_segmentation_rendering()
            geoms = renderer.render()[:, :, 0]
            renderer.disable_segmentation_rendering()
            image[geoms < 0] = WHITE
            image[:, 1:][geoms[:, 1:] != geoms[:, :-1]] = EDGE
            image[1:][geoms[1:] != geoms[:-1]] = EDGE
            # Each pixel is the mean of its oversampled pixels.
            k = OVERSAMPLING
            total = image.reshape(HEIGHT, k, WIDTH, k, 3).sum(axis=(1, 3), dtype=np.uint16)
            images.append(np.asarray(total // k**2, dtype=np.uint8))
        rows.append(np.concatenate(images, axis=1))
    renderer.close()
    return np.concatenate(rows)


def shown_box(model: mujoco.MjModel, data: mujoco.MjData) -> Box:
    """Box around everything shown."""
    shown = model.geom_group < _SHOWN_GROUPS
    rotations = data.geom_xmat[shown].reshape(-1, 3, 3)
    boxes = model.geom_aabb[shown]
    middles = data.geom_xpos[shown] + np.einsum("nij,nj->ni", rotations, boxes[:, :3])
    halves = np.einsum("nij,nj->ni", np.abs(rotations), boxes[:, 3:])
    return np.min(middles - halves, axis=0), np.max(middles + halves, axis=0)


def _camera(model: mujoco.MjModel, view: View, box: Box) -> mujoco.MjvCamera:
    """Camera that sees the whole box; sets the height of orthographic views in the model."""
    low, high = box
    size = high - low
    camera = mujoco.MjvCamera()
    camera.lookat = (low + high) / 2.0
    camera.azimuth, camera.elevation = view.azimuth, view.elevation
    camera.orthographic = not view.perspective
    if not view.perspective:
        # An orthographic camera only has to be in front of everything.
        camera.distance = 2.0 * np.linalg.norm(size)
        # Height of a view in which each of the three views fits [m].
        x, y, z = size
        model.vis.global_.fovy = float(ROOM * max(z, x, max(x, y) * HEIGHT / WIDTH))
        return camera
    # Distance from which all corners of the box are in view.
    azimuth, elevation = np.radians([view.azimuth, view.elevation])
    c, s = np.cos(elevation), np.sin(elevation)
    eye = -c * np.cos(azimuth), -c * np.sin(azimuth), -s
    right, up, towards = view_of(eye, (0.0, 0.0, 1.0))
    corners = size / 2.0 * np.array(list(product((-1.0, 1.0), repeat=3)))
    tangent = np.tan(np.radians(FIELD_OF_VIEW / 2.0))
    sideways, upwards = np.abs(corners @ right) * HEIGHT / WIDTH, np.abs(corners @ up)
    away = ROOM * np.maximum(sideways, upwards) / tangent + corners @ towards
    camera.distance = float(np.max(away))
    model.vis.global_.fovy = FIELD_OF_VIEW
    return camera


def frames(model: mujoco.MjModel, qpos: FloatArray) -> NDArray[np.uint8]:
    """Frame for each row of `qpos` with a camera that follows, shape (n, height, width, 3)."""
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
    distances = np.linalg.norm(data.geom_xpos[robot] - data.site(IMU).xpos, axis=1)
    reach = float(np.max(distances + model.geom_rbound[robot]))
    radius = SHADE_RADIUS * reach
    camera.distance = FRAME_ROOM * reach / np.sin(np.radians(FIELD_OF_VIEW / 2.0))
    images = np.empty((len(qpos), FRAME_HEIGHT, FRAME_WIDTH, 3), dtype=np.uint8)
    with mujoco.Renderer(model, FRAME_HEIGHT, FRAME_WIDTH) as renderer:
        for frame, pose in zip(images, qpos, strict=True):
            _pose(model, data, pose)
            over = data.site(IMU).xpos
            camera.lookat = over
            renderer.update_scene(data, camera)
            # A disc on the floor below the robot represents its shadow.
            disc, kind = renderer.scene.geoms[renderer.scene.ngeom], mujoco.mjtGeom.mjGEOM_CYLINDER
            size = np.array([radius, ABOVE_FLOOR * radius / 2.0, 0.0])
            place = np.array([over[0], over[1], ABOVE_FLOOR * radius]), np.eye(3).ravel()
            mujoco.mjv_initGeom(disc, kind, size, *place, np.array(SHADE, dtype=np.float32))
            renderer.scene.ngeom += 1
            renderer.render(out=frame)
    return images


def _pose(model: mujoco.MjModel, data: mujoco.MjData, qpos: FloatArray) -> None:
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)


TRIAL = '<mujoco><worldbody><geom type="box" size="1 1 1" rgba="1 0 0 1"/></worldbody></mujoco>'


def try_opengl() -> None:
    """Render one box, and exit with an error if it is not visible."""
    model = mujoco.MjModel.from_xml_string(TRIAL)
    sheet = sheet_of_views(model, model.qpos0)
    if min(sheet[sheet.shape[0] // 4, sheet.shape[1] // 4]) == WHITE:
        sys.exit("a box was rendered but is not visible")


def main(arguments: list[str]) -> None:
    """Render one sheet or film for every three paths: model, joint positions, result."""
    what, *paths = arguments
    if what == "trial":
        try_opengl()
    for file, poses, target in zip(*(iter(paths),) * 3, strict=True):
        model, qpos = mujoco.MjModel.from_binary_path(file), np.load(poses)
        if what == "views":
            Path(target).write_bytes(png_bytes(sheet_of_views(model, qpos[0])))
        else:
            # As a stream, because given a path NumPy would append .npy.
            with Path(target).open("wb") as stream:
                np.save(stream, frames(model, qpos))


if __name__ == "__main__":
    main(sys.argv[1:])
