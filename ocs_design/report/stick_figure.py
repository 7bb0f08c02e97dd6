"""Recognised structure of a robot drawn from three sides: an SVG of lines, boxes and names."""

from collections.abc import Iterator, Mapping, Sequence
from html import escape

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.robot.leg_geometry import up_axis
from ocs_design.robot.meshes import extent_of, solid_shapes
from ocs_design.robot.robot import Leg, Robot

_VIEW_SIZE = 300.0
"""Width and height of one view [px]."""

_MARGIN = 34.0
_NAME_SIZE, _LETTER_WIDTH, _LINE_HEIGHT = 10, 7.0, 11.0
"""Size of the names of feet, largest mean width of a letter, and height of a line [px]."""

_COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a6d00", "#6a3d9a")
"""Colours of the legs; they differ for most eyes (Okabe and Ito 2008), and each foot is named."""

_VIEWS = (
    ("from the right", (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ("from the front", (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ("from above", (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
)
"""Name, direction to the right and direction up the page of each view, in B."""


def stick_figure(robot: Robot, legs: Sequence[Leg], lines: Sequence[str]) -> str:
    """SVG of a robot in its posture, from the right, the front and above, with lines of text below.

    The trunk is a box and every other body a line to its parent. The legs, recognised or most
    likely, are coloured and their feet named.
    """
    places = robot.tree.placements_from(robot.trunk, robot.posture)
    feet = {leg.name: places[leg.body].point(leg.foot) for leg in legs}
    # Corners of the box around the trunk's shapes along B's axes; none without shapes.
    index = robot.tree.body_of_link[robot.trunk]
    place, shapes = places[index], solid_shapes(robot.tree.bodies[index])
    corners: list[FloatArray] = []
    reaches = [
        reach + float(side @ place.position)
        for side in np.vstack([np.eye(3), -np.eye(3)])
        if (reach := extent_of(shapes, place.rotation.T @ side)) is not None
    ]
    if len(reaches) == 6:
        limits = np.array([[-reaches[axis + 3], reaches[axis]] for axis in range(3)])
        corners += list(np.stack(np.meshgrid(*limits), axis=-1).reshape(-1, 3))
    points = np.array([*(place.position for place in places), *feet.values(), *corners])
    low, high = points.min(axis=0), points.max(axis=0)
    scale = (_VIEW_SIZE - 2.0 * _MARGIN) / max(float((high - low).max()), 1e-9)
    width = _MARGIN + len(_VIEWS) * (_VIEW_SIZE + _MARGIN)
    height = 2.0 * _MARGIN + _VIEW_SIZE + 18.0 * len(lines)
    elements: list[str] = []
    for index, (name, right, up) in enumerate(_VIEWS):
        left = _MARGIN + index * (_VIEW_SIZE + _MARGIN)
        # Axes of B on the page, right and down [px/m], shape (2, 3), and its origin [px].
        axes = scale * np.array([right, -np.array(up)])
        origin = np.array([left, _MARGIN]) + 0.5 * _VIEW_SIZE - axes @ (0.5 * (low + high))
        elements.append(_text(left, _MARGIN - 10.0, name, size=14))
        elements += _view_elements(origin, axes, robot, legs, feet=feet, corners=corners)
    for row, line in enumerate(lines):
        elements.append(_text(_MARGIN, 2.0 * _MARGIN + _VIEW_SIZE + 18.0 * row, line, size=13))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" height="{height:.0f}" font-family="sans-serif">\n'
        f"<title>{escape(robot.name)}</title>\n"
        f'<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(elements) + "\n</svg>\n"
    )


def _view_elements(
    origin: FloatArray,
    axes: FloatArray,
    robot: Robot,
    legs: Sequence[Leg],
    *,
    feet: Mapping[str, FloatArray],
    corners: Sequence[FloatArray],
) -> Iterator[str]:
    """Elements of one view: `feet` by the names of their legs and `corners` of the trunk, in B."""
    places = robot.tree.placements_from(robot.trunk, robot.posture)
    joints = [origin + axes @ place.position for place in places]
    if corners:
        pixels = origin + np.array(corners) @ axes.T
        (x, y), (right, bottom) = pixels.min(axis=0), pixels.max(axis=0)
        yield (
            f'<rect x="{x:.1f}" y="{y:.1f}" width="{right - x:.1f}" height="{bottom - y:.1f}" '
            f'fill="#dddddd" stroke="#555555"/>'
        )
    color_by_body = {}
    for number, leg in enumerate(legs):
        place = leg.body
        while place not in (leg.base, -1):
            color_by_body[place] = _COLORS[number % len(_COLORS)]
            place = robot.tree.bodies[place].parent
    for index, body in enumerate(robot.tree.bodies):
        if body.parent >= 0:
            width = 3.0 if index in color_by_body else 1.5
            yield _line(
                joints[body.parent], joints[index], color_by_body.get(index, "#999999"), width
            )
    names: list[tuple[float, float, float]] = []
    for number, leg in enumerate(legs):
        foot, color = origin + axes @ feet[leg.name], _COLORS[number % len(_COLORS)]
        radius = max(3.5, float(np.abs(axes).max()) * leg.foot_radius)
        yield _line(joints[leg.body], foot, color, 3.0)
        yield (
            f'<circle cx="{foot[0]:.1f}" cy="{foot[1]:.1f}" r="{radius:.1f}" fill="{color}" '
            f'fill-opacity="0.5" stroke="{color}"/>'
        )
        # Names of feet that lie behind each other would overlap.
        x, y, width = float(foot[0]) + 5.0, float(foot[1]) + 12.0, _LETTER_WIDTH * len(leg.name)
        while any(
            abs(y - other_y) < _LINE_HEIGHT and start < x + width and x < start + other_width
            for start, other_y, other_width in names
        ):
            y += _LINE_HEIGHT
        names.append((x, y, width))
        yield _text(x, y, leg.name, size=_NAME_SIZE, fill=color)
    # Arrows from the trunk's origin: forward, left and up.
    up = up_axis(robot.tree, robot.trunk, legs) if legs else np.array([0.0, 0.0, 1.0])
    for name, axis in {"forward": np.eye(3)[0], "left": np.eye(3)[1], "up": up}.items():
        direction = axes @ axis / np.abs(axes).max()
        if np.linalg.norm(direction) < 0.5:
            continue
        end, normal = origin + 46.0 * direction, np.array([-direction[1], direction[0]])
        yield _line(origin, end, "black", 1.5)
        tip = [end, end - 8.0 * direction + 4.0 * normal, end - 8.0 * direction - 4.0 * normal]
        yield f'<polygon points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in tip)}"/>'
        yield _text(end[0] + 4.0, end[1] - 4.0, name, size=11)


def _line(start: FloatArray, end: FloatArray, color: str, width: float) -> str:
    return (
        f'<line x1="{start[0]:.1f}" y1="{start[1]:.1f}" x2="{end[0]:.1f}" y2="{end[1]:.1f}" '
        f'stroke="{color}" stroke-width="{width}" stroke-linecap="round"/>'
    )


def _text(x: float, y: float, text: str, *, size: int, fill: str = "black") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{fill}">{escape(text)}</text>'
