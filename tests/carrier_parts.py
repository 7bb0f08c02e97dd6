"""All parts of a module's carrier, one by one, as they are made and bought.

Bodies in the module's frame: x forward, y along the wheel's axis away from the other module, z up.
"""

from math import cos, pi, sin

import numpy as np

from ocs_design.actuation.fasteners import screw
from ocs_design.actuation.motor import Face
from ocs_design.parts.cage import cage_part
from ocs_design.parts.foot import PLATE_THICKNESS, Foot, foot_part
from ocs_design.parts.housing import Housing, housing_parts
from ocs_design.parts.motor_mount import mount_of
from ocs_design.parts.printed import LID_SCREW, PANEL
from ocs_design.robot.mass import MassProperties

UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Rotation from the frame of the left wheel, its y axis down, to that of its module."""


def foot_for(motor, gear, outer, height, thick=PLATE_THICKNESS):
    """Foot with its housing for a motor, a gear and a rim."""
    holes = mount_of(motor, gear.room, thick).holes
    return Foot(Housing(outer, height, holes, LID_SCREW), thick)


def carrier_parts(motor, gear, outer, height, thick=PLATE_THICKNESS):
    """All parts of the carrier about the wheel's centre."""
    foot = foot_for(motor, gear, outer, height, thick)
    for part in housing_parts(foot.housing):
        yield part.mass_properties().moved(UPRIGHT, np.zeros(3))
    yield foot_part(foot).mass_properties().moved(np.eye(3), [0.0, 0.0, -foot.wheel_height])
    yield from housing_screws(foot)
    yield from drive_parts(motor, gear, height, thick)


def housing_screws(foot):
    """M2 x 6 in the lid, M3 through the foot's base with at least 3 mm of thread."""
    housing, m2 = foot.housing, screw("M2")
    radius = housing.radius + m2.clearance_hole / 2.0
    along = housing.half_height - m2.centre(6e-3)
    for k in range(4):
        angle = pi / 4.0 + k * pi / 2.0
        yield point_mass(m2.mass(6e-3), radius * cos(angle), along, radius * sin(angle))
    m3, base = screw("M3"), max(3e-3, 0.6 * foot.thickness)
    length = standard_length(base + 3e-3)
    up = base - m3.centre(length) - foot.wheel_height
    # Two screws on the left foot, two mirrored ones on the right: half a screw at each place.
    for k in range(4):
        angle = pi / 4.0 + k * pi / 2.0
        x, y = foot.slot_radius * cos(angle), foot.slot_radius * sin(angle)
        yield point_mass(m3.mass(length) / 2.0, x, y, up)


def drive_parts(motor, gear, height, thick=PLATE_THICKNESS):
    """Motor, gear, cage and their screws, behind a foot's plate of that thickness."""
    room, mounting = gear.room, motor.mounting
    floor = -(height / 2.0 + 0.002 + PANEL)
    plate = floor - thick
    cage = mount_of(motor, room, thick).around(height).cage
    up, gear_up, deep = (0.0, 0.0, 0.0) if room is None else (room.offset, room.center, room.depth)
    length, radius = motor.length or 0.0, (motor.diameter or 0.0) / 2.0
    across = motor.mass * (3.0 * radius**2 + length**2) / 12.0
    own = np.diag([across, motor.mass * radius**2 / 2.0, across])
    # A caged motor reaches the hub: 3 mm high on a rotor, 5 mm plus 1 mm of clearance on a shaft.
    on_rotor = mounting is not None and mounting.rotor is not None
    on_shaft = max(0.005, (mounting and mounting.shaft_diameter) or 0.0)
    front = plate - deep if cage is None else -0.0015 if on_rotor else -(on_shaft / 2.0 + 0.001)
    yield MassProperties(motor.mass, [0.0, front - length / 2.0, up], own)
    yield point_mass(gear.mass, 0.0, plate - deep / 2.0, gear_up)
    if room is not None or mounting is None:
        return
    if on_rotor:
        yield from circle_screws(
            mounting.rotor, 3e-3 + thread_diameter(mounting.rotor), 0.0015, -1.0
        )
    if mounting.stator_face is Face.OUTPUT and mounting.stator is not None:
        through = PANEL + thick + thread_diameter(mounting.stator)
        yield from circle_screws(mounting.stator, through, floor + PANEL, -1.0)
    if cage is not None:
        bottom = max(3e-3, 0.42 * thick)
        back = front - length - bottom
        yield cage_part(cage).mass_properties().moved(UPRIGHT, [0.0, back, 0.0])
        yield from circle_screws(cage.passage.screws, thick + 5.2e-3, floor + PANEL, -1.0)
        yield from circle_screws(
            mounting.stator, bottom + thread_diameter(mounting.stator), back, 1.0
        )


def thread_diameter(circle):
    """Diameter of a circle's threads [m]."""
    return screw(circle.thread).diameter


def standard_length(at_least):
    """The shortest standard length of a screw [m]."""
    return next(n * 1e-3 for n in (4, 5, 6, 8, 10, 12, 16) if n * 1e-3 >= at_least - 1e-12)


def circle_screws(circle, at_least, along, towards):
    """Screws of a circle as points, the first straight up, their tips `towards` along the axis."""
    bolt = screw(circle.thread)
    length = standard_length(at_least)
    for k in range(circle.bolts):
        angle = 2.0 * pi * k / circle.bolts
        up, forward = circle.diameter / 2.0 * cos(angle), circle.diameter / 2.0 * sin(angle)
        yield point_mass(bolt.mass(length), forward, along + towards * bolt.centre(length), up)


def point_mass(mass, x, y, z):
    return MassProperties(mass, [x, y, z], np.zeros((3, 3)))
