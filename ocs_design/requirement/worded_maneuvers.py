"""Maneuvers requested by keys of `[requirement]`, and the defaults filled in for each."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain
from math import sqrt

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.files import comparable_name
from ocs_design.common.units import STANDARD_GRAVITY, format_quantity
from ocs_design.requirement.froude import default_maneuvers, jump_for, standing_height
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.phrases import Kick, Tilt
from ocs_design.requirement.pivoted import Actuation, Balance, Pivoted, StandUp
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.sections import RequirementSection
from ocs_design.requirement.turns import Catch, TurnTo
from ocs_design.requirement.values import Vector3, did_you_mean
from ocs_design.robot.robot import Robot


@dataclass(frozen=True, eq=False)
class Worded:
    """Maneuvers requested in words, with one sentence each on the defaults filled in."""

    maneuvers: tuple[Maneuver, ...]
    notes: tuple[str, ...]


def worded_maneuvers(
    requirement: RequirementSection, robot: Robot, other_names: Iterable[str] = ()
) -> Worded:
    """Maneuvers requested by keys of their own, such as `kick` and `fall`.

    Each kick is combined with each jump, each flip with each jump, each fall with each tilt;
    unspecified figures are those of the paper's tests, scaled to the robot.

    Args:
        requirement: the section with these keys.
        robot: to scale to.
        other_names: names of other maneuvers; the new names differ from them, and so do their
            files.

    Raises:
        SpecificationError: the robot lacks the link that a kick hits; or a pivot is missing, or
            given but not used.
    """
    gravity = STANDARD_GRAVITY if requirement.gravity is None else requirement.gravity
    disturbance, drop, back_flip = default_maneuvers(robot, gravity or STANDARD_GRAVITY)
    maneuvers: list[Maneuver] = []
    notes: list[str] = []
    files = {comparable_name(name) for name in other_names}

    def add(maneuver: Maneuver, note: str, text: str = "") -> None:
        """Add a maneuver with a note on it; if its name is taken, it gets a number."""
        name, number = maneuver.name, 2
        while comparable_name(name) in files:
            name, number = f"{maneuver.name} {number}", number + 1
        files.add(comparable_name(name))
        maneuvers.append(replace(maneuver, name=name))
        notes.append(f"{name}: {text or maneuver.summary}{note}.")

    highest = disturbance.takeoff_velocity[1] ** 2 / (2.0 * disturbance.gravity)
    for height in requirement.jump_height or (highest,):
        # A vertical jump with the torque of the paper's first test, at the same part of the flight.
        upward = sqrt(2.0 * disturbance.gravity * height)
        time_ratio = upward / disturbance.takeoff_velocity[1]
        roll, pitch, yaw = disturbance.torque
        jump = replace(
            disturbance,
            name="jump",
            takeoff_velocity=(0.0, upward),
            torque=(roll / time_ratio, pitch / time_ratio, yaw / time_ratio),
            onset=time_ratio * disturbance.onset,
            duration=time_ratio * disturbance.duration,
        )
        assumption = " (the paper's, scaled)" if requirement.jump_height is None else ""
        of_jump = f", in a vertical jump of {height:.3g} m{assumption}"
        for kick in requirement.kick or ():
            kicked, text = _kicked(kick, jump, robot)
            add(kicked, of_jump, text)
        if requirement.jump_height and not any(
            (requirement.kick, requirement.flip, requirement.turn, requirement.catch)
        ):
            add(jump, f"{of_jump}; the torque is that of the paper's first test, scaled")
    share = back_flip.duration / back_flip.flight_time
    heights = back_flip.jump_height, highest
    turns = ((turn, "") for turn in _turns(requirement, gravity, share, heights))
    for maneuver, note in chain(turns, _pivoted(requirement, gravity, robot)):
        add(maneuver, note)
    for height in requirement.jump_height or (back_flip.jump_height,):
        for angle in requirement.flip or ():
            flip = replace(back_flip, name="flip", gravity=gravity, jump_height=height, angle=angle)
            note = f", {share:.0%} of the flight as in the paper"
            if requirement.jump_height is None:
                note += "; the jump's height is the paper's, scaled"
            add(replace(flip, duration=share * flip.flight_time), note)
    if requirement.fall or requirement.tilt:
        for height in requirement.fall or (drop.height,):
            for tilt in requirement.tilt or (Tilt(drop.roll, drop.pitch),):
                fall = replace(drop, name="fall", height=height, roll=tilt.roll, pitch=tilt.pitch)
                feet = format_quantity(height - standing_height(robot), "mm", 3)
                note = f", the feet of the level robot {feet} above the ground"
                if requirement.tilt is None:
                    note += "; the tilt is the paper's"
                if requirement.fall is None:
                    note += "; the height is the paper's, scaled"
                add(fall, note)
    return Worded(tuple(maneuvers), tuple(notes))


def _turns(
    requirement: RequirementSection,
    gravity: float,
    flight_share: float,
    heights: tuple[float, float],
) -> Iterator[TurnTo]:
    """Turns and catches requested, in every jump.

    Args:
        requirement: see `worded_maneuvers`. gravity: [m/s^2].
        flight_share: of its flight that a turn takes, where its time or its jump is not specified.
        heights: of the jump of a turn and of a catch, where neither is specified [m].
    """
    for height in requirement.jump_height or (None,):
        for turn in requirement.turn or ():
            duration, jump = jump_for(turn.duration, height, heights[0], flight_share, gravity)
            yield TurnTo(
                name="turn",
                gravity=gravity,
                roll=turn.roll,
                pitch=turn.pitch,
                yaw=turn.yaw,
                duration=duration,
                jump_height=jump,
            )
        for catch in requirement.catch or ():
            duration, jump = jump_for(catch.duration, height, heights[1], flight_share, gravity)
            yield Catch(
                name="catch",
                gravity=gravity,
                rate=(catch.roll, catch.pitch, catch.yaw),
                duration=duration,
                jump_height=jump,
            )


SETTLING, CLIMBING = 8.0, 4.0
"""Default times of a balance and of a climb, over the e-folding time of a tilt."""


def _pivoted(
    requirement: RequirementSection, gravity: float, robot: Robot
) -> Iterator[tuple[Pivoted, str]]:
    """Maneuvers requested about the pivot, each with a note on an assumed time.

    Raises:
        SpecificationError: the pivot is missing, or given but not used.
    """
    if requirement.pivot is None:
        if requirement.balance or requirement.stand_up:
            ground = format_quantity(-standing_height(robot), "mm", 3)
            raise SpecificationError(
                "requirement.pivot: is missing, but balance and stand_up need one",
                hint="Give a point in the trunk's frame, 'X,Y,Z', or an edge, 'X,Y,Z along left'; "
                f"the ground is at z = {ground}.",
            )
        return
    if not (requirement.balance or requirement.stand_up):
        raise SpecificationError(
            "requirement.pivot: given, but no maneuver uses it",
            hint="Add balance or stand_up, or leave it out.",
        )
    pivot, edge = requirement.pivot.point, requirement.pivot.along or (0.0, 0.0, 0.0)

    def with_duration(
        pivoted: Pivoted, specified: float | None, e_foldings: float
    ) -> tuple[Pivoted, str]:
        """The maneuver in the specified time, or in `e_foldings` e-folding times of a tilt."""
        pivoted = pivoted.on(robot.mass_properties)
        growth_time = format_quantity(1.0 / pivoted.growth_rate, "ms", 3)
        note = f"; the time is {e_foldings:g} times the e-folding time of a tilt, {growth_time}"
        duration = specified or e_foldings / pivoted.growth_rate
        return replace(pivoted, duration=duration), "" if specified else note

    for disturbance in requirement.balance or ():
        balance = Balance(name="balance", gravity=gravity, duration=1.0, pivot=pivot, edge=edge)
        if isinstance(disturbance, Kick):
            point, along = _hit(disturbance, robot)
            x, y, z = (disturbance.impulse * along).tolist()
            yield with_duration(replace(balance, impulse=(x, y, z), point=point), None, SETTLING)
        else:
            tilted = replace(balance, roll=disturbance.roll, pitch=disturbance.pitch)
            yield with_duration(tilted, disturbance.duration, SETTLING)
    for climb in requirement.stand_up or ():
        stand_up = StandUp(
            name="stand up",
            gravity=gravity,
            duration=1.0,
            pivot=pivot,
            edge=edge,
            roll=climb.tilt.roll,
            pitch=climb.tilt.pitch,
            actuation=Actuation.BRAKE if climb.brake else Actuation.MOTOR,
        )
        yield with_duration(stand_up, climb.tilt.duration, CLIMBING)


_WITHOUT_DEVICE = "about the centre of mass without a device"
"""Part of the note on every kick that is requested in words."""


def _kicked(kick: Kick, jump: Disturbance, robot: Robot) -> tuple[Disturbance, str]:
    """A kick during this jump, and how it was interpreted.

    A force on a free robot turns it about its centre of mass with the angular impulse r x p, and
    changes its velocity by p / m: here, of the robot without the device and with locked joints.
    """
    point, along = _hit(kick, robot)
    impulse = tuple((kick.impulse * along).tolist())
    kicked = replace(jump, name="kick", impulse=impulse, point=point).on(robot.mass_properties)
    angular_impulse = np.multiply(kicked.torque, kicked.duration)
    speed_gained = np.linalg.norm(kicked.velocity_change)
    where = ", ".join(f"{1e3 * coordinate:.3g}" for coordinate in point)
    direction = ", ".join(f"{component:.3g}" for component in along)
    default = " (from the side, as no direction is given)" if kick.along is None else ""
    link = f"{kick.point}, " if isinstance(kick.point, str) else ""
    roll, pitch, yaw = (f"{component:.3g}" for component in angular_impulse)
    spin = abs(np.linalg.solve(robot.inertia, angular_impulse)[2])
    rate = format_quantity(spin, "deg/s", 2)
    heading = f" (the yaw part turns it at {rate}, unless wheels act about the vertical)"
    return kicked, (
        f"{kick.impulse:.3g} N s at {link}({where}) mm along ({direction}){default}: "
        f"angular impulse ({roll}, {pitch}, {yaw}) N m s {_WITHOUT_DEVICE}"
        f"{heading if spin > _YAW_RATE_NOTED else ''}, which gains {speed_gained:.3g} m/s; "
        f"{jump.onset:.3g} s after lift-off, for {jump.duration:.3g} s"
    )


def assumption_with_device(assumption: str, maneuvers: Iterable[Maneuver]) -> str:
    """An assumption; one about a kick is extended by what the kick does with the device on.

    Args:
        assumption: one sentence.
        maneuvers: of robot and device.
    """
    for maneuver in maneuvers:
        kick = maneuver.push
        if kick is None or not kick.force.any():
            continue
        # A maneuver of the file may have the name of another assumption, such as "Wheel".
        if assumption.startswith(f"{maneuver.name}: ") and _WITHOUT_DEVICE in assumption:
            angular_impulse = ", ".join(
                f"{component:.3g}" for component in kick.duration * kick.torque
            )
            speed_gained = kick.duration * np.linalg.norm(kick.acceleration)
            text = f"with the device on, ({angular_impulse}) N m s and {speed_gained:.3g} m/s"
            return f"{assumption.removesuffix('.')}; {text}."
    return assumption


def _hit(kick: Kick, robot: Robot) -> tuple[Vector3, FloatArray]:
    """Point that a kick hits, in B [m], and its unit vector, shape (3,).

    By default it acts sideways, towards the middle.

    Raises:
        SpecificationError: no link has this name.
    """
    point = _frame_of(kick.point, robot) if isinstance(kick.point, str) else kick.point
    sideways = (0.0, -1.0 if point[1] > _MIDDLE_TOLERANCE else 1.0, 0.0)
    along = np.array(sideways if kick.along is None else kick.along)
    return point, np.asarray(along / np.linalg.norm(along))


def _frame_of(link: str, robot: Robot) -> Vector3:
    """Origin of a link's frame in B [m]."""
    index = robot.tree.body_of_link.get(link)
    if index is None:
        links = tuple(robot.tree.body_of_link)
        moved_links = [
            body.name for body in robot.tree.bodies if body.joint and body.joint.name == link
        ]
        raise SpecificationError(
            f"requirement.kick: the robot has no link {link!r}",
            hint=f"It is a joint: {moved_links[0]!r} is the link that it moves."
            if moved_links
            else did_you_mean(link, links) or f"Links: {', '.join(links[:_LINKS_LISTED])}",
        )
    placement = robot.tree.placements_from(robot.trunk, robot.posture)[index]
    x, y, z = (placement @ robot.tree.bodies[index].links[link]).position.tolist()
    return x, y, z


_MIDDLE_TOLERANCE = 1e-3
"""Distance from the trunk's middle plane within which a point counts as on it [m]."""

_YAW_RATE_NOTED = 0.1
"""Yaw rate above which a note says that a kick turns the robot [rad/s]."""

_LINKS_LISTED = 20
"""Most links that a message names."""
