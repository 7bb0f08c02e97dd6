"""A robot known only by its mass and inertia, given by hand."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations

import numpy as np

from ocs_design.common.errors import RobotError, UsageError
from ocs_design.common.frames import Placement
from ocs_design.common.units import UNITS, Dimension
from ocs_design.robot.mass import MassProperties, ball_density, impossible_size, solid_defect
from ocs_design.robot.robot import Robot, RobotFormat
from ocs_design.robot.tree import Body, Shape, ShapeKind, Tree

TRUNK = "base"
"""The only link of a robot given by hand."""


def robot_by_hand(
    mass: float,
    inertia: Sequence[float],
    com: Sequence[float] = (0.0, 0.0, 0.0),
    name: str = "robot",
) -> Robot:
    """A robot of one body, shaped as the homogeneous box that has its mass and inertia.

    Args:
        mass: [kg].
        inertia: about the centre of mass, in B: IXX, IYY, IZZ or IXX, IYY, IZZ, IXY, IXZ, IYZ
            [kg m^2].
        com: centre of mass in B [m].
        name: of the robot.
    """
    if np.shape(inertia) not in {(3,), (6,)}:
        given = " x ".join(map(str, np.shape(inertia))) or "one"
        raise UsageError(
            f"an inertia has 3 or 6 numbers, not {given}",
            hint="give IXX,IYY,IZZ or IXX,IYY,IZZ,IXY,IXZ,IYZ in kg m^2",
        )
    xx, yy, zz, xy, xz, yz = (*inertia, 0.0, 0.0, 0.0)[:6]
    matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], dtype=np.float64)
    properties = MassProperties(mass, np.array(com, dtype=np.float64), matrix)
    if (defect := solid_defect(properties)) is not None:
        raise RobotError(
            f"the robot given by hand {defect}",
            hint="the inertia is about the centre of mass, in kg m^2; the mass is in kg",
        )
    if (impossible := impossible_size(properties)) is not None:
        raise RobotError(f"the robot given by hand: {impossible}", hint=_likely_unit(properties))
    links = {TRUNK: Placement.identity()}
    body = Body(
        TRUNK,
        -1,
        Placement.identity(),
        None,
        properties,
        links,
        {TRUNK: mass},
        (equal_box(properties),),
    )
    return Robot(
        name=name,
        source="by hand",
        sha256="",
        format=RobotFormat.MANUAL,
        content=b"",
        tree=Tree(name, (body,)),
        trunk=TRUNK,
        floating_base=TRUNK,
        posture={},
        posture_name="zero",
        mass_properties=properties,
        legs=(),
        standing_height=None,
        warnings=(),
    )


PITCH_GYRATION, YAW_GYRATION = 0.0479, 0.0055
"""Inertia of a standing person, over mass and squared height, about y and z [1].

Means of three adults, who are within 6 and 9 % of them (Body coordinate system, table A.2.1,
guwsmedical.info/body-dynamics). Scaling with mass and squared height: Jensen, Med. Sci. Sports
Exerc. 18(4), 1986, with correlations of 0.97 and 0.99."""

HEIGHT_OF_MASS, BACK = 0.559, 0.0513
"""Height of the centre of mass above the soles, and its distance from the back, over the person's
height: means of the same three, within 1.3 and 2.4 %."""

ROLL_GYRATION = PITCH_GYRATION + YAW_GYRATION - 2.0 * BACK**2 / 3.0
"""Inertia about x, over mass and squared height [1]: a homogeneous body as deep as twice `BACK`.

The measured value, 0.0542, exceeds the sum of those about y and z, which is impossible; pendulums
measure it to within 2 to 8 % (Santschi et al., AMRL-TDR-63-36, 1963)."""

MID_TRUNK = 0.674
"""Height midway between hip and shoulder over the person's: 0.530 and 0.818 (Drillis and
Contini in Winter, Biomechanics and Motor Control of Human Movement, figure 4.1)."""

WORN_BEHIND = 0.15
"""Distance from the back to the middle of a device worn on it: room for a wheel [m]."""


def person(mass: float, height: float, payload: float = 0.0, name: str = "person") -> Robot:
    """A person standing upright, as one rigid body; B is at the centre of mass without payload.

    Args:
        mass: without payload [kg]. height: [m].
        payload: carried on the back at the middle of the trunk, as a point [kg].
        name: of the person.
    """
    inertia = mass * height**2 * np.diag([ROLL_GYRATION, PITCH_GYRATION, YAW_GYRATION])
    worn = np.array([-BACK, 0.0, MID_TRUNK - HEIGHT_OF_MASS]) * height
    com = worn * (payload / (mass + payload))
    # Two bodies about their common centre of mass: reduced mass times squared distance.
    reduced = mass * payload / (mass + payload)
    inertia += reduced * (worn @ worn * np.eye(3) - np.outer(worn, worn))
    six = inertia[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)].tolist()
    robot = robot_by_hand(mass + payload, six, com.tolist(), name)
    behind, _, up = worn.tolist()
    return replace(
        robot, standing_height=HEIGHT_OF_MASS * height, worn_at=(behind - WORN_BEHIND, 0.0, up)
    )


def equal_box(properties: MassProperties) -> Shape:
    """The homogeneous box with the same mass, centre of mass and inertia.

    A box of sides a, b, c has I_a = m (b^2 + c^2) / 12 and so on, hence
    a^2 = 6 (I_b + I_c - I_a) / m.
    """
    # Right-handed principal axes, as near to B's as possible.
    moments, axes = np.linalg.eigh(properties.inertia)
    orders = [list(order) for order in permutations(range(3))]
    order = max(orders, key=lambda candidate: float(np.abs(np.diag(axes[:, candidate])).sum()))
    moments, axes = moments[order], axes[:, order]
    axes = axes * np.where(np.diag(axes) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] *= -1.0
    squares = 6.0 * (moments.sum() - 2.0 * moments) / properties.mass
    half = 0.5 * np.sqrt(np.maximum(squares, 0.0))
    size = (float(half[0]), float(half[1]), float(half[2]))
    return Shape(ShapeKind.BOX, size, properties.com, axes, TRUNK, collides=True)


def assumed_trunk(robot: Robot) -> Shape | None:
    """The box that stands for the trunk of a robot given by hand; None: its shape is known.

    A person wears the device, and nothing is placed by that box.
    """
    by_hand = robot.format is RobotFormat.MANUAL and robot.worn_at is None
    return robot.tree.bodies[0].shapes[0] if by_hand else None


def origin_by_hand(com: Sequence[float]) -> str:
    """Place of the origin of B on a robot given by hand, in words; `com`: see `robot_by_hand`."""
    if not any(com):
        return "the robot's centre of mass"
    at = ", ".join(f"{1e3 * value:.1f}" for value in com)
    return f"the point from which the robot's centre of mass is at x, y, z = {at} mm"


USUAL_DENSITY = 50.0
"""Density of a ball with Solo12's mass and inertia [kg/m^3]."""


def _likely_unit(properties: MassProperties) -> str:
    """Suggestion of the units of mass and inertia with which the robot is most like Solo12."""
    grams = f"a mass of {properties.mass:.4g}g"
    lighter = replace(properties, mass=1e-3 * properties.mass)
    options = {grams: lighter}
    for unit, factor in UNITS[Dimension.INERTIA].items():
        # A bare number is in SI, which was found not to be meant.
        if factor == 1:
            continue
        moments = (f"{moment:.6g}{unit.replace(' ', '')}" for moment in np.diag(properties.inertia))
        inertia, turned = f"an inertia of {','.join(moments)}", float(factor) * properties.inertia
        options[inertia] = replace(properties, inertia=turned)
        options[f"{grams} and {inertia}"] = replace(lighter, inertia=turned)
    deviations = {
        text: abs(np.log(ball_density(body) / USUAL_DENSITY)) for text, body in options.items()
    }
    likeliest = min(deviations, key=deviations.__getitem__)
    return f"did you mean {likeliest}? Bare numbers are in kg and kg m^2"
