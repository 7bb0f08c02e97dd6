"""Size of a module, and positions of modules as they grow."""

from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from ocs_design.common.arrays import FloatArray, frozen, vector
from ocs_design.device.layout import PAIR, Direction, Layout
from ocs_design.parts.foot import Foot, elementwise_max
from ocs_design.parts.housing import Housing
from ocs_design.parts.motor_mount import Behind
from ocs_design.parts.printed import PLATE_THICKNESS, MountHoles

SPACING = 1.1
"""Space kept around a wheel, relative to the radius of the sphere that it sweeps at any
incidence."""

Real = TypeVar("Real", float, FloatArray)


class Size(NamedTuple, Generic[Real]):
    """Space that a module takes.

    Attributes:
        reach: radius that housing, motor and the foot's base stay within at any incidence [m].
        wheel_height: height of the wheel's centre above the surface that the module stands on [m].
    """

    reach: Real
    wheel_height: Real


def wheel_size(outer_radius: Real, height: Real) -> Size[Real]:
    """Size of a bare wheel that turns freely above its support."""
    reach: Real = (outer_radius**2 + height**2 / 4.0) ** 0.5
    return Size(reach, SPACING * reach)


def module_size(
    outer_radius: Real,
    height: Real,
    behind: Behind[Real] | Behind[float],
    mount_reach: Real | float,
    *,
    foot_plate: Real | float = PLATE_THICKNESS,
) -> Size[Real]:
    """Size of a housing on its foot, around a wheel of this radius and height, with its motor.

    All in metres; a guard ring adds its wall to the wheel's radius. Motor, gear and cage behind the
    foot's plate count with their depth and half-width; their height does not matter for a turn
    about the vertical.
    """
    reach: Any = mount_reach
    housing: Housing[Real] = Housing(outer_radius, height, MountHoles(reach))
    foot: Foot[Real] = Foot(housing, foot_plate)
    housing_reach = (housing.radius**2 + housing.half_height**2) ** 0.5
    depth = elementwise_max(foot.back + behind.depth, behind.from_wheel)
    motor_reach = (depth**2 + behind.radius**2) ** 0.5
    return Size(
        elementwise_max(elementwise_max(housing_reach, motor_reach), foot.base_radius),
        foot.wheel_height,
    )


@dataclass(frozen=True)
class Place:
    """Centres of all modules as their size grows.

    Attributes:
        origins: centre of each if it had no size, in B [m].
        outward: displacement of each per radius of the sphere that it sweeps, in B.
        upright: whether they stand on a surface below them, at the height of their feet.
    """

    origins: tuple[Direction, ...]
    outward: tuple[Direction, ...]
    upright: bool = False

    @property
    def specified(self) -> bool:
        """Whether it is the same for modules of any size, as a specified one is (`place_at`)."""
        return not (any(map(any, self.outward)) or self.upright)

    def __call__(self, outer_radius: float, height: float) -> FloatArray:
        """Centres of bare wheels in B for R and h [m], shape (n, 3)."""
        return frozen(self.centers(wheel_size(outer_radius, height)))

    def centers(self, size: Size[float] | Size[FloatArray]) -> FloatArray:
        """Centres of the modules in B [m], shape (..., n, 3), for sizes of shape (...)."""
        reach, wheel_height = (np.asarray(length)[..., None] for length in size)
        centers = np.array(self.origins) + reach[..., None] * np.array(self.outward)
        if self.upright:
            centers[..., 2] += wheel_height
        return np.asarray(centers)


def place_around(middle: Direction, layout: Layout, lateral_offset: float = 0.0) -> Place:
    """Upright modules around a point of the surface that they stand on, in B [m].

    `lateral_offset`: extra distance of each to its side, beyond what it needs [m].
    """
    x, y, z = middle
    outward = tuple(vector(direction) for direction in np.array(layout.ring) * SPACING)
    origins = tuple(
        (x, y + float(np.sign(lateral)) * lateral_offset, z) for _, lateral, _ in outward
    )
    return Place(origins, outward, upright=True)


def place_at(position: tuple[float, ...], layout: Layout = PAIR) -> Place:
    """Modules at specified positions in B [m]: three coordinates of each.

    For a pair only the left one is given; the right one is its mirror image in y.
    """
    places = np.reshape(position, (-1, 3))
    if layout == PAIR:
        places = np.concatenate([places, places * [1.0, -1.0, 1.0]])
    return Place(tuple(vector(center) for center in places), ((0.0, 0.0, 0.0),) * len(places))
