"""Defaults for any robot: the paper's maneuvers and room on Solo12, scaled by the Froude number.

Two legged robots move alike if v^2 / (g L) is the same (Alexander and Jayes, J. Zool. 201, 1983):
lengths go with the standing height L of the trunk, times with sqrt(L / g), speeds with sqrt(g L),
and a torque that turns both alike with I / T^2.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from math import pi, radians, sqrt
from types import MappingProxyType

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import SpecificationError
from ocs_design.common.units import STANDARD_GRAVITY, format_quantity
from ocs_design.requirement.maneuver import Disturbance, Drop, Flip, Maneuver, Shove
from ocs_design.requirement.pivoted import Actuation, Balance, Pivoted, StandUp
from ocs_design.requirement.sections import RequirementSection
from ocs_design.requirement.turns import Catch, TurnTo
from ocs_design.requirement.values import Vector3, did_you_mean
from ocs_design.requirement.words import Kick, Tilt
from ocs_design.robot.robot import Robot


@dataclass(frozen=True)
class Envelope:
    """Limits of one flywheel rim, all SI.

    Attributes:
        outer_radius_max: [m]. inner_radius_min: the bore that the motor needs [m].
        height_max, height_min: along the spin axis [m].
        wall_min: of outer minus inner radius [m].
        mass_max: of one rim [kg].
        stress_safety: yield strength over the hoop stress allowed at the highest wheel speed.
    """

    outer_radius_max: float
    inner_radius_min: float
    height_max: float
    height_min: float
    wall_min: float
    mass_max: float
    stress_safety: float


LIMIT_OF_KEY: Mapping[str, str] = MappingProxyType(
    {
        "r_max": "outer_radius_max",
        "r_min": "inner_radius_min",
        "h_max": "height_max",
        "h_min": "height_min",
        "wall_min": "wall_min",
        "wheel_mass_max": "mass_max",
        "stress_safety": "stress_safety",
    }
)
"""Field of `Envelope` that each key of `[flywheel]` sets."""


LUNAR_GRAVITY = 1.62
"""[m/s^2] of the paper's back-flip, which scales with the robot but stays on the Moon."""

WHEEL_SPEED_MAX = 7200.0 * pi / 30.0
"""[rad/s], where no motor is named: Solo12's own, an Antigravity 4004 KV300, at 24 V."""

RIM_MASS_SHARE = 0.1
"""Largest mass of one rim over the robot's."""

STRESS_SAFETY = 2.0
"""Yield strength over hoop stress at the highest speed."""


@dataclass(frozen=True)
class Reference:
    """The robot that the paper's maneuvers were made for.

    Attributes:
        name: of the robot. source: of its figures.
        standing_height: of the trunk over the soles [m].
        gyration_radius: sqrt(trace(I) / m) of the standing robot [m].
        roll_inertia, pitch_inertia: of the standing robot about its centre of mass [kg m^2].
    """

    name: str
    source: str
    standing_height: float
    gyration_radius: float
    roll_inertia: float
    pitch_inertia: float


SOLO12 = Reference(
    name="Solo12",
    source="examples/solo12.urdf, standing at 80 % of its stretched legs",
    standing_height=0.272,
    gyration_radius=0.250384943,
    roll_inertia=0.0320385239,
    pitch_inertia=0.0550873600,
)


@dataclass(frozen=True)
class Scale:
    """How much larger than Solo12 a robot is; all ratios are 1 for Solo12 itself.

    Attributes:
        length: of the standing heights; of the radii of gyration for a robot without legs.
        roll_inertia, pitch_inertia: of the robots' inertias.
    """

    length: float
    roll_inertia: float
    pitch_inertia: float

    @classmethod
    def of(cls, robot: Robot) -> "Scale":
        """The scale of `robot`."""
        if robot.standing_height is None:
            length = _ratio(robot.gyration_radius, SOLO12.gyration_radius)
        else:
            length = _ratio(robot.standing_height, SOLO12.standing_height)
        return cls(
            length,
            roll_inertia=_ratio(robot.inertia[0, 0], SOLO12.roll_inertia),
            pitch_inertia=_ratio(robot.inertia[1, 1], SOLO12.pitch_inertia),
        )

    def time(self, gravity: float) -> float:
        """Ratio of times, sqrt(L / g)."""
        return sqrt(self.length * STANDARD_GRAVITY / gravity)

    def speed(self, gravity: float) -> float:
        """Ratio of speeds, sqrt(g L)."""
        return sqrt(self.length * gravity / STANDARD_GRAVITY)

    @property
    def rim(self) -> float:
        """Ratio of a rim's lengths that gives its spin inertia the ratio of the back-flip's demand.

        At the same wheel speed the demand goes with I_yy / T, and a rim of similar shape has a spin
        inertia that goes with the fifth power of its lengths. Robots of one height differ tenfold
        in mass: scaled by height alone, the rim of a heavy one would be out of reach by default.
        """
        return float(f"{(self.pitch_inertia / sqrt(self.length)) ** 0.2:.6g}")


def _ratio(figure: float, reference: float) -> float:
    """`figure` over `reference` to six digits: a posture is solved to nine, and Solo12 is 1."""
    return float(f"{figure / reference:.6g}")


def standing_height(robot: Robot) -> float:
    """Height of the trunk over the ground [m]; scaled from Solo12's for a robot without legs."""
    if robot.standing_height is not None:
        return robot.standing_height
    return SOLO12.standing_height * Scale.of(robot).length


def default_maneuvers(
    robot: Robot, gravity: float = STANDARD_GRAVITY
) -> tuple[Disturbance, Drop, Flip]:
    """The paper's three tests, exactly so for Solo12 and scaled for every other robot.

    The device does all three as it stands; the paper turns its modules to 0 deg by hand for the
    back-flip.

    Args:
        robot: to scale to.
        gravity: of the first two [m/s^2]; the back-flip is made on the Moon.
    """
    scale = Scale.of(robot)
    drop = Drop(name="drop", gravity=gravity, height=1.0 * scale.length, pitch=radians(30.0))
    back_flip = Flip(
        name="back-flip",
        gravity=LUNAR_GRAVITY,
        jump_height=1.0 * scale.length,
        angle=-2.0 * pi,
        duration=2.0 * sqrt(scale.length),
    )
    return _disturbance(scale, gravity), drop, back_flip


@dataclass(frozen=True, eq=False)
class Worded:
    """Maneuvers that were asked for in words, and what was filled in, a sentence for each."""

    maneuvers: tuple[Maneuver, ...]
    notes: tuple[str, ...]


def worded_maneuvers(asked: RequirementSection, robot: Robot) -> Worded:
    """Jumps, kicks, falls and flips that are asked for by keys of their own.

    Each kick is during each jump, each flip in each jump, each fall from each tilt; what is not
    stated is as in the paper's tests, scaled to the robot.

    Raises:
        SpecificationError: a kick hits no link of the robot, or a point off it.
    """
    gravity = STANDARD_GRAVITY if asked.gravity is None else asked.gravity
    disturbance, drop, back_flip = default_maneuvers(robot, gravity or STANDARD_GRAVITY)
    maneuvers: list[Maneuver] = []
    notes: list[str] = []

    def add(maneuver: Maneuver, note: str, told: str = "") -> None:
        """Keeps it with its summary, or what is told in its place; a second one is numbered."""
        same = sum(each.name.split()[0] == maneuver.name for each in maneuvers)
        name = f"{maneuver.name} {same + 1}" if same else maneuver.name
        maneuvers.append(replace(maneuver, name=name))
        notes.append(f"{name}: {told or maneuver.summary}{note}.")

    highest = disturbance.takeoff_velocity[1] ** 2 / (2.0 * disturbance.gravity)
    for height in asked.jump_height or (highest,):
        jump = _jump(disturbance, height)
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
            duration, jump = _jump_for(to.duration, height, heights[0], share, gravity)
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
            duration, jump = _jump_for(begun.duration, height, heights[1], share, gravity)
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
            point = _point(upset.point, robot)
            x, y, z = (upset.impulse * _along(upset, point)).tolist()
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


def _along(kick: Kick, point: Vector3) -> FloatArray:
    """Unit vector of a kick; sideways towards the middle where none is stated, shape (3,)."""
    sideways = (0.0, -1.0 if point[1] > _MIDDLE else 1.0, 0.0)
    along = np.array(sideways if kick.along is None else kick.along)
    return np.asarray(along / np.linalg.norm(along))


def _jump_for(
    duration: float | None, height: float | None, default: float, share: float, gravity: float
) -> tuple[float, float]:
    """Duration of a turn and height of its jump [s, m], of which both, one or none is stated."""
    if duration is None:
        height = default if height is None else height
        return share * sqrt(8.0 * height / gravity), height
    return duration, gravity * (duration / share) ** 2 / 8.0 if height is None else height


def _jump(like: Disturbance, height: float) -> Disturbance:
    """A vertical jump of this height [m] with the torque of another, at the same share of it."""
    upward = sqrt(2.0 * like.gravity * height)
    share = upward / like.takeoff_velocity[1]
    roll, pitch, yaw = like.torque
    return replace(
        like,
        name="jump",
        takeoff_velocity=(0.0, upward),
        torque=(roll / share, pitch / share, yaw / share),
        onset=share * like.onset,
        duration=share * like.duration,
    )


def _kicked(kick: Kick, jump: Disturbance, robot: Robot) -> tuple[Disturbance, str]:
    """A kick during this jump, and how it was understood.

    A force on a free robot turns it about its centre of mass with the angular impulse r x p, and
    moves that by p / m. Here both are those of the robot without the device, whose joints hold.
    """
    point = np.array(_point(kick.point, robot))
    along = _along(kick, _point(kick.point, robot))
    impulse = kick.impulse * along
    kicked = replace(
        jump,
        name="kick",
        impulse=tuple(impulse.tolist()),
        point=tuple(point.tolist()),
    ).on(robot.mass_properties)
    turned = np.multiply(kicked.torque, kicked.duration)
    moved = np.linalg.norm(kicked.velocity_change)
    where = ", ".join(f"{1e3 * each:.3g}" for each in point)
    direction = ", ".join(f"{each:.3g}" for each in along)
    default = " (from the side: no direction is stated)" if kick.along is None else ""
    named = f"{kick.point}, " if isinstance(kick.point, str) else ""
    roll, pitch, yaw = (f"{each:.3g}" for each in turned)
    spin = abs(np.linalg.solve(robot.inertia, turned)[2])
    rate = format_quantity(spin, "deg/s", 2)
    heading = f", whose part about z turns it by {rate}: no wheel stops that"
    return kicked, (
        f"{kick.impulse:.3g} N s at {named}({where}) mm along ({direction}){default}, as angular "
        f"impulse ({roll}, {pitch}, {yaw}) N m s about the centre of mass without a device"
        f"{heading if spin > _TURNS else ''}, and {moved:.3g} m/s; "
        f"{jump.onset:.3g} s after lift-off, for {jump.duration:.3g} s"
    )


def _point(point: Vector3 | str, robot: Robot) -> Vector3:
    """Point that a kick hits, in B [m].

    Raises:
        SpecificationError: no link has this name.
    """
    if not isinstance(point, str):
        return point
    index = robot.tree.body_of_link.get(point)
    if index is None:
        links = tuple(robot.tree.body_of_link)
        raise SpecificationError(
            f"requirement.kick: the robot has no link {point!r}",
            hint=did_you_mean(point, links) or f"Links: {', '.join(links[:_MOST_LINKS])}",
        )
    placed = robot.tree.placements_from(robot.trunk, robot.posture)[index]
    x, y, z = (placed @ robot.tree.bodies[index].links[point]).position.tolist()
    return x, y, z


_MIDDLE = 1e-3
"""Distance from the trunk's middle plane within which a point has no side [m]."""

_TURNS = 0.1
"""Rate about z above which a kick is said to turn the robot [rad/s]."""

_MOST_LINKS = 20
"""Most links that a message names."""


def example_shove(robot: Robot, gravity: float = STANDARD_GRAVITY) -> Shove:
    """The torque of the first test on the robot that stands, for twice as long.

    It is none of the paper's tests and not assumed: a figure to start from.

    Args:
        robot: to scale to. gravity: [m/s^2].
    """
    scale = Scale.of(robot)
    like, time = _disturbance(scale, gravity), scale.time(gravity)
    return Shove(
        name="shove",
        gravity=gravity,
        torque=like.torque,
        duration=2.0 * like.duration,
        settling=0.5 * time,
    )


def example_turns(robot: Robot, gravity: float = STANDARD_GRAVITY) -> tuple[TurnTo, Catch]:
    """A quarter of a turn of the heading on the Moon, and a stop: figures to start from.

    Args:
        robot: to scale to. gravity: of the stop [m/s^2].
    """
    time, on_earth = (Scale.of(robot).time(each) for each in (gravity, STANDARD_GRAVITY))
    quarter, jump = _jump_for(3.0 * on_earth, None, 0.0, 0.9, LUNAR_GRAVITY)
    stop, hop = _jump_for(0.5 * time, None, 0.0, 0.9, gravity)
    rate = (0.2 / time, 0.5 / time, 0.0)
    return (
        TurnTo(
            name="turn", gravity=LUNAR_GRAVITY, yaw=pi / 2.0, duration=quarter, jump_height=jump
        ),
        Catch(name="catch", gravity=gravity, rate=rate, duration=stop, jump_height=hop),
    )


def example_pivots(robot: Robot, gravity: float = STANDARD_GRAVITY) -> tuple[Balance, StandUp]:
    """A catch and a climb on the line below the trunk's middle: figures to start from."""
    below, time = (0.0, 0.0, -standing_height(robot)), Scale.of(robot).time(gravity)
    forward = (0.0, 1.0, 0.0)
    tilt, lying = radians(5.0), radians(45.0)
    return (
        Balance(
            name="balance",
            gravity=gravity,
            pivot=below,
            edge=forward,
            pitch=tilt,
            duration=1.5 * time,
        ),
        StandUp(
            name="stand up",
            gravity=gravity,
            pivot=below,
            edge=forward,
            pitch=lying,
            duration=time,
            actuation=Actuation.BRAKE,
        ),
    )


def default_envelope(robot: Robot) -> Envelope:
    """Room for a rim: Solo12's 100 mm by 10 mm, its lengths scaled with the demand, not rounded."""
    length = Scale.of(robot).rim
    return Envelope(
        outer_radius_max=0.050 * length,
        inner_radius_min=0.005 * length,
        height_max=0.010 * length,
        height_min=0.002 * length,
        wall_min=0.002 * length,
        mass_max=RIM_MASS_SHARE * robot.mass,
        stress_safety=STRESS_SAFETY,
    )


def _disturbance(scale: Scale, gravity: float) -> Disturbance:
    """A torque that changes the rates by what the paper's changes Solo12's, over T.

    The paper states no lift-off speed; 2.4 m/s up is assumed
    (docs/validation.md, Scenarios).
    """
    time, speed = scale.time(gravity), scale.speed(gravity)
    return Disturbance(
        name="disturbance",
        gravity=gravity,
        takeoff_velocity=(0.5 * speed, 2.4 * speed),
        torque=(0.2 * scale.roll_inertia / time**2, 0.8 * scale.pitch_inertia / time**2, 0.0),
        onset=0.1 * time,
        duration=0.05 * time,
    )
