"""Legs of any legged robot: feet, the plane in which each leg bends, and links of bodies."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen
from ocs_design.common.frames import Placement
from ocs_design.robot.chain import Chain, chain_of, nearest_turn
from ocs_design.robot.meshes import extent, extent_of, solid_shapes
from ocs_design.robot.robot import Leg
from ocs_design.robot.tree import Body, JointKind, ShapeKind, Tree

ANKLED_JOINTS = 5
"""Least number of joints, without a wheel's, of a leg that can keep its sole flat."""

_BALL_SHARE = 0.25
"""Largest radius of a foot, as a share of the shank."""


LimbEnd: TypeAlias = tuple[str, FloatArray, float]
"""The link at the end of a limb that touches the ground; the point that does, in the last body's
frame [m], shape (3,); and the radius of a ball or wheel around it, 0 for a sole or a bare point."""


def find_foot(chain: Chain, up: FloatArray) -> LimbEnd:
    """The point of a limb that touches the ground when it reaches down.

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
    if body.joint is not None and is_wheel(body):
        axis, com = body.joint.axis, body.mass_properties.com
        reaches = [extent_of(solid_shapes(body), side) or 0.0 for side in _across(axis)]
        return body.name, axis * (axis @ com), max(reaches)
    if len(chain.driven) >= ANKLED_JOINTS:
        zero = chain.pose(np.zeros(len(chain.driven)))
        return _lowest_surface(body, -zero.end.rotation.T @ up)
    stretched = chain.pose(chain.stretched(farthest_frame(body), -up))
    down = -stretched.end.rotation.T @ up
    lowest = extent_of(solid_shapes(body), down)
    balls = [s for s in body.shapes if s.kind is ShapeKind.SPHERE and s.collides]
    if balls and lowest is not None:
        ball = max(balls, key=lambda shape: float(down @ shape.position) + shape.size[0])
        if down @ ball.position + ball.size[0] > 0.95 * lowest:
            return ball.link, ball.position, ball.size[0]
    link = max(body.links, key=lambda name: float(down @ body.links[name].position))
    origin = body.links[link].position
    length = float(np.linalg.norm(origin))
    if length < 1e-3:
        return _lowest_surface(body, down)
    # Along the shank, not straight down: a mesh counts as a box, which is exact along its sides.
    beyond = (extent_of(solid_shapes(body), origin / length) or length) - length
    return link, origin, min(max(beyond, 0.0), _BALL_SHARE * length)


def farthest_frame(body: Body) -> FloatArray:
    """The link origin or centre of mass farthest from a body's joint [m], shape (3,)."""
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


def _lowest_surface(body: Body, down: FloatArray) -> LimbEnd:
    """Middle of the surfaces within a centimetre of the body's lowest point."""
    shapes = solid_shapes(body)
    lowest = extent_of(shapes, down)
    if lowest is None:
        link = max(body.links, key=lambda name: float(down @ body.links[name].position))
        return link, body.links[link].position, 0.0
    # For huge shapes, subtracting a centimetre does not change the number.
    reaches = ((shape, extent(shape, down)) for shape in shapes)
    touching = [shape for shape, reach in reaches if reach is not None and reach >= lowest - 0.01]
    middle = lowest * down
    for side in _across(down)[:2]:
        ahead, behind = extent_of(touching, side), extent_of(touching, -side)
        if ahead is not None and behind is not None:
            middle = middle + 0.5 * (ahead - behind) * side
    # A sole of several links, such as a sensor in each corner, is named after its body.
    links = {shape.link for shape in touching}
    return links.pop() if len(links) == 1 else body.name, middle, 0.0


PARALLEL = 0.97
"""Joint axes whose unit vectors have at least this product count as parallel (14 degrees)."""


@dataclass(frozen=True, eq=False)
class LegPlane:
    """Geometry of a leg with its joints at zero and its hip level, in the chain's reference frame.

    Attributes:
        pitch: columns of the driven joints whose axes are parallel and bend the leg, hip first.
        axis: unit vector along them, shape (3,).
        hip: where the plane through the foot, across `axis`, meets the hip's axis [m], shape (3,).
        forward: unit vector in the plane, level, with its largest component positive, shape (3,).
        columns: columns of the driven joints that place the foot: all but a wheel's.
        flat: whether the leg has ankles that can keep its sole level.
        length: of the stretched leg within its limits, hip to foot [m]; 0 if it has only slides.
        level: values of the driven joints [rad or m]: zero, but for a roll that makes `axis` level.
    """

    pitch: tuple[int, ...]
    axis: FloatArray
    hip: FloatArray
    forward: FloatArray
    columns: tuple[int, ...]
    flat: bool
    length: float
    level: FloatArray


def leg_plane(chain: Chain, foot: FloatArray, up: FloatArray) -> LegPlane:
    """Plane in which a leg bends.

    The joints that bend a leg (hip pitch, knee and, in legs with ankles, ankle pitch) have parallel
    axes when all joints are at zero: the largest such set, without a wheel.

    Args:
        chain: the leg.
        foot: its foot in the last body's frame [m], shape (3,).
        up: unit vector against gravity in the chain's reference frame, shape (3,).
    """
    count = len(chain.driven)
    columns = tuple(range(count - 1 if is_wheel(chain.bodies[-1]) else count))
    zero = chain.pose(np.zeros(count))
    # The largest set of parallel hinges; of equal sets, the one spread widest.
    sets = []
    rows = {column: chain.driven[column] for column in columns}
    hinges = [c for c in columns if chain.joints[rows[c]].kind is JointKind.REVOLUTE]
    for column in columns:
        axis = zero.axes[rows[column]]
        parallel = tuple(c for c in hinges if abs(zero.axes[rows[c]] @ axis) > PARALLEL)
        if parallel and abs(axis @ up) < PARALLEL:
            spread = np.ptp([up @ zero.origins[rows[c]] for c in parallel])
            sets.append((len(parallel), float(spread), parallel))
    pitch = max(sets)[2] if sets else (columns[0],)
    flat = len(columns) >= ANKLED_JOINTS
    row = chain.driven[pitch[0]]
    level = _levelled(chain, row, up)
    pose = chain.pose(level)
    axis, origin = pose.axes[row], pose.origins[row]
    hip = origin + axis * (axis @ (pose.point(foot) - origin))
    length = 0.0
    if chain.joints[row].kind is not JointKind.PRISMATIC:
        bending = pitch[:2] if flat else pitch
        stretched = chain.pose(chain.stretched(foot, -up, bending, start=level))
        length = float(up @ (hip - stretched.point(foot)))
    forward = np.cross(axis, up)
    norm = float(np.linalg.norm(forward))
    if norm < 1e-9:
        forward = np.zeros(3)
    else:
        forward = np.sign(forward[np.argmax(np.abs(forward))]) * forward / norm
    return LegPlane(pitch, axis, hip, forward, columns, flat, length, level)


_LEVEL = 1e-3
"""Largest product of a level axis and the vertical: public robots' hips are level to 1e-16."""


def _levelled(chain: Chain, row: int, up: FloatArray) -> FloatArray:
    """Driven joints at zero [rad or m], except the one that turns the axis of joint `row` level.

    Robots whose legs are spread at zero stand like those whose legs are straight: their length and
    what is below the hip do not depend on where an encoder has its zero. The joint is the nearest
    before it that can, turned by the smaller angle; none, if the limits forbid it.
    """
    values = np.zeros(len(chain.driven))
    zero = chain.pose(values)
    axis = zero.axes[row]
    if abs(axis @ up) < _LEVEL:
        return values
    for column in reversed([c for c, other in enumerate(chain.driven) if other < row]):
        joint, turned = chain.joints[chain.driven[column]], zero.axes[chain.driven[column]]
        # up @ axis = constant + cosine cos(angle) + sine sin(angle).
        constant = float(up @ turned) * float(turned @ axis)
        cosine, sine = float(up @ axis) - constant, float(up @ np.cross(turned, axis))
        swing = np.hypot(cosine, sine)
        if joint.kind is JointKind.PRISMATIC or abs(constant) >= swing:
            continue
        middle, half = np.arctan2(sine, cosine), np.arccos(-constant / swing)
        angles = [nearest_turn(float(middle + s * half), joint.lower, joint.upper) for s in (1, -1)]
        angle = min(angles, key=abs)
        residual = constant + cosine * np.cos(angle) + sine * np.sin(angle)
        if abs(residual) < _LEVEL:
            values[column] = angle
            return values
    return values


def leg_of(
    tree: Tree, base: int, last: int, up: FloatArray, placements: Sequence[Placement]
) -> Leg:
    """The leg that hangs on body `base` and ends with body `last`.

    Args:
        tree: of the robot.
        base: index of the body that the leg branches from.
        last: index of the leg's last body.
        up: unit vector against gravity in the root's frame, shape (3,).
        placements: of all bodies in the root's frame.
    """
    chain = chain_of(tree, base, last, placements)
    link, foot, radius = find_foot(chain, up)
    return Leg(
        name=link,
        body=last,
        joints=chain.names,
        foot=frozen(foot),
        foot_radius=radius,
        length=leg_plane(chain, foot, up).length,
        base=base,
        up=frozen(placements[base].rotation.T @ up),
    )


def far_ends(tree: Tree) -> list[int]:
    """Index of the descendant at the end of the longest path below each body, or of itself."""
    ends = list(range(len(tree.bodies)))
    lengths = [0.0] * len(tree.bodies)
    for index in range(len(tree.bodies) - 1, 0, -1):
        body = tree.bodies[index]
        length = lengths[index] + float(np.linalg.norm(body.placement.position))
        # Of equal lengths the first in the file, which is visited last, as a reader would expect.
        if length >= lengths[body.parent]:
            lengths[body.parent], ends[body.parent] = length, ends[index]
    return ends


def frame_link(body: Body) -> str:
    """The link whose frame represents a body's.

    It is the first of the links joined into the body, whose frame is the body's own; for usual
    robots the root link, the frame of Pinocchio's free-flyer. A link called the world is no part of
    the robot: then it is the heaviest link.
    """
    if body.name != WORLD or not any(body.link_masses.values()):
        return body.name
    return max(body.link_masses, key=body.link_masses.__getitem__)


WORLD = "world"
"""Link to which a URDF fixes a robot that must not fall."""
