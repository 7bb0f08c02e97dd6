"""Three views and one in perspective of a MuJoCo model, on one sheet.

A program of its own, for a process of its own: where OpenGL does not work, it may end the process.

    MUJOCO_GL=egl python -m ocs_design.export.camera_views MODEL.mjb QPOS.npy SHEET.png ...
"""

import sys
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TypeAlias

import mujoco
import numpy as np
from numpy.typing import NDArray

from ocs_design.arrays import FloatArray
from ocs_design.export.png import png_bytes

WIDTH, HEIGHT = 640, 480
"""Of each view [pixels]."""

OVERSAMPLING = 2
"""Drawn that much larger, so that edges come out smooth."""

ROOM = 1.08
"""Around what is drawn."""

FIELD_OF_VIEW = 30.0
"""Of the view in perspective, from the top to the bottom [deg]."""

WHITE, EDGE = 255, 40
"""Of what is behind, and of lines around what is not."""

_SHOWN_GROUPS = 3
"""Groups of geoms that viewers show, of six."""


Box: TypeAlias = tuple[FloatArray, FloatArray]
"""Lower and upper corner [m]."""


@dataclass(frozen=True)
class View:
    """Where a camera looks, as MuJoCo counts [deg].

    Attributes:
        azimuth: of where it looks, from x towards y. elevation: of that over the horizon.
        perspective: or parallel rays.
    """

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
    """All views, those with parallel rays to one scale."""
    _light(model)
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    box = shown_box(model, data)
    renderer = mujoco.Renderer(model, HEIGHT * OVERSAMPLING, WIDTH * OVERSAMPLING)
    rows = [[_image(renderer, data, _camera(model, view, box)) for view in row] for row in VIEWS]
    renderer.close()
    return np.concatenate([np.concatenate(row, axis=1) for row in rows])


def _light(model: mujoco.MjModel) -> None:
    """Even light from the camera, no shadows, and a canvas that is large enough."""
    view = model.vis
    # Many samples of each pixel would do what is done by drawing larger, and take longer.
    view.quality.shadowsize = view.quality.offsamples = 0
    view.global_.offwidth, view.global_.offheight = WIDTH * OVERSAMPLING, HEIGHT * OVERSAMPLING
    view.headlight.active = 1
    view.headlight.ambient, view.headlight.diffuse = [0.4] * 3, [0.45] * 3
    view.headlight.specular = [0.1] * 3


def shown_box(model: mujoco.MjModel, data: mujoco.MjData) -> Box:
    """Around all that is shown."""
    shown = model.geom_group < _SHOWN_GROUPS
    rotations = data.geom_xmat[shown].reshape(-1, 3, 3)
    boxes = model.geom_aabb[shown]
    middles = data.geom_xpos[shown] + np.einsum("nij,nj->ni", rotations, boxes[:, :3])
    halves = np.einsum("nij,nj->ni", np.abs(rotations), boxes[:, 3:])
    return np.min(middles - halves, axis=0), np.max(middles + halves, axis=0)


def _camera(model: mujoco.MjModel, view: View, box: Box) -> mujoco.MjvCamera:
    """That sees the whole box; the height of what it sees is the model's own setting."""
    low, high = box
    size = high - low
    camera = mujoco.MjvCamera()
    camera.lookat = (low + high) / 2.0
    camera.azimuth, camera.elevation = view.azimuth, view.elevation
    camera.orthographic = not view.perspective
    # Parallel rays only have to begin in front of everything.
    camera.distance = _distance(view, size) if view.perspective else 2.0 * np.linalg.norm(size)
    model.vis.global_.fovy = FIELD_OF_VIEW if view.perspective else _span(size)
    return camera


def _image(
    renderer: mujoco.Renderer, data: mujoco.MjData, camera: mujoco.MjvCamera
) -> NDArray[np.uint8]:
    """Before white, whatever the model has behind it, with a line around each geom."""
    renderer.update_scene(data, camera)
    image = renderer.render()
    renderer.enable_segmentation_rendering()
    geoms = renderer.render()[:, :, 0]
    renderer.disable_segmentation_rendering()
    image[geoms < 0] = WHITE
    image[:, 1:][geoms[:, 1:] != geoms[:, :-1]] = EDGE
    image[1:][geoms[1:] != geoms[:-1]] = EDGE
    return _reduced(image)


def _span(size: FloatArray) -> float:
    """Height of a view in which each of the three fits [m]."""
    x, y, z = size
    wide, tall = max(x, y), max(z, x)
    return float(ROOM * max(tall, wide * HEIGHT / WIDTH))


def _distance(view: View, size: FloatArray) -> float:
    """From which all corners of the box are within the view [m]."""
    azimuth, elevation = np.radians([view.azimuth, view.elevation])
    right = np.array([np.sin(azimuth), -np.cos(azimuth), 0.0])
    level = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    forward = np.cos(elevation) * level + np.sin(elevation) * np.array([0.0, 0.0, 1.0])
    corners = size / 2.0 * np.array(list(product((-1.0, 1.0), repeat=3)))
    tangent = np.tan(np.radians(FIELD_OF_VIEW / 2.0))
    sideways = np.abs(corners @ right) * HEIGHT / WIDTH
    upwards = np.abs(corners @ np.cross(right, forward))
    return float(np.max(ROOM * np.maximum(sideways, upwards) / tangent - corners @ forward))


def _reduced(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Each pixel the mean of those that it was drawn with."""
    k = OVERSAMPLING
    total = np.zeros((HEIGHT, WIDTH, 3), dtype=np.uint16)
    for row, column in product(range(k), repeat=2):
        total += image[row::k, column::k]
    return np.asarray(total // k**2, dtype=np.uint8)


def main(arguments: list[str]) -> None:
    """Draw one sheet for every three paths: model, joint positions, picture."""
    for model, qpos, sheet in zip(*(iter(arguments),) * 3, strict=True):
        image = sheet_of_views(mujoco.MjModel.from_binary_path(model), np.load(qpos))
        Path(sheet).write_bytes(png_bytes(image))


if __name__ == "__main__":
    main(sys.argv[1:])
