"""Maneuvers that are asked for by keys of `[requirement]`, and what was filled in for each."""

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
from ocs_design.requirement.maneuver import Disturbance, Maneuver
from ocs_design.requirement.phrases import Kick, Tilt
from ocs_design.requirement.pivoted import Actuation, Balance, Pivoted, StandUp
from ocs_design.requirement.sections import RequirementSection
from ocs_design.requirement.turns import Catch, TurnTo
from ocs_design.requirement.values import Vector3, did_you_mean
from ocs_design.robot.robot import Robot


@dataclass(frozen=True, eq=False)
class Worded:
    """Maneuvers that were asked for in words, and what was filled in, a sentence for each."""

    maneuvers: tuple[Maneuver, ...]
    notes: tuple[str, ...]


def worded_maneuvers(asked: RequirementSection, robot: Robot, taken: Iterable[str] = ()) -> Worded:
    """Jumps, kicks, falls and flips that are asked for by keys of their own.

    Each kick is during each jump, each flip in each jump, each fall from each tilt; what is not
    stated is as in the paper's tests, scaled to the robot.

    Args:
        asked: the words.
        robot: to scale to.
        taken: names that other maneuvers have already; none of these gets one of them, or one
            that would have the same files.

    Raises:
        SpecificationError: a kick hits no link of the robot, or a point off it.
    """
    gravity = STANDARD_GRAVITY if asked.gravity is None else asked.gravity
    disturbance, drop, back_flip = default_maneuvers(robot, gravity or STANDARD_GRAVITY)
    maneuvers: list[Maneuver] = []
    notes: list[str] = []
    files = {comparable_name(name) for name in taken}

    def add(maneuver: Maneuver, note: str, told: str = "") -> None:
        """Add a maneuver with a note on it; a second one of the same name is numbered."""
        name, number = maneuver.name, 2
        while comparable_name(name) in files:
            name, number = f"{maneuver.name} {number}", number + 1
        files.add(comparable_name(name))
        maneuvers.append(replace(maneuver, name=name))
        notes.append(f"{name}: {told or maneuver.summary}{note}.")

    highest = disturbance.takeoff_velocity[1] ** 2 / (2.0 * disturbance.gravity)
    for height in asked.jump_height or (highest,):
        # A vertical jump with the torque of the paper's first test, at the same share of it.
        upward = sqrt(2.0 * disturbance.gravity * height)
        longer = upward / disturbance.takeoff_velocity[1]
        roll, pitch, yaw = disturbance.torque
        jump = replace(
            disturbance,
            name="jump",
            takeoff_velocity=(0.0, upward),
            torque=(roll / longer, pitch / longer, yaw / longer),
            onset=longer * disturbance.onset,
            duration=longer * disturbance.duration,
        )
        assumed = " (the paper's, scaled)" if asked.jump_height is None else ""
        of_jump = f", in a vertical jump of {height:.3g} m{assumed}"
        for kick in asked.kick or ():
            kicked, told = _kicked(kick, jump, robot)
            add(kicked, of_jump, told)
        if asked.jump_height and not any((asked.kick, asked.flip, asked.turn, asked.catch)):
            add(jump, f"{of_jump}; the torque is that of the paper's first test, scaled")
    share = back_flip.duration / back_flip.flight_time
    heights = back_flip.jump_height, highest
    turns = ((turn, "") for turn in _turns(asked, gravity, share, heights))
    for each, note in chain(turns, _pivoted(asked, gravity, robot)):
        add(each, note)
    for height in asked.jump_height or (back_flip.jump_height,):
        for angle in asked.flip or ():
            flip = replace(back_flip, name="flip", gravity=gravity, jump_height=height, angle=angle)
            note = f", {share:.0%} of the flight as in the paper"
            if asked.jump_height is None:
                note += "; the jump's height is the paper's, scaled"
            add(replace(flip, duration=share * flip.flight_time), note)
    if asked.fall or asked.tilt:
        for height in asked.fall or (drop.height,):
            for tilt in asked.tilt or (Tilt(drop.roll, drop.pitch),):
                fall = replace(drop, name="fall", height=height, roll=tilt.roll, pitch=tilt.pitch)
                feet = format_quantity(height - standing_height(robot), "mm", 3)
                note = f", the feet of the level robot {feet} above the ground"
                if asked.tilt is None:
                    note += "; the tilt is the paper's"
                if asked.fall is None:
                    note += "; the height is the paper's, scaled"
                add(fall, note)
    return Worded(tuple(maneuvers), tuple(notes))


def _turns(
    asked: RequirementSection, gravity: float, share: float, heights: tuple[float, float]
) -> Iterator[TurnTo]:
    """Turns and stops that are asked for, in every jump.

    Args:
        asked: see `worded_maneuvers`. gravity: [m/s^2].
        share: of its flight that a turn takes where its time or its jump is not stated.
        heights: of the jump of a turn and of a stop, where neither is [m].
    """
    for height in asked.jump_height or (None,):
        for to in asked.turn or ():
            duration, jump = jump_for(to.duration, height, heights[0], share, gravity)
            yield TurnTo(
                name="turn",
                gravity=gravity,
                roll=to.roll,
                pitch=to.pitch,
                yaw=to.yaw,
                duration=duration,
                jump_height=jump,
            )
        for begun in asked.catch or ():
            duration, jump = jump_for(begun.duration, height, heights[1], share, gravity)
            yield Catch(
                name="catch",
                gravity=gravity,
                rate=(begun.roll, begun.pitch, begun.yaw),
                duration=duration,
                jump_height=jump,
            )


SETTLING, CLIMBING = 8.0, 4.0
"""Times of a catch and of a climb where none is stated, over that in which a tilt grows e-fold."""


def _pivoted(
    asked: RequirementSection, gravity: float, robot: Robot
) -> Iterator[tuple[Pivoted, str]]:
    """What is asked for about the pivot, and a note on the time that was assumed.

    Raises:
        SpecificationError: no pivot is stated, or nothing that happens on it.
    """
    if asked.pivot is None:
        if asked.balance or asked.stand_up:
            ground = format_quantity(-standing_height(robot), "mm", 3)
            raise SpecificationError(
                "requirement.pivot: is missing: what does the robot balance or stand up on?",
                hint="State a point in the trunk's frame, 'X,Y,Z', or an edge, 'X,Y,Z along left'; "
                f"the ground is at z = {ground}.",
            )
        return
    if not (asked.balance or asked.stand_up):
        raise SpecificationError(
            "requirement.pivot: nothing happens on it",
            hint="Ask for balance or stand_up, or leave it out.",
        )
    pivot, edge = asked.pivot.point, asked.pivot.along or (0.0, 0.0, 0.0)

    def lasting(one: Pivoted, stated: float | None, times: float) -> tuple[Pivoted, str]:
        """The maneuver in the time that is stated, or in so many e-foldings of a tilt."""
        one = one.on(robot.mass_properties)
        grows = format_quantity(1.0 / one.quickness, "ms", 3)
        note = f"; the time is {times:g} times that in which a tilt grows e-fold, {grows}"
        return replace(one, duration=stated or times / one.quickness), "" if stated else note

    for upset in asked.balance or ():
        caught = Balance(name="balance", gravity=gravity, duration=1.0, pivot=pivot, edge=edge)
        if isinstance(upset, Kick):
            point, along = _hit(upset, robot)
            x, y, z = (upset.impulse * along).tolist()
            yield lasting(replace(caught, impulse=(x, y, z), point=point), None, SETTLING)
        else:
            tilted = replace(caught, roll=upset.roll, pitch=upset.pitch)
            yield lasting(tilted, upset.duration, SETTLING)
    for climb in asked.stand_up or ():
        up = StandUp(
            name="stand up",
            gravity=gravity,
            duration=1.0,
            pivot=pivot,
            edge=edge,
            roll=climb.tilt.roll,
            pitch=climb.tilt.pitch,
            actuation=Actuation.BRAKE if climb.brake else Actuation.MOTOR,
        )
        yield lasting(up, climb.tilt.duration, CLIMBING)


def _kicked(kick: Kick, jump: Disturbance, robot: Robot) -> tuple[Disturbance, str]:
    """A kick during this jump, and how it was understood.

    A force on a free robot turns it about its centre of mass with the angular impulse r x p, and
    moves that by p / m. Here both are those of the robot without the device, whose joints hold.
    """
    point, along = _hit(kick, robot)
    impulse = tuple((kick.impulse * along).tolist())
    kicked = replace(jump, name="kick", impulse=impulse, point=point).on(robot.mass_properties)
    turned = np.multiply(kicked.torque, kicked.duration)
    moved = np.linalg.norm(kicked.velocity_change)
    where = ", ".join(f"{1e3 * each:.3g}" for each in point)
    direction = ", ".join(f"{each:.3g}" for each in along)
    default = " (from the side: no direction is stated)" if kick.along is None else ""
    named = f"{kick.point}, " if isinstance(kick.point, str) else ""
    roll, pitch, yaw = (f"{each:.3g}" for each in turned)
    spin = abs(np.linalg.solve(robot.inertia, turned)[2])
    rate = format_quantity(spin, "deg/s", 2)
    heading = f" (no wheel stops the part about z, which turns it by {rate})"
    return kicked, (
        f"{kick.impulse:.3g} N s at {named}({where}) mm along ({direction}){default}: "
        f"angular impulse ({roll}, {pitch}, {yaw}) N m s about the centre of mass without a device"
        f"{heading if spin > _TURNS else ''}, which gets {moved:.3g} m/s; "
        f"{jump.onset:.3g} s after lift-off, for {jump.duration:.3g} s"
    )


def told_with_device(assumption: str, maneuvers: Iterable[Maneuver]) -> str:
    """An assumption; one about a kick also says what the kick does with the device on.

    Args:
        assumption: one sentence.
        maneuvers: of robot and device.
    """
    for kick in maneuvers:
        if not isinstance(kick, Disturbance) or not any(kick.impulse):
            continue
        if assumption.startswith(f"{kick.name}: "):
            turned = ", ".join(f"{each * kick.duration:.3g}" for each in kick.torque)
            moved = np.linalg.norm(kick.velocity_change)
            told = f"with the device on, ({turned}) N m s and {moved:.3g} m/s"
            return f"{assumption.removesuffix('.')}; {told}."
    return assumption


def _hit(kick: Kick, robot: Robot) -> tuple[Vector3, FloatArray]:
    """Point that a kick hits, in B [m], and its unit vector, shape (3,).

    Where no direction is stated, it is sideways towards the middle.

    Raises:
        SpecificationError: no link has this name.
    """
    point = _frame_of(kick.point, robot) if isinstance(kick.point, str) else kick.point
    sideways = (0.0, -1.0 if point[1] > _MIDDLE else 1.0, 0.0)
    along = np.array(sideways if kick.along is None else kick.along)
    return point, np.asarray(along / np.linalg.norm(along))


def _frame_of(link: str, robot: Robot) -> Vector3:
    """Origin of a link's frame in B [m]."""
    index = robot.tree.body_of_link.get(link)
    if index is None:
        links = tuple(robot.tree.body_of_link)
        moved = [each.name for each in robot.tree.bodies if each.joint and each.joint.name == link]
        raise SpecificationError(
            f"requirement.kick: the robot has no link {link!r}",
            hint=f"It is a joint: {moved[0]!r} is the link that it moves."
            if moved
            else did_you_mean(link, links) or f"Links: {', '.join(links[:_MOST_LINKS])}",
        )
    placed = robot.tree.placements_from(robot.trunk, robot.posture)[index]
    x, y, z = (placed @ robot.tree.bodies[index].links[link]).position.tolist()
    return x, y, z


_MIDDLE = 1e-3
"""Distance from the trunk's middle plane within which a point has no side [m]."""

_TURNS = 0.1
"""Rate about z above which a kick is said to turn the robot [rad/s]."""

_MOST_LINKS = 20
"""Most links that a message names."""
