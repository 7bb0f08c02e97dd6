"""Plausibility of a robot file: values that can exist, but are hardly meant.

What lies between two planes at a distance L cannot have a larger variance along their normal than
L^2 / 4 (Popoviciu1935 in docs/references.md). The variance of a mass along an axis is
(tr(I) / 2 - I_ii) / m, and its root the radius of gyration about the plane through its centre.

The limits below are compared with public robots in docs/plausibility.md.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.robot.chain import Chain, chain_of, neutral_posture
from ocs_design.robot.leg_geometry import sole_depths
from ocs_design.robot.legs import is_wheel
from ocs_design.robot.links import Warnings
from ocs_design.robot.mass import MassProperties, ball_density, physical_defect
from ocs_design.robot.meshes import half_extents, mesh_bounds
from ocs_design.robot.robot import Leg
from ocs_design.robot.tree import Body, JointKind, ShapeKind, Tree


def plausibility_warnings(
    tree: Tree,
    trunk: str,
    legs: Sequence[Leg],
    posture: Mapping[str, float],
    weighed: MassProperties,
) -> tuple[str, ...]:
    """Warnings of what can be, but is hardly meant, one sentence each.

    Args:
        tree: of the robot, of which mass properties are physical as a whole.
        trunk: link whose frame is B.
        legs: as found; may be empty.
        posture: that it stands in.
        weighed: the whole robot in that posture, in B.
    """
    warnings = Warnings()
    # The quotients of a mass of 1e-300 kg are infinite, and judged rightly as that.
    with np.errstate(all="ignore"):
        radius, density = weighed.gyration_radius, ball_density(weighed)
        stated = (
            f"the robot weighs {weighed.mass:.3g} kg with a radius of gyration of {radius:.3g} m"
        )
        if density > DENSEST_ROBOT:
            warnings.add(
                f"{stated}, as dense as solid metal: masses in grams, or lengths too small?"
            )
        elif density < LIGHTEST_ROBOT:
            warnings.add(f"{stated}, as light as air: lengths in millimetres, or masses in tonnes?")
        for body in tree.bodies:
            _judge_body(body, warnings)
        _judge_mirror_images(tree, trunk, legs, warnings)
        for leg in legs:
            most = EFFORT * weighed.mass * _GRAVITY * leg.length
            for name in leg.joints:
                joint = tree.joints[name]
                if joint.kind is JointKind.REVOLUTE and most < joint.effort < np.inf:
                    warnings.add(
                        f"efforts over {EFFORT:.0f} times weight times leg length limit no jump: "
                        "state what the motors give",
                        f"{name} ({joint.effort:.4g} N m)",
                    )
        # The trunk is level, and the lowest foot is on the ground.
        soles = sole_depths(tree, trunk, legs, posture) if legs else ()
        for leg, sole in zip(legs, soles, strict=True):
            height = max(soles) - sole
            if height > IN_THE_AIR * leg.length:
                warnings.add(
                    f"foot '{leg.name}' is {1e3 * height:.3g} mm above the ground in this posture"
                )
    return warnings.sentences()


DENSEST_ROBOT, LIGHTEST_ROBOT = 2700.0, 1.2
"""Densities of solid aluminium and of air [kg/m^3], for the ball with a robot's radius of gyration.

Public robots lie between 5 and 484; in grams or millimetres they are off by a thousand or more.
"""


DEGREES = (8.0 * np.pi, 1440.0)
"""Range of a hinge [rad] that four turns of degrees would be; beyond, it is meant to be endless."""


def _judge_body(body: Body, warnings: Warnings) -> None:
    weighed, joint = body.mass_properties, body.joint
    if joint is not None and joint.kind is JointKind.REVOLUTE:
        fewest, most = DEGREES
        if fewest < joint.upper - joint.lower <= most:
            warnings.add("joints with a range of many turns: limits in degrees?", joint.name)
    # Mass properties that no matter could have are warned of as such already.
    if weighed.mass == 0.0 or physical_defect(weighed) is not None:
        return
    box = box_of(body)
    if box is None:
        return
    for finding, figure in _contradictions(weighed, box):
        warnings.add(finding, f"{body.name} ({figure})")
    if joint is not None and is_wheel(body):
        across = np.linalg.svd(joint.axis[None])[2][1:]
        moments = np.linalg.eigvalsh(across @ weighed.inertia @ across.T)
        product = float(np.linalg.norm(across @ weighed.inertia @ joint.axis))
        unround = max(float(moments[1] - moments[0]), product) / max(float(moments[1]), 1e-300)
        if unround > LOPSIDED:
            warnings.add(
                "links that are round about their joint with an inertia that is not: in other "
                "axes?",
                f"{body.name} (by {unround:.0%})",
            )


FLAT = 1e-6
"""Least side of a box [m]; a body that is thinner has none."""


@dataclass(frozen=True, eq=False)
class Box:
    """Box around all shapes of a body, along the axes of its frame.

    Attributes:
        lower, upper: corners [m], shape (3,).
    """

    lower: FloatArray
    upper: FloatArray

    @property
    def sides(self) -> FloatArray:
        """Lengths of the sides [m], shape (3,)."""
        return self.upper - self.lower

    @property
    def volume(self) -> float:
        """Product of the sides [m^3]."""
        return float(np.prod(self.sides))


def box_of(body: Body) -> Box | None:
    """Box around all that a body collides with or shows; None if part of that is not known.

    Where a shape is missing or slow to read, or a link has a mass and no shape, what is left may be
    a fraction of the body, and no inertia can be called too large for it.
    """
    shaped = {shape.link for shape in body.shapes}
    if any(mass > 0.0 and link not in shaped for link, mass in body.link_masses.items()):
        return None
    corners = []
    for shape in body.shapes:
        if shape.kind is ShapeKind.MESH:
            bounds = None if shape.mesh is None else mesh_bounds(shape.mesh, shape.size, quick=True)
            if bounds is None:
                return None
            centre, half = bounds.mean(axis=0), 0.5 * (bounds[1] - bounds[0])
        else:
            centre, half = np.zeros(3), half_extents(shape)
        middle = shape.position + shape.rotation @ centre
        reach = np.abs(shape.rotation) @ half
        corners += [middle - reach, middle + reach]
    if not corners:
        return None
    box = Box(np.min(corners, axis=0), np.max(corners, axis=0))
    return box if (box.sides > FLAT).all() else None


STEEL = 7850.0
"""Density of a link as heavy as a block of steel that fills its box [kg/m^3].

Public robots reach 7430."""

AIR = 1.2
"""Density of a link as light as the air in its box [kg/m^3]; public robots begin at 6.8."""


TOO_LARGE = 1.25
"""Largest radius of gyration over what fits into the body's box: 1.6 times the largest inertia.

Above 1 is impossible already, but shapes leave out screws, cables and fins. Whole shapes of public
robots that look right reach 1.14.
"""

TOO_SMALL = 0.2
"""Least radius of gyration over a full box's, a 25th of its inertia; public robots have 0.27."""

OUTSIDE = 0.05
"""Farthest that a centre of mass may be out of the box, over its longest side."""

ELONGATED, SWAPPED = 1.75, 2.0
"""A body so many times as long as wide has its mass along the length: if the variance of its mass
is so many times larger across, the inertia belongs to other axes."""

SHIFTED = 2.0
"""An inertia that is so many times a full box's, and less than that over this if the parallel axes
to the frame's origin are taken off, is about the origin."""

_OTHER_AXES = "links whose inertia does not lie as their shapes do: written in other axes?"


def _contradictions(weighed: MassProperties, box: Box) -> Iterator[tuple[str, str]]:
    """Contradictions between a body's mass properties and its box, each with its figure.

    Args:
        weighed: physical, of a mass above zero, in the body's frame.
        box: of the body, in its frame.
    """
    density = weighed.mass / box.volume
    if density > STEEL:
        yield (
            "links heavier than solid steel in their shapes: masses in grams, or too small shapes?",
            f"{density:.2g} kg/m3",
        )
    elif density < AIR:
        yield (
            "links lighter than the air in their shapes: a mesh in millimetres without its scale, "
            "or masses in tonnes?",
            f"{density:.2g} kg/m3",
        )
    outside = float(np.maximum(box.lower - weighed.com, weighed.com - box.upper).max())
    variances = mass_variances(weighed.inertia, weighed.mass)
    excess = _excess(variances, box)
    share = _share(variances, box)
    if outside > OUTSIDE * box.sides.max():
        yield (
            "links whose centre of mass is outside of their shapes: in another frame, or in "
            "millimetres?",
            f"by {1e3 * outside:.3g} mm",
        )
    elif _is_about_origin(weighed, box):
        yield (
            "links whose inertia is about their origin, not their centre of mass?",
            f"{share:.3g} times a full box's",
        )
    elif excess > TOO_LARGE:
        # The likeliest mistake is one of axes, if any turn by right angles would fit.
        orders = ([0, 2, 1], [2, 1, 0], [1, 0, 2], [1, 2, 0], [2, 0, 1])
        turned = [weighed.inertia[np.ix_(order, order)] for order in orders]
        fits = [_excess(mass_variances(each, weighed.mass), box) < TOO_LARGE for each in turned]
        yield (
            _OTHER_AXES
            if any(fits)
            else "links with more inertia than fits into their shapes: another unit than kg m2, a "
            "placeholder, or a mesh without its scale?",
            f"radius of gyration {excess:.3g} times what fits",
        )
    elif share < TOO_SMALL**2:
        yield (
            "links with too little inertia for their shapes: another unit than kg m2, or a mesh "
            "without its scale?",
            f"{share:.2g} times a full box's",
        )
    else:
        long = int(np.argmax(box.sides))
        across = box.sides[long] > ELONGATED * box.sides
        if (across & (variances > SWAPPED * variances[long])).any():
            yield _OTHER_AXES, "most of it about the long side"


def mass_variances(inertia: FloatArray, mass: float) -> FloatArray:
    """Variance of the mass along each axis [m^2], shape (3,)."""
    return np.asarray(np.maximum(0.5 * np.trace(inertia) - np.diag(inertia), 0.0) / mass)


def _excess(variances: FloatArray, box: Box) -> float:
    """Largest radius of gyration over what fits into the box."""
    return float(np.sqrt((variances / (0.25 * box.sides**2)).max()))


def _share(variances: FloatArray, box: Box) -> float:
    """Polar inertia over that of the full box."""
    return float(variances.sum() / (box.sides @ box.sides / 12.0))


def _is_about_origin(weighed: MassProperties, box: Box) -> bool:
    """Whether an inertia beyond a full box's becomes a body's once it is moved to the centre."""
    offset = MassProperties(weighed.mass, weighed.com, np.zeros((3, 3))).inertia_about(np.zeros(3))
    moved = MassProperties(weighed.mass, weighed.com, weighed.inertia - offset)
    if physical_defect(moved) is not None:
        return False
    before, after = (
        _share(mass_variances(each.inertia, each.mass), box) for each in (weighed, moved)
    )
    return before > SHIFTED and after < before / SHIFTED


LOPSIDED = 0.05
"""Largest part of a wheel's inertia that is not round, over its largest moment across the axle.

Wheels of public robots are round to 0.001.
"""


MASS_SHARE = 0.02
"""Largest difference of mass between left and right, over the heavier."""

SHIFT_SHARE = 0.02
"""Largest shift of a joint or centre of mass from the mirror image, over the leg's length."""

INERTIA_SHARE = 0.1
"""Largest difference of inertia from the mirror image, over the largest moment of the larger."""

LIMIT_SHARE = 0.02
"""Largest difference of a joint's range, effort and speed between left and right."""

_MIRROR = np.diag([1.0, -1.0, 1.0])
"""Reflection at the plane between left and right, in B."""


@dataclass(frozen=True, eq=False)
class _Side:
    """One leg in B, joints at rest.

    Attributes:
        leg: as found. chain: from hip to foot. origins: of its joints [m], shape (n, 3).
        masses: of its bodies.
    """

    leg: Leg
    chain: Chain
    origins: FloatArray
    masses: tuple[MassProperties, ...]


def _judge_mirror_images(tree: Tree, trunk: str, legs: Sequence[Leg], warnings: Warnings) -> None:
    """Compare each leg on the left with the mirror image of the one on the right."""
    if not legs:
        return
    placements = tree.placements_from(trunk, neutral_posture(tree))
    sides = []
    for leg in legs:
        chain = chain_of(tree, leg.base, leg.body, placements)
        place, origins, masses = chain.start, [], []
        for body in chain.bodies:
            place = place @ body.placement
            origins.append(place.position)
            masses.append(body.mass_properties.moved(place.rotation, place.position))
        sides.append(_Side(leg, chain, np.array(origins), tuple(masses)))
    left = [side for side in sides if side.origins[0, 1] > 0.0]
    right = [side for side in sides if side.origins[0, 1] < 0.0]
    for one in left if len(left) == len(right) else ():
        # The leg whose hip is nearest to where the mirror image has it.
        other = min(right, key=lambda each: _shift(each.origins[0], one.origins[0]))
        if len(one.masses) != len(other.masses):
            names = f"{one.leg.name}, {other.leg.name}"
            warnings.add("legs left and right differ in their number of joints", names)
            continue
        bodies = zip(one.chain.bodies, other.chain.bodies, strict=True)
        for index, (body, twin) in enumerate(bodies):
            for finding in _differences(one, other, index):
                warnings.add(finding, f"{body.name}, {twin.name}")


def _shift(point: FloatArray, twin: FloatArray) -> float:
    """Distance of a point of B from the mirror image of its twin [m]."""
    return float(np.linalg.norm(point - _MIRROR @ twin))


def _differences(one: _Side, other: _Side, index: int) -> Iterator[str]:
    """Differences between the bodies with this number from the hip, on either side."""
    body, twin = one.masses[index], other.masses[index]
    length = max(one.leg.length, other.leg.length)
    if not np.isclose(body.mass, twin.mass, rtol=MASS_SHARE, atol=0.0):
        yield "links that differ in mass from those on the other side"
    image = _MIRROR @ twin.inertia @ _MIRROR
    largest = max(float(np.abs(body.inertia).max()), float(np.abs(image).max()))
    if _shift(one.origins[index], other.origins[index]) > SHIFT_SHARE * length:
        yield "joints that do not mirror those on the other side"
    elif max(body.mass, twin.mass) > 0.0 and _shift(body.com, twin.com) > SHIFT_SHARE * length:
        yield "links whose centre of mass does not mirror the other side's"
    elif np.abs(body.inertia - image).max() > INERTIA_SHARE * largest:
        yield "links whose inertia does not mirror the other side's"
    ours, theirs = (
        (joint.upper - joint.lower, joint.effort, joint.velocity)
        for joint in (one.chain.joints[index], other.chain.joints[index])
    )
    if not np.isclose(ours, theirs, rtol=LIMIT_SHARE, atol=0.0).all():
        yield "joints whose range, effort or speed differs from the other side's"


EFFORT = 10.0
"""Effort of a leg's joint, over weight times the leg's length, that is a placeholder: legs that
somebody has built lie between 0.3 and 0.7."""

_GRAVITY = 9.81


IN_THE_AIR = 0.05
"""Largest height of a foot over the lowest one, over the leg's length: 8 mm of Solo12's."""
