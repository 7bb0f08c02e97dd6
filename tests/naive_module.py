"""Carrier of a module, computed independently of the package: an oracle for the selection.

Areas and second moments come from the outlines of the printed parts, for each radius and each
height. A body is represented by the integrals of 1, Y, Z, X^2, Y^2, Z^2 and YZ over its mass, about
the wheel's centre: X across the axis, Y along it away from the other module, Z up.
"""

from dataclasses import astuple, replace
from functools import lru_cache
from math import pi

import numpy as np
from carrier_parts import standard_length
from naive_outline import area_moments

from ocs_design.actuation.fasteners import screw
from ocs_design.parts import motor_mount
from ocs_design.parts.foot import Foot
from ocs_design.parts.housing import Housing
from ocs_design.parts.printed import CLEARANCE, LID_SCREW, PANEL, PETG, WALL, MountHoles

GAP, DEEP = CLEARANCE + WALL, CLEARANCE + PANEL
MARKS = ((24, 2.5e-3), (12, 4.0e-3))
"""Number and length of engraved marks, 0.8 mm wide and 0.4 mm deep."""


def extruded(area, second, low, high, axis):
    """A prism of an outline (area, second moments) between two heights along "y" or "z"."""
    first_across, second_across = second
    long, middle = high - low, (high + low) / 2.0
    mass = PETG.density * area * long
    along = mass * (middle**2 + long**2 / 12.0)
    zero = 0.0 * mass
    first, other = (
        PETG.density * long * first_across + zero,
        PETG.density * long * second_across + zero,
    )
    if axis == "y":
        return np.stack([mass, mass * middle, zero, first, along + zero, other, zero])
    return np.stack([mass, zero, mass * middle, first, other, along + zero, zero])


def raised(body, up):
    """A body moved up."""
    mass, y, z, xx, yy, zz, yz = body
    moved = zz + 2.0 * up * z + mass * up**2
    return np.stack([mass, y, z + mass * up, xx, yy, moved, yz + up * y])


def revolved_body(mass, axial, across):
    """A body of revolution about the axis, centred on the wheel."""
    zero = 0.0 * mass
    return np.stack([mass, zero, zero, axial / 2.0, across - axial / 2.0, axial / 2.0, zero])


def printed_parts(outer, height, mount, thick):
    """Drum, lid and foot with a plate of this thickness, for each size, shape (7, n)."""
    half = height / 2.0 + DEEP
    return housing_body(outer, height, mount, half) + foot_body(outer, height, mount, half, thick)


def housing_body(outer, height, mount, half):
    area, second = per_value(_housing_outline, outer)
    across = second / 2.0
    inside = outer + CLEARANCE
    cavity = pi * inside**2, (pi * inside**4 / 4.0,) * 2
    body = extruded(area, (across, across), -half, half, "y")
    body = body - extruded(*cavity, -half + PANEL, half - PANEL, "y")
    ears = outer + GAP + LID_SCREW.clearance_hole / 2.0
    for radius, low in ((LID_SCREW.tapping_drill / 2.0, -half + PANEL), (None, half - PANEL)):
        hole = LID_SCREW.clearance_hole / 2.0 if radius is None else radius
        high = half if radius is None else half - PANEL
        around = 2.0 * pi * hole**2 * (ears**2 + hole**2 / 2.0)
        body = body - extruded(4.0 * pi * hole**2, (around, around), low, high, "y")
    return body - extruded(*_mount_outline(mount), -half, -half + PANEL, "y")


def base_thickness(thick):
    """Thickness of a foot's base under a plate."""
    return max(3e-3, 0.6 * thick)


def foot_body(outer, height, mount, half, thick):
    back = half + thick
    edge, tall = base_sizes(outer, height, mount, thick)
    base = pi * edge**2, (pi * edge**4 / 4.0,) * 2
    low = base_thickness(thick)
    body = extruded(*base, 0.0, low, "z")
    slots, in_x, in_y = per_value(lambda h: _slots(h, thick), height)
    body = body - extruded(slots, (in_x, in_y), 0.0, low, "z")
    for count, length in MARKS:
        middle = edge - WALL - length / 2.0
        ring = count * length * 0.8e-3 * (middle**2 + (length**2 + 0.8e-3**2) / 12.0) / 2.0
        flat = count * length * 0.8e-3 + 0.0 * edge
        body = body - extruded(flat, (ring, ring), low - 0.4e-3, low, "z")
    body = raised(body, -tall)
    least = np.maximum(outer, outer_radius_min(mount) + 1e-9)
    area, first_z, in_x, in_z = per_value(lambda r: _plate(r, mount), least)
    plate = extruded(area, (in_x, in_z), -back, -half, "y")
    plate[2] += PETG.density * thick * first_z
    plate[6] -= PETG.density * thick * first_z * (back + half) / 2.0
    return body + plate - extruded(*_mount_outline(mount), -back, -half, "y")


def base_sizes(outer, height, mount, thick):
    """Radius of each foot's base and height of its wheel; `is_buildable` rejects small ones."""
    outer = np.maximum(outer, outer_radius_min(mount) + 1e-9)
    sizes, where = np.unique(np.stack([outer, height], axis=1), axis=0, return_inverse=True)
    feet = [Foot(Housing(r, h, mount, LID_SCREW), thick) for r, h in sizes.tolist()]
    return np.array([(foot.base_radius, foot.wheel_height) for foot in feet])[where.ravel()].T


def per_value(figures, values):
    """Figures for many values, computed once for each distinct one."""
    distinct, where = np.unique(values, return_inverse=True)
    return (
        np.array([figures(float(value)) for value in distinct]).reshape(distinct.size, -1)[where].T
    )


@lru_cache(maxsize=100_000)
def _housing_outline(outer):
    area, _, second = area_moments(Housing(outer, 0.01, MountHoles(), LID_SCREW).band.outline())
    return area, np.trace(second)


@lru_cache(maxsize=100_000)
def _slots(height, thick):
    slot = Foot(Housing(1.0, height, MountHoles(), LID_SCREW), thick).slot.outline()
    moments = [area_moments(slot), area_moments(slot.turned(pi))]
    second = sum(each[2] for each in moments)
    return sum(each[0] for each in moments), second[0, 0], second[1, 1]


@lru_cache(maxsize=100_000)
def _plate(outer, mount):
    """Moments about the wheel's axis; the outline starts at the underside, second axis down."""
    foot = Foot(Housing(outer, 0.01, mount, LID_SCREW))
    outline, up = foot.plate.outline(), np.array([0.0, foot.wheel_height])
    area, first, second = area_moments(replace(outline, points=outline.points + up))
    return area, -first[1], second[0, 0], second[1, 1]


@lru_cache(maxsize=1000)
def _mount_outline(mount):
    """Moments of the mount's holes; circles of three or more are alike about both axes."""
    holes = [one for hole in mount.prisms(0.0, 1.0) for one in hole.each()]
    moments = [area_moments(hole.outline) for hole in holes]
    second = sum((each[2] for each in moments), np.zeros((2, 2)))
    return sum(each[0] for each in moments), (second[0, 0], second[1, 1])


def mount_of(motor, gear, thick):
    """Holes of a mount in floor and plate."""
    return motor_mount.mount_of(motor, gear.room, thick).holes


def screw_bodies(outer, height, thick):
    """Four M2 x 6 on the lid, two M3 on the base, as points; one by one in `carrier_parts`."""
    m2, m3, half = screw("M2"), screw("M3"), height / 2.0 + DEEP
    long = standard_length(base_thickness(thick) + m3.diameter)
    lid, trunk = 4.0 * m2.mass(6e-3), 2.0 * m3.mass(long)
    along, up = half - m2.centre(6e-3), -(outer + GAP + CLEARANCE) - m3.centre(long)
    ears = lid * (outer + GAP + m2.clearance_hole / 2.0) ** 2 / 2.0
    slots = trunk * (half + thick + m3.head_diameter / 2.0 + WALL) ** 2
    one, zero = np.ones_like(outer), np.zeros_like(outer)
    on_lid = np.stack([lid * one, lid * along, zero, ears, lid * along**2, ears, zero])
    return on_lid + np.stack([trunk * one, zero, trunk * up, slots, slots, trunk * up**2, zero])


def total_body(pieces):
    """Sum of bodies about their common origin."""
    total = np.zeros(7)
    for piece in pieces:
        second = np.trace(piece.inertia) / 2.0 - np.diag(piece.inertia)
        com, mass = piece.com, piece.mass
        aslant = mass * com[1] * com[2] - piece.inertia[1, 2]
        total += [mass, *(mass * com[1:]), *(second + mass * com**2), aslant]
    return total


def swept_size(outer, height, motor, gear, thick):
    """Radius that encloses housing, drive and base, and the wheel's height on its foot."""
    mount = motor_mount.mount_of(motor, gear.room, thick)
    half, (depth, radius, least) = height / 2.0 + DEEP, astuple(mount.behind(motor))
    back = np.maximum(half + thick + depth, least)
    swept = np.maximum(np.hypot(outer + GAP, half), np.hypot(back, radius))
    edge, _ = base_sizes(outer, height, mount_of(motor, gear, thick), thick)
    return np.maximum(swept, edge), outer + GAP + CLEARANCE + base_thickness(thick)


def bore_min(motor, gear, thick):
    """Smallest bore that clears the heads of the screws in the housing."""
    mount = motor_mount.mount_of(motor, gear.room, thick)
    circle = mount.holes.screws
    return 0.0 if circle is None else circle.radius + screw(circle.thread).head_diameter / 2.0


def height_max(motor, gear, thick):
    """Tallest rim that leaves 6 mm of post between the plate and the motor's back."""
    cage = motor_mount.mount_of(motor, gear.room, thick).cage
    if cage is None:
        return np.inf
    return 2.0 * (cage.front + motor.length - 0.006 - thick - DEEP)


def outer_radius_min(mount):
    """Smallest rim that leaves a wall between the mount's holes and the housing's band."""
    return mount.reach + WALL - CLEARANCE if mount.reach > 0.0 else 0.0
