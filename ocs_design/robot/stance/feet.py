"""Where a limb would touch the ground: a ball, a sole or a wheel at its end."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.bounds import extent, extent_of, solid_shapes
from ocs_design.robot.stance.chain import Chain
from ocs_design.robot.tree import Body, JointKind, Shape, ShapeKind

ANKLED_JOINTS = 5
"""A leg with at least so many joints, its wheel not counted, can keep its sole flat."""

_BALL_SHARE = 0.25
"""Largest radius of a foot, as a share of the shank."""


@dataclass(frozen=True, eq=False)
class Foot:
    """The end of a limb.

    Attributes:
        link: that touches the ground.
        point: in the last body's frame [m], shape (3,).
        radius: of the ball or wheel around `point`; 0 for a sole or a bare point [m].
    """

    link: str
    point: FloatArray
    radius: float


def find_foot(chain: Chain, up: FloatArray) -> Foot:
    """The point of a limb that touches the ground when the limb reaches down.

    * A last body that is round about its endless joint is a wheel: the point is its centre.
    * A limb with ankles (five joints or more) has a sole, flat when all joints are at zero: the
      point is the middle of the lowest surface.
    * Else the foot is the end of the shank: its lowest collision sphere; else the farthest fixed
      link, with the shapes' reach beyond its origin as radius; else the lowest surface.

    Args:
        chain: the limb.
        up: unit vector against gravity in the chain's reference frame, shape (3,).
    """
    body = chain.bodies[-1]
    if is_wheel(body):
        return _wheel(body)
    if len(chain.driven) >= ANKLED_JOINTS:
        zero = chain.pose(np.zeros(len(chain.driven)))
        return _lowest_surface(body, -zero.end.rotation.T @ up)
    stretched = chain.pose(chain.stretched(farthest_frame(body), -up))
    return _shank_end(body, -stretched.end.rotation.T @ up)


def farthest_frame(body: Body) -> FloatArray:
    """The farthest from a body's joint of its link origins and centre of mass [m], shape (3,)."""
    points = [*(place.position for place in body.links.values()), body.mass_properties.com]
    return max(points, key=lambda point: float(point @ point))


def is_wheel(body: Body) -> bool:
    """Whether a body is round about its endless joint, with its mass on the axis."""
    joint = body.joint
    if (
        joint is None
        or joint.kind is not JointKind.REVOLUTE
        or np.isfinite(joint.upper - joint.lower)
    ):
        return False
    reaches = [extent_of(solid_shapes(body), side) for side in _across(joint.axis)]
    known = [reach for reach in reaches if reach is not None]
    if not known or min(known) <= 0.0:
        return False
    com = body.mass_properties.com
    eccentricity = np.linalg.norm(com - joint.axis * (joint.axis @ com))
    return max(known) < 1.1 * min(known) and bool(eccentricity < 0.1 * min(known))


def _across(axis: FloatArray) -> Sequence[FloatArray]:
    """Four directions across an axis, along the frame's own axes where it is one of them."""
    across = np.eye(3) - np.outer(axis, axis)
    sides = [across[i] / np.linalg.norm(across[i]) for i in np.argsort(np.abs(axis))[:2]]
    return [*sides, *(-side for side in sides)]


def _wheel(body: Body) -> Foot:
    assert body.joint is not None
    axis, com = body.joint.axis, body.mass_properties.com
    reaches = [extent_of(solid_shapes(body), side) or 0.0 for side in _across(axis)]
    return Foot(body.name, axis * (axis @ com), max(reaches))


def _shank_end(body: Body, down: FloatArray) -> Foot:
    lowest = extent_of(solid_shapes(body), down)
    balls = [s for s in body.shapes if s.kind is ShapeKind.SPHERE and s.collides]
    if balls and lowest is not None:
        ball = max(balls, key=lambda shape: float(down @ shape.position) + shape.size[0])
        if down @ ball.position + ball.size[0] > 0.95 * lowest:
            return Foot(ball.link, ball.position, ball.size[0])
    link = max(body.links, key=lambda name: float(down @ body.links[name].position))
    origin = body.links[link].position
    length = float(np.linalg.norm(origin))
    if length < 1e-3:
        return _lowest_surface(body, down)
    # Along the shank and not straight down: a mesh counts as a box, which is exact along its sides.
    beyond = (extent_of(solid_shapes(body), origin / length) or length) - length
    return Foot(link, origin, min(max(beyond, 0.0), _BALL_SHARE * length))


def _reach(shape: Shape, direction: FloatArray) -> float:
    reach = extent(shape, direction)
    return -np.inf if reach is None else reach


def _lowest_surface(body: Body, down: FloatArray) -> Foot:
    """The middle of what lies within a centimetre of the body's lowest point."""
    shapes = solid_shapes(body)
    lowest = extent_of(shapes, down)
    if lowest is None:
        link = max(body.links, key=lambda name: float(down @ body.links[name].position))
        return Foot(link, body.links[link].position, 0.0)
    # Of shapes beyond all measure a centimetre less is the same number.
    touching = [s for s in shapes if _reach(s, down) >= lowest - 0.01]
    middle = lowest * down
    for side in _across(down)[:2]:
        ahead, behind = extent_of(touching, side), extent_of(touching, -side)
        if ahead is not None and behind is not None:
            middle = middle + 0.5 * (ahead - behind) * side
    return Foot(touching[0].link, middle, 0.0)
