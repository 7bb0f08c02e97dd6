"""Plausibility of a robot file: values that are possible, but probably not intended.

Mass between two planes at a distance L cannot have a larger variance along their normal than
L^2 / 4 (Popoviciu1935 in docs/references.md). The variance of a mass along an axis is
(tr(I) / 2 - I_ii) / m, and its root the radius of gyration about the plane through its centre.

The limits below are compared with public robots in docs/plausibility.md.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.frames import Placement
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
    properties: MassProperties,
) -> tuple[str, ...]:
    """Warnings of values that are possible, but probably not intended, one sentence each.

    Args:
        tree: of the robot, whose mass properties are physical as a whole.
        trunk: link whose frame is B.
        legs: as found; may be empty.
        posture: in which it stands.
        properties: the whole robot in that posture, in B.
    """
    warnings = Warnings()
    # Quotients with a mass of 1e-300 kg are infinite, and are judged correctly.
    with np.errstate(all="ignore"):
        radius, density = properties.gyration_radius, ball_density(properties)
        summary = (
            f"the robot weighs {properties.mass:.3g} kg with a radius of gyration of {radius:.3g} m"
        )
        if density > DENSEST_ROBOT:
            warnings.add(
                f"{summary}, as dense as solid metal (masses in grams, or lengths too small?)"
            )
        elif density < LIGHTEST_ROBOT:
            warnings.add(
                f"{summary}, as light as air (lengths in millimetres, inertias in g mm2, or masses "
                "in tonnes?)"
            )
        for body in tree.bodies:
            _judge_body(body, warnings)
        _judge_mirror_images(tree, trunk, legs, warnings)
        for leg in legs:
            effort_limit = EFFORT * properties.mass * _GRAVITY * leg.length
            for name in leg.joints:
                joint = tree.joints[name]
                if joint.kind is JointKind.REVOLUTE and effort_limit < joint.effort < np.inf:
                    warnings.add(
                        f"efforts over {EFFORT:.0f} times weight times leg length limit no jump: "
                        "specify the motors' limits",
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
"""Densities of solid aluminium and of air [kg/m^3], for a ball with a robot's radius of gyration.

Public robots lie between 5 and 484; grams or millimetres are off by a thousand or more.
"""


DEGREES = (8.0 * np.pi, 1440.0)
"""Ranges [rad] that suggest limits in degrees, of up to four turns; beyond, a hinge is endless."""


def _judge_body(body: Body, warnings: Warnings) -> None:
    properties, joint = body.mass_properties, body.joint
    if joint is not None and joint.kind is JointKind.REVOLUTE:
        fewest, largest = DEGREES
        if fewest < joint.upper - joint.lower <= largest:
            warnings.add("joints with a range of many turns (limits in degrees?)", joint.name)
    # There is already a warning of mass properties that are not physical.
    if properties.mass == 0.0 or physical_defect(properties) is not None:
        return
    box = box_of(body)
    if box is None:
        return
    for finding, figure in _contradictions(properties, box):
        warnings.add(finding, f"{body.name} ({figure})")
    if joint is not None and is_wheel(body):
        transverse = np.linalg.svd(joint.axis[None])[2][1:]
        moments = np.linalg.eigvalsh(transverse @ properties.inertia @ transverse.T)
        product = float(np.linalg.norm(transverse @ properties.inertia @ joint.axis))
        asymmetry = max(float(moments[1] - moments[0]), product) / max(float(moments[1]), 1e-300)
        if asymmetry > LOPSIDED:
            warnings.add(
                "links that are round about their joint, but whose inertia is not (given in other "
                "axes?)",
                f"{body.name} (by {asymmetry:.0%})",
            )


FLAT = 1e-6
"""Least side of a box [m]; a thinner body has no box."""


def box_of(body: Body) -> FloatArray | None:
    """Lower and upper corner of the box around all shapes of a body [m], shape (2, 3), or None.

    Collision and visual shapes count; None if some are not known.
    If a shape is missing or slow to read, or a link has a mass but no shape, the rest may be a
    fraction of the body, and no inertia can be called too large for it.
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
    box = np.array([np.min(corners, axis=0), np.max(corners, axis=0)])
    return box if (np.ptp(box, axis=0) > FLAT).all() else None


STEEL = 7850.0
"""Density of a link as heavy as a block of steel that fills its box [kg/m^3].

Public robots reach 7430."""

AIR = 1.2
"""Density of a link as light as the air in its box [kg/m^3]; in public robots at least 6.8."""


TOO_LARGE = 1.25
"""Largest radius of gyration over the largest in the body's box: 1.6 times its inertia.

Anything above 1 is impossible, but shapes leave out screws, cables and fins. Plausible, complete
shapes of public robots reach 1.14.
"""

TOO_SMALL = 0.2
"""Least radius of gyration over a solid box's, a 25th of its inertia; 0.27 in public robots."""

OUTSIDE = 0.05
"""Largest distance of a centre of mass outside the box, over the box's longest side."""

ELONGATED, SWAPPED = 1.75, 2.0
"""Ratio of length to width of a body whose mass must lie along its length, and ratio of the mass's
variance across to that along from which its inertia belongs to other axes."""

SHIFTED = 2.0
"""Ratio to a solid box's inertia above which an inertia is taken to be about the frame's origin, if
it falls by as much when the parallel-axis term is removed."""

_OTHER_AXES = "links whose inertia does not match their shapes' axes (given in other axes?)"


def _contradictions(properties: MassProperties, box: FloatArray) -> Iterator[tuple[str, str]]:
    """Contradictions between a body's mass properties and its box, each with its figure.

    Args:
        properties: physical, of a mass above zero, in the body's frame.
        box: of the body (`box_of`).
    """
    sides = np.ptp(box, axis=0)
    density = properties.mass / np.prod(sides)
    if density > STEEL:
        yield (
            "links heavier than their shapes in steel (masses in grams, or shapes too small?)",
            f"{density:.2g} kg/m3",
        )
    elif density < AIR:
        yield (
            "links lighter than the air in their shapes (a mesh in millimetres without a scale, "
            "or masses in tonnes?)",
            f"{density:.2g} kg/m3",
        )
    outside = float(np.maximum(box[0] - properties.com, properties.com - box[1]).max())
    excess, share = _excess(properties, sides), _share(properties, sides)
    if outside > OUTSIDE * sides.max():
        yield (
            "links whose centre of mass is outside their shapes (in another frame, or in "
            "millimetres?)",
            f"by {1e3 * outside:.3g} mm",
        )
    elif _is_about_origin(properties, sides):
        yield (
            "links whose inertia seems to be about their origin, not their centre of mass",
            f"{share:.3g} times a solid box's",
        )
    elif excess > TOO_LARGE:
        # If any turn by right angles fits, wrong axes are the most likely mistake.
        orders = ([0, 2, 1], [2, 1, 0], [1, 0, 2], [1, 2, 0], [2, 0, 1])
        inertias = (properties.inertia[np.ix_(order, order)] for order in orders)
        turned = (replace(properties, inertia=inertia) for inertia in inertias)
        yield (
            _OTHER_AXES
            if any(_excess(body, sides) < TOO_LARGE for body in turned)
            else "links with more inertia than their shapes allow (a unit other than kg m2, a "
            "placeholder, or a mesh without its scale?)",
            f"radius of gyration {excess:.3g} times the largest possible",
        )
    elif share < TOO_SMALL**2:
        yield (
            "links with too little inertia for their shapes (a unit other than kg m2, or a mesh "
            "without its scale?)",
            f"{share:.2g} times a solid box's",
        )
    else:
        variances, longest = mass_variances(properties), int(np.argmax(sides))
        transverse = sides[longest] > ELONGATED * sides
        if (transverse & (variances > SWAPPED * variances[longest])).any():
            yield _OTHER_AXES, "most of it about the long side"


def mass_variances(body: MassProperties) -> FloatArray:
    """Variance of the mass along each axis [m^2], shape (3,)."""
    variances = np.maximum(0.5 * np.trace(body.inertia) - np.diag(body.inertia), 0.0) / body.mass
    return np.asarray(variances)


def _excess(body: MassProperties, sides: FloatArray) -> float:
    """Largest radius of gyration over the largest possible in a box with these sides."""
    return float(np.sqrt((mass_variances(body) / (0.25 * sides**2)).max()))


def _share(body: MassProperties, sides: FloatArray) -> float:
    """Polar inertia over that of the solid box."""
    return float(mass_variances(body).sum() / (sides @ sides / 12.0))


def _is_about_origin(body: MassProperties, sides: FloatArray) -> bool:
    """Whether an inertia above a solid box's becomes plausible when moved to the centre of mass."""
    # Steiner's term is what the inertia about the origin has more.
    moved = replace(body, inertia=2.0 * body.inertia - body.inertia_about(np.zeros(3)))
    if physical_defect(moved) is not None:
        return False
    before, after = _share(body, sides), _share(moved, sides)
    return before > SHIFTED and after < before / SHIFTED


LOPSIDED = 0.05
"""Largest asymmetry of a wheel's inertia about its axle, over its largest moment across it.

Wheels of public robots are symmetric to 0.001.
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


def _judge_mirror_images(tree: Tree, trunk: str, legs: Sequence[Leg], warnings: Warnings) -> None:
    """Compare each leg on the left with the mirror image of one on the right, joints at zero."""
    placements = tree.placements_from(trunk, {})
    paths = [tree.path(leg.base, leg.body) for leg in legs]
    aside = _distance_aside(legs, [placements[path[0]].position for path in paths])
    if aside:
        side = "left" if aside < 0.0 else "right"
        warnings.add(
            f"the frame of the trunk '{trunk}' is {1e3 * abs(aside):.3g} mm {side} of the middle "
            "between the legs, and modules are placed about it: fix a link in the middle to the "
            "trunk and name it with --trunk"
        )
        middle = Placement(np.eye(3), np.array([0.0, -aside, 0.0]))
        placements = tuple(middle @ placement for placement in placements)
    masses = tree.mass_properties_at(placements)
    parts = [*zip(tree.bodies, masses, (place.position for place in placements), strict=True)]
    sides = [(leg, [parts[i] for i in path]) for leg, path in zip(legs, paths, strict=True)]
    left = [side for side in sides if _hip(side)[1] > 0.0]
    right = [side for side in sides if _hip(side)[1] < 0.0]
    for limb in left if len(left) == len(right) else ():
        # The leg whose hip is nearest to the mirror image's.
        other = min(right, key=lambda side: _shift(_hip(side), _hip(limb)))
        (leg, bodies), (twin, twins) = limb, other
        if len(bodies) != len(twins):
            names = f"{leg.name}, {twin.name}"
            warnings.add("legs left and right differ in their number of joints", names)
            continue
        for pair in zip(bodies, twins, strict=True):
            for finding in _differences(*pair, max(leg.length, twin.length)):
                warnings.add(finding, ", ".join(body.name for body, _, _ in pair))


def _distance_aside(legs: Sequence[Leg], hips: Sequence[FloatArray]) -> float:
    """Position along B's y of the plane between left and right [m]; zero if B's origin is on it.

    A single pair of legs does not tell a frame aside from a hip that is misplaced, so that two
    pairs or more must agree.
    """
    tolerance = 0.5 * SHIFT_SHARE * max((leg.length for leg in legs), default=0.0)
    ordered = sorted(hips, key=lambda hip: float(hip[1]))
    half = len(ordered) // 2
    if half < 2 or len(ordered) % 2:
        return 0.0
    middles = []
    for hip in ordered[half:]:
        twin = min(ordered[:half], key=lambda other: float(np.linalg.norm((other - hip)[[0, 2]])))
        middles.append(0.5 * float(hip[1] + twin[1]))
    aside = float(np.mean(middles))
    return aside if np.ptp(middles) < tolerance < abs(aside) else 0.0


_Part: TypeAlias = tuple[Body, MassProperties, FloatArray]
"""A body of a leg, with its mass properties and the origin of its joint in B [m], shape (3,)."""


def _hip(side: tuple[Leg, list[_Part]]) -> FloatArray:
    """Origin of a leg's first joint in B [m], shape (3,)."""
    return side[1][0][2]


def _shift(point: FloatArray, twin: FloatArray) -> float:
    """Distance of a point of B from the mirror image of its twin [m]."""
    return float(np.linalg.norm(point - _MIRROR @ twin))


def _differences(one: _Part, other: _Part, length: float) -> Iterator[str]:
    """Differences between two bodies of legs of this length [m], on either side."""
    (body, mass, origin), (twin, twin_mass, twin_origin) = one, other
    if not np.isclose(mass.mass, twin_mass.mass, rtol=MASS_SHARE, atol=0.0):
        yield "links that differ in mass from those on the other side"
    image = _MIRROR @ twin_mass.inertia @ _MIRROR
    largest = max(float(np.abs(mass.inertia).max()), float(np.abs(image).max()))
    heavy = max(mass.mass, twin_mass.mass) > 0.0
    if _shift(origin, twin_origin) > SHIFT_SHARE * length:
        yield "joints that do not mirror those on the other side"
    elif heavy and _shift(mass.com, twin_mass.com) > SHIFT_SHARE * length:
        yield "links whose centre of mass does not mirror the other side's"
    elif np.abs(mass.inertia - image).max() > INERTIA_SHARE * largest:
        yield "links whose inertia does not mirror the other side's"
    ours, theirs = (
        (joint.upper - joint.lower, joint.effort, joint.velocity)
        for joint in (body.joint, twin.joint)
        if joint is not None
    )
    if not np.isclose(ours, theirs, rtol=LIMIT_SHARE, atol=0.0).all():
        yield "joints whose range, effort or speed differs from the other side's"


EFFORT = 10.0
"""Effort of a leg's joint, over weight times leg length, above which it is a placeholder: legs that
have been built lie between 0.3 and 0.7."""

_GRAVITY = 9.81


IN_THE_AIR = 0.05
"""Largest height of a foot above the lowest one, over the leg's length: 8 mm for Solo12."""
