"""Parts of a maneuver that a user writes as one text: a kick, a tilt, a turn."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from reprlib import repr as shortened
from types import MappingProxyType

from ocs_design.common.errors import SpecificationError
from ocs_design.common.units import Dimension
from ocs_design.requirement.values import (
    MASS,
    MOST_TURNS,
    ONE_TURN,
    TILT,
    TIME,
    TUMBLE,
    TURN,
    YAW,
    NamedQuantity,
    Quantities,
    Quantity,
    Sign,
    Text,
    Vector3,
    form,
)

DIRECTIONS: Mapping[str, Vector3] = MappingProxyType(
    {
        "forward": (1.0, 0.0, 0.0),
        "backward": (-1.0, 0.0, 0.0),
        "left": (0.0, 1.0, 0.0),
        "right": (0.0, -1.0, 0.0),
        "up": (0.0, 0.0, 1.0),
        "down": (0.0, 0.0, -1.0),
    }
)
"""Unit vectors in B, by name."""

SIDES: Mapping[str, Vector3] = MappingProxyType(
    {
        "left": DIRECTIONS["right"],
        "right": DIRECTIONS["left"],
        "front": DIRECTIONS["backward"],
        "behind": DIRECTIONS["forward"],
        "above": DIRECTIONS["down"],
        "below": DIRECTIONS["up"],
    }
)
"""Directions of a kick, by the side it comes from."""

FLIP = NamedQuantity(
    Dimension.ANGLE,
    Sign.ANY,
    MOST_TURNS * 2.0 * pi,
    ONE_TURN,
    "deg",
    words={"back": -2.0 * pi, "forward": 2.0 * pi},
)


def _placed(point: Vector3 | str, along: Vector3 | None) -> str:
    """A point or a link, with its direction if there is one, in the form that is parsed."""
    at = point if isinstance(point, str) else ",".join(map(repr, point))
    return at if along is None else f"{at} along {','.join(map(repr, along))}"


@dataclass(frozen=True)
class Kick:
    """An impulse at a point of the trunk.

    Attributes:
        impulse: its size [N s].
        point: in B [m], or the name of a link whose frame's origin it is.
        along: its direction in B, of any length; None: from the side.
    """

    impulse: float
    point: Vector3 | str
    along: Vector3 | None = None

    def __str__(self) -> str:
        return f"{self.impulse!r} N s at {_placed(self.point, self.along)}"


_KICK = re.compile(
    r"\s*(.+?)\s+at\s+(.+?)(?:\s+along\s+(.+?)|\s+from\s+(?:the\s+)?(.+?))?\s*", re.I
)
_FORCE = re.compile(r"[\d.]+\s*k?N", re.I)
_SPACED = re.compile(r"(?:[-+.\d][^\s,]*\s+){2}[-+.\d][^\s,]*")


@form(
    "IMPULSE at X,Y,Z or LINK, optionally along X,Y,Z or a word such as left, or from a side "
    "such as behind"
)
def kick_text(raw: object, where: str) -> Kick:
    """A kick: how much, where, and in which direction."""
    parts = _KICK.fullmatch(raw) if isinstance(raw, str) else None
    if parts is None:
        raise SpecificationError(
            f"{where}: {shortened(raw)} must give an impulse and where it acts",
            hint="Write '12 N s at 0.1,0,0.2', '12 N s at FL_hip' or "
            "'12 N s at 0.1,0,0.2 along 0,1,0'; metres in the trunk's frame.",
        )
    impulse, at, along, side = parts.groups()
    if _FORCE.fullmatch(impulse):
        raise SpecificationError(
            f"{where}: {impulse} is a force, but a kick is an impulse: force times time",
            hint="Write 50 N for 10 ms as '0.5 N s'.",
        )
    if _SPACED.fullmatch(at):
        at = ",".join(at.split())
    direction = None if along is None else _direction(along, f"{where}, along")
    if side is not None:
        if side.casefold() not in SIDES:
            raise SpecificationError(
                f"{where}: {shortened(side)} is not a side",
                hint=f"Write one of {', '.join(SIDES)}, or 'along 0,1,0'.",
            )
        direction = SIDES[side.casefold()]
    return Kick(
        Quantity(Dimension.IMPULSE).read(impulse, where),
        _row(at, Dimension.LENGTH, f"{where}, at") if "," in at else Text().read(at, where),
        direction,
    )


@dataclass(frozen=True)
class Person:
    """Mass and payload [kg] and height [m] of a person."""

    mass: float
    height: float
    payload: float = 0.0

    def __str__(self) -> str:
        carrying = f" with {self.payload!r} kg" if self.payload else ""
        return f"{self.mass!r} kg {self.height!r} m{carrying}"


_PERSON = re.compile(r"\s*([\d.]+ *[a-z]+)[\s,]+([\d.]+ *[a-z]+)(?:\s+with\s+(.+?))?\s*", re.I)


@form("MASS HEIGHT, optionally with PAYLOAD")
def person_text(raw: object, where: str) -> Person:
    """A person: mass, height and, if there is any, payload."""
    parts = _PERSON.fullmatch(raw) if isinstance(raw, str) else None
    if parts is None:
        raise SpecificationError(
            f"{where}: {shortened(raw)} must give a mass and a height",
            hint="Write '75kg 1.75m', or '75kg 1.75m with 10kg'.",
        )
    mass, height, payload = parts.groups()
    return Person(
        MASS.read(mass, f"{where}, mass"),
        Quantity(Dimension.LENGTH, most=3.0).read(height, f"{where}, height"),
        MASS.read(payload, f"{where}, payload") if payload else 0.0,
    )


@dataclass(frozen=True)
class Tilt:
    """Roll and pitch at release [rad]."""

    roll: float
    pitch: float

    def __str__(self) -> str:
        return f"{self.roll!r} rad roll {self.pitch!r} rad pitch"


TILTED: Mapping[str, tuple[str, float]] = MappingProxyType(
    {
        "roll": ("roll", 1.0),
        "pitch": ("pitch", 1.0),
        "left": ("roll", -1.0),
        "right": ("roll", 1.0),
        "forward": ("pitch", 1.0),
        "backward": ("pitch", -1.0),
    }
)
"""Axis and sign of a tilt, by the axis's name or the lower side."""


_TILT = re.compile(rf"\s*(.+?)\s*\b({'|'.join(TILTED)})\b", re.IGNORECASE)


@form(f"{TILT.takes}; of pitch, or as in '20deg roll', '20deg left', '10deg roll 20deg pitch'")
def tilt_text(raw: object, where: str) -> Tilt:
    """A tilt: an angle of pitch, or angles with their axes."""
    angles: dict[str, float] = {}
    rest = raw
    while isinstance(rest, str) and (part := _TILT.match(rest)):
        angle, word = part.groups()
        axis, sign = TILTED[word.casefold()]
        if axis in angles:
            raise SpecificationError(
                f"{where}: {shortened(raw)} gives {axis} twice",
                hint="Write '20deg roll', or '10deg roll 20deg pitch'.",
            )
        angles[axis] = sign * TILT.read(angle, where)
        rest = rest[part.end() :]
    if not angles:
        return Tilt(0.0, TILT.read(raw, where))
    if isinstance(rest, str) and rest.strip():
        raise SpecificationError(
            f"{where}: {shortened(raw)} is not a tilt", hint="Write '20deg' or '20deg roll'."
        )
    return Tilt(angles.get("roll", 0.0), angles.get("pitch", 0.0))


@dataclass(frozen=True)
class About:
    """Angles or rates about roll, pitch and yaw, and the time allowed.

    Attributes:
        roll, pitch, yaw: [rad] or [rad/s].
        duration: [s]; None: not given.
        unit: of the three.
    """

    roll: float
    pitch: float
    yaw: float
    duration: float | None
    unit: str

    def __str__(self) -> str:
        axes = {"roll": self.roll, "pitch": self.pitch, "yaw": self.yaw}
        said = " ".join(f"{axis} {value!r} {self.unit}" for axis, value in axes.items())
        return said if self.duration is None else f"{said} in {self.duration!r} s"


@dataclass(frozen=True)
class AboutText:
    """Angles or rates, each with its axis before or after it, and a time at the end.

    Attributes:
        values: parser of each axis's value. unit: of the parsed values.
        example: of such a text.
    """

    values: Mapping[str, Quantity]
    unit: str
    example: str

    @property
    def takes(self) -> str:
        """What may be written, in words (`Value.takes`)."""
        return f"as in {self.example!r}"

    def read(self, raw: object, where: str) -> About:
        """Value that `raw` stands for (`Value.read`)."""
        said, _, time = raw.partition(" in ") if isinstance(raw, str) else ("", "", "")
        parts = [part.strip() for part in re.split(r"\b(roll|pitch|yaw)\b", said, flags=re.I)]
        # The axis comes before its value, or after it.
        before = not parts[0]
        axes, specified = parts[1::2], parts[2::2] if before else parts[:-1:2]
        rest = "" if before else parts[-1]
        words = [axis.casefold() for axis in axes]
        if not axes or rest or not all(specified) or len(set(words)) < len(words):
            raise SpecificationError(
                f"{where}: {shortened(raw)} must give each value with its axis",
                hint=f"Write {self.example!r}.",
            )
        amounts = {
            axis: self.values[axis].read(value, f"{where}, {axis}")
            for axis, value in zip(words, specified, strict=True)
        }
        return About(
            **{axis: amounts.get(axis, 0.0) for axis in self.values},
            duration=TIME.read(time, f"{where}, in") if time else None,
            unit=self.unit,
        )


TURN_TEXT = AboutText(
    MappingProxyType({"roll": TURN, "pitch": TURN, "yaw": YAW}), "rad", "yaw 90deg in 2.9s"
)
CATCH_TEXT = AboutText(
    MappingProxyType(dict.fromkeys(("roll", "pitch", "yaw"), TUMBLE)),
    "rad/s",
    "roll 20deg/s pitch 45deg/s in 0.5s",
)


TILT_TEXT = AboutText(
    MappingProxyType(dict.fromkeys(("roll", "pitch", "yaw"), TILT)), "rad", "pitch 5deg in 1s"
)


def _tilt(raw: object, where: str) -> About:
    """A tilt from upright, without yaw."""
    tilt = TILT_TEXT.read(raw, where)
    if tilt.yaw:
        raise SpecificationError(
            f"{where}: yaw is not a tilt", hint=f"Write {TILT_TEXT.example!r}, or roll."
        )
    return tilt


@form(f"{TILT_TEXT.takes}, or {kick_text.takes}")
def upset_text(raw: object, where: str) -> About | Kick:
    """Disturbance that a robot on a pivot must recover from: a tilt, or an impulse."""
    kicked = isinstance(raw, str) and " at " in raw
    return kick_text.read(raw, where) if kicked else _tilt(raw, where)


@dataclass(frozen=True)
class Climb:
    """A tilt that a robot stands up from, and whether by braking its wheels."""

    tilt: About
    brake: bool

    def __str__(self) -> str:
        return f"{self.tilt}{_BY_BRAKE if self.brake else ''}"


_BY_BRAKE = " by brake"


@form("as in 'roll 45deg in 0.5s', 'roll 45deg by brake'")
def climb_text(raw: object, where: str) -> Climb:
    """A tilt, optionally with a time and with `by brake`."""
    brake = isinstance(raw, str) and raw.casefold().rstrip().endswith(_BY_BRAKE)
    tilt = str(raw).rstrip()[: -len(_BY_BRAKE)] if brake else raw
    return Climb(_tilt(tilt, where), brake)


@dataclass(frozen=True)
class Pivot:
    """A point in B that a robot stands on [m], and the direction of its edge; None: a point."""

    point: Vector3
    along: Vector3 | None = None

    def __str__(self) -> str:
        return _placed(self.point, self.along)


@form("X,Y,Z; for an edge, also along X,Y,Z or a word such as left")
def pivot_text(raw: object, where: str) -> Pivot:
    """A point, and the direction of an edge through it."""
    point, _, along = raw.partition(" along ") if isinstance(raw, str) else ("", "", "")
    if "," not in point:
        raise SpecificationError(
            f"{where}: {shortened(raw)} is not a point",
            hint="Write '0,0,-0.2', or '0,0,-0.2 along left' for an edge; metres in the "
            "trunk's frame.",
        )
    at = _row(point, Dimension.LENGTH, where)
    return Pivot(at, _direction(along.strip(), f"{where}, along") if along else None)


def _direction(text: str, where: str) -> Vector3:
    """Three numbers, not all zero, or one of `DIRECTIONS`."""
    if text.casefold() in DIRECTIONS:
        return DIRECTIONS[text.casefold()]
    if "," not in text:
        raise SpecificationError(
            f"{where}: {shortened(text)} is not a direction",
            hint=f"Write 0,1,0, or one of {', '.join(DIRECTIONS)}.",
        )
    row = _row(text, Dimension.RATIO, where)
    if not any(row):
        raise SpecificationError(f"{where}: {text} is not a direction", hint="Write 0,1,0.")
    return row


def _row(text: str, dimension: Dimension, where: str) -> Vector3:
    x, y, z = Quantities(dimension, (3,)).read(text, where)
    return x, y, z
