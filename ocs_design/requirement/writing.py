"""A specification as text: the same keys again, or a commented file to start from.

What a key is and how it is read is in `specification`; what holds where it is not stated is in
`defaults`. Here is only what people need besides.
"""

import json
import os
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from functools import partial
from math import isclose
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ocs_design.common.units import (
    Dimension,
    format_quantity,
    parse_quantity,
    si_unit,
)
from ocs_design.requirement.kinds import kind_of
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.specification import SECTIONS, Specification, all_keys
from ocs_design.requirement.uncertainty import Distribution, Spread
from ocs_design.requirement.values import (
    ONE_TURN,
    Key,
    Quantities,
    Quantity,
    Several,
    Value,
    WordOr,
    keys_of,
)
from ocs_design.requirement.words import About, Climb, Kick, Person, Pivot, Tilt

PEOPLE_UNITS: Mapping[Dimension, str] = {
    Dimension.LENGTH: "mm",
    Dimension.ANGLE: "deg",
    Dimension.ANGULAR_SPEED: "rpm",
}
"""Units that people think in, where they are not SI's."""

_SAME = 1e-12
"""Relative; a degree is no finite number of radians."""


class Figures(Enum):
    """How numbers are written."""

    SI = auto()
    """In SI, to the last bit."""
    EXACT = auto()
    """In units that people think in if nothing is lost by it, else in SI."""
    ROUNDED = auto()
    """In units that people think in, to four digits."""


def specification_to_toml(specification: Specification, comment: str = "") -> str:
    """Everything that is stated, in SI with units and full digits.

    Args:
        specification: what to write; what it does not state is left out.
        comment: for people, at the top; may have several lines.
    """
    lines = [f"# {line}".rstrip() for line in comment.splitlines()]
    for name, section in SECTIONS.items():
        how = {key: found.value for key, found in keys_of(section).items()}
        specified = list(_fields(getattr(specification, name), how))
        lines += ["", f"[{name}]", *specified] if specified else []
    for maneuver in specification.maneuvers:
        word, values = kind_of(maneuver)
        lines += ["", "[[maneuver]]", f"kind = {_text(word)}", *_fields(maneuver, values)]
    return "\n".join(lines).lstrip("\n") + "\n"


def with_absolute_files(specification: Specification) -> Specification:
    """Specification whose files are found from any folder: their paths are made absolute."""
    return _with_files(specification, lambda file: str(Path(file).absolute()))


def with_files_from(specification: Specification, folder: Path) -> Specification:
    """Specification whose files are found from `folder`, also after both were moved together."""
    return _with_files(specification, lambda file: os.path.relpath(file, folder))


def _with_files(specification: Specification, renamed: Callable[[str], str]) -> Specification:
    """`-` is standard input."""

    def path(file: str | None) -> str | None:
        """Path under its new name."""
        return file if file is None or file == "-" else renamed(file)

    robot, motor, reality = specification.robot, specification.motor, specification.reality
    return replace(
        specification,
        robot=replace(robot, file=path(robot.file)),
        motor=replace(motor, motors=path(motor.motors), gears=path(motor.gears)),
        reality=replace(reality, file=path(reality.file)),
    )


def _fields(specified: object, values: Mapping[str, Value[Any]]) -> Iterator[str]:
    """Line of each field of a section or a maneuver that has a value."""
    for name, how in values.items():
        value = getattr(specified, name)
        if value is not None:
            yield f"{name} = {written(value, how)}"


def written(  # noqa: PLR0911
    value: object, how: Value[Any], figures: Figures = Figures.SI
) -> str:
    """Value as TOML, a quantity with its unit: some are not believed without one."""
    match how, value:
        case WordOr(quantity=quantity), float() | int():
            return written(value, quantity, figures)
        case Quantity(dimension=dimension), float() | int():
            small = dimension is not Dimension.LENGTH or abs(value) < 1.0
            unit = PEOPLE_UNITS.get(dimension, si_unit(dimension)) if small else si_unit(dimension)
            return _text(_told(value, dimension, unit, figures))
        case Spread(dimension=dimension), Distribution():
            told = partial(_told, dimension=dimension, unit=how.unit, figures=figures)
            return _text(value.written(told))
        case Several(each=each), Sequence():
            return f"[{', '.join(written(entry, each, figures) for entry in value)}]"
        case Quantities(dimension=Dimension.RATIO), Sequence():
            return _plain(tuple(value))
        case Quantities(dimension=dimension), Sequence():
            return written(value, Several(Quantity(dimension)), figures)
        case _, float() if figures is Figures.ROUNDED:
            return f"{value:.4g}"
        case _:
            return _plain(value)


def _told(value: float, dimension: Dimension, unit: str, figures: Figures) -> str:
    """Quantity in `unit` or in SI, as `figures` asks."""
    if figures is Figures.ROUNDED:
        return format_quantity(value, unit)
    told = format_quantity(value, unit, digits=12)
    if figures is Figures.EXACT and isclose(
        parse_quantity(told, dimension, ""), value, rel_tol=_SAME
    ):
        return told
    bare = _plain(value)
    return bare if dimension is Dimension.RATIO else f"{bare} {si_unit(dimension)}"


def _plain(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str() | Kick() | Person() | Tilt() | About() | Climb() | Pivot():
            return _text(str(value))
        case tuple():
            return f"[{', '.join(map(_plain, value))}]"
        case float():
            # NumPy's own floats are floats too, and call themselves by their type.
            return repr(float(value))
        case Mapping():
            # A bare number beyond a turn would be taken for degrees, and refused.
            joints = {
                name: _plain(entry) if abs(entry) <= ONE_TURN else _text(f"{float(entry)!r} rad")
                for name, entry in value.items()
            }
            pairs = ", ".join(f"{_text(name)} = {entry}" for name, entry in joints.items())
            return f"{{ {pairs} }}"
        case _:
            return repr(value)


def _text(text: str) -> str:
    """A basic string; TOML escapes what JSON does, and the delete character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


@dataclass(frozen=True)
class KeyNote:
    """Note on one key: why it would be specified, and what it changes.

    Attributes:
        why: one line, when to state it.
        default: what holds where nothing is stated, in words; empty: the value says it all.
        example: a value as it is written in TOML, where there is no default to show.
    """

    why: str
    default: str = ""
    example: str = ""


KEY_NOTES: Mapping[str, KeyNote] = MappingProxyType(
    {
        "robot.file": KeyNote(
            "Mass, inertia and legs are read from it; from the folder of this file.",
            "the robot on the command line",
            '"robot.urdf"',
        ),
        "robot.name": KeyNote(
            "Names the output folder of a robot by hand.", "the file's own", '"robot"'
        ),
        "robot.trunk": KeyNote(
            "State it where the wrong link was found to carry the legs.", "found", '"trunk"'
        ),
        "robot.legs": KeyNote(
            "State them where the wrong limbs were found to be legs.",
            "found",
            '["FL_FOOT", "FR_FOOT"]',
        ),
        "robot.posture": KeyNote(
            "The inertia, and with it all else, is that of this posture.",
            "stand where legs are found",
            '"stand"',
        ),
        "robot.joints": KeyNote(
            "For a posture that has no name.", "none", '{ "FL_HFE" = "45deg", "FL_KFE" = "-90deg" }'
        ),
        "robot.mass": KeyNote("In place of a file, with the inertia.", "read", '"2.5 kg"'),
        "robot.inertia": KeyNote(
            "In place of a file, with the mass.", "read", "[0.032, 0.055, 0.070]"
        ),
        "robot.human": KeyNote(
            "In place of a file: mass, height, payload.",
            "read",
            '"75kg 1.75m with 10kg"',
        ),
        "robot.weighed": KeyNote(
            "Tells when the parts in the file do not add up to it.", "not checked", '"2.5 kg"'
        ),
        "requirement.rate_change": KeyNote(
            "The paper's requirement: asked of either axis, on top of the maneuvers.",
            "not asked",
            '"2 rad/s"',
        ),
        "requirement.wheel_speed_max": KeyNote(
            "What bearings and balance stand, if less than the motor can do.",
            "the motor's own; 7200 rpm without a motor",
            '"7200 rpm"',
        ),
        "requirement.spin_inertia": KeyNote(
            "For a wheel that you have already; nothing else is then asked.",
            "found",
            '"7.11e-5 kg m2"',
        ),
        "requirement.gravity": KeyNote(
            "1.62 m/s2 is the Moon's; the paper's back-flip stays there."
        ),
        "requirement.jump_height": KeyNote(
            "Alone: disturbed as in the paper's first test; else the jump of each kick and flip.",
            "not asked",
            '"0.4 m"',
        ),
        "requirement.kick": KeyNote(
            "On the trunk during a jump; one without `along` comes from the side.",
            "not asked",
            '"12 N s at 0.1,0,0.2 along 0,1,0"',
        ),
        "requirement.fall": KeyNote(
            "The trunk is released at rest so high over the ground, tilted.",
            "not asked",
            '"1 m"',
        ),
        "requirement.tilt": KeyNote(
            "Of each fall, nose down; roll: to the right.", "not asked", '"20 deg"'
        ),
        "requirement.flip": KeyNote("A whole turn, or an angle of pitch.", "not asked", '"back"'),
        "requirement.turn": KeyNote(
            "To an attitude, heading included, in a time.", "not asked", '"yaw 90 deg in 2.9 s"'
        ),
        "requirement.catch": KeyNote(
            "Rates of the trunk at lift-off; to be level in a time.",
            "not asked",
            '"roll 20 deg/s pitch 45 deg/s in 0.5 s"',
        ),
        "requirement.pivot": KeyNote(
            "Of balance and stand_up, in the trunk's frame, below the centre of mass.",
            "not asked",
            '"0,0,-0.2 along left"',
        ),
        "requirement.balance": KeyNote(
            "To be upright again on the pivot: a tilt from where it balances, or an impulse.",
            "not asked",
            '"pitch 5 deg in 1 s"',
        ),
        "requirement.stand_up": KeyNote(
            "From a tilt to upright on the pivot, by the motors or by stopping the wheels.",
            "not asked",
            '"pitch 45 deg by brake"',
        ),
        "requirement.maneuvers": KeyNote(
            "paper: beside a rate_change or a spin_inertia; leave it out where you state your own."
        ),
        "requirement.reliability": KeyNote(
            "0.5: sized for a robot just as its file says; more keeps a reserve for [reality]."
        ),
        "requirement.survives": KeyNote(
            "any one motor, or one: sized and flown so that it lands level whichever drive stops, "
            "at any instant of a maneuver; its wheel runs on."
        ),
        "requirement.detection": KeyNote("Until then the other drives go on as before."),
        "ocs.layout": KeyNote(
            "double-pair, triple-pair: four and six wheels at a pair's axes; single: on pitch; "
            "triad: three in the horizontal plane; orthogonal: x, y, z; pyramid: four. "
            "All but pairs and pyramid have no angle.",
        ),
        "ocs.axes": KeyNote(
            "x, y, z of each wheel's axis, of any length; in place of a layout.",
            "as the layout says",
            "[0, 1, 0, 1, 0, 0]",
        ),
        "ocs.alpha": KeyNote(
            "Where mounts for one angle exist already.", "by the criterion below", '"40 deg"'
        ),
        "ocs.alpha_criterion": KeyNote(
            "equal-rate is the paper's: the same change of rate about either axis; lightest: any.",
        ),
        "ocs.position": KeyNote(
            "In the trunk's frame; a pair's right wheel is mirrored in y.",
            "found, free of the robot's own parts",
            '["0 mm", "50 mm", "70 mm"]',
        ),
        "ocs.mass_max": KeyNote(
            "What the robot may carry: if the lightest device is heavier, there is none.",
            "not limited",
            '"1 kg"',
        ),
        "ocs.lighter_by": KeyNote(
            "Each answer is sized as a whole: it takes a minute.", "not asked", '"90 g"'
        ),
        "ocs.co_design": KeyNote(
            "0 to 0.8 % lighter on the robots tried, and seconds slower to find."
        ),
        "ocs.guard": KeyNote(
            "containing: a ring of mild steel in each housing that holds a third of the rim at top "
            "speed, by a formula that nobody has tested on such rings."
        ),
        "ocs.wheel": KeyNote(
            "ring: bonded around the bell of an outrunner, as Mini Wheelbot has it; a flat module, "
            "heavier where the wheel wants to be wide."
        ),
        "flywheel.r_max": KeyNote(
            "Of the rim: its housing adds 3.6 mm all around. The wider the rim, the lighter."
        ),
        "flywheel.r_min": KeyNote("Room for the motor's shaft or can inside the rim."),
        "flywheel.h_max": KeyNote("The room along the spin axis."),
        "flywheel.h_min": KeyNote("What your lathe or printer still makes well."),
        "flywheel.wall_min": KeyNote("The same across the rim."),
        "flywheel.wheel_mass_max": KeyNote("What the trunk may carry on each side."),
        "flywheel.material": KeyNote(
            "steel: any; auto: any material; or one of `ocs-design catalogue materials`.",
        ),
        "flywheel.web": KeyNote("none is the paper's: spokes that weigh nothing."),
        "flywheel.lightening": KeyNote(
            "They take two fifths of the web, 3 mm of spoke is left; fewer parts to drill: 0."
        ),
        "flywheel.stress_safety": KeyNote("More where a burst rim could hurt someone."),
        "flywheel.chamfer": KeyNote("What your workshop breaks edges by; it is counted."),
        "flywheel.balancing_holes": KeyNote(
            "At least three, where weights are to balance the wheel; its wall grows to fit them."
        ),
        "flywheel.balancing_hole_diameter": KeyNote("1.6 mm is the core hole of M2."),
        "flywheel.balancing_hole_depth": KeyNote(
            "A thread of M2 wants 2 mm; both faces have them, so that the rim grows too."
        ),
        "motor.name": KeyNote(
            "Those that you have: see `ocs-design catalogue motors`; none: the bound alone."
        ),
        "motor.gear": KeyNote(
            "auto: any of `ocs-design catalogue gears`; how they are held is not designed."
        ),
        "motor.any": KeyNote(
            "true: what motors would do whose threads, say, no source gives; not to be built."
        ),
        "motor.motors": KeyNote(
            "Instead of the catalogue; from the folder of this file.", "none", '"my_motors.csv"'
        ),
        "motor.with_catalogue": KeyNote("true: your file's motors and the catalogue's."),
        "motor.gears": KeyNote(
            "To choose from as well; from the folder of this file.", "none", '"my_gears.csv"'
        ),
        "motor.torque_max": KeyNote(
            "What your motor controller gives, at the wheel.", "the motor's own", '"1 N m"'
        ),
        "supply.voltage": KeyNote("Your robot's battery under load, not its nameplate."),
        "supply.current_max": KeyNote(
            "What fuse, cables and battery stand, both ways.", "not limited but by power", '"40 A"'
        ),
        "supply.power_max": KeyNote("Less where the legs draw at the same time."),
        "supply.controllers": KeyNote(
            "auto: by their current; a mass where you have some; none: not counted."
        ),
        "validation.enabled": KeyNote("false: size and export only, in half the time."),
        "validation.projection": KeyNote("transpose is the paper's, which scales the gains."),
        "validation.kp": KeyNote("Higher: quicker, and more torque."),
        "validation.kd": KeyNote("2 sqrt(kp) damps critically."),
        "validation.ballistic": KeyNote("true: the legs need not make the jumps."),
        "validation.seed": KeyNote("The same seed gives the same figures."),
        "validation.video": KeyNote("true: each maneuver as a film, with the device and without."),
        "validation.control_period": KeyNote("That of your controller; longer ones fly worse."),
        "validation.certify": KeyNote(
            "true: fly robots as they might be built until it is sure; it takes minutes."
        ),
        "validation.desaturate": KeyNote("true: wheels let go of their momentum after landing."),
        "reality.file": KeyNote(
            "Your own distributions; `size -v` lists the package's.",
            "the package's",
            '"my_reality.toml"',
        ),
        "reality.mass_error": KeyNote("After weighing the robot: the balance's error."),
        "reality.inertia_error": KeyNote("From CAD 5 % is common, from a pendulum 1 %."),
        "reality.com_error": KeyNote("Batteries and cables are seldom where CAD has them."),
        "reality.incidence_error": KeyNote("Play and tolerance of the mounts."),
        "reality.torque_constant_error": KeyNote("Makers state 5 to 10 % at most."),
        "reality.resistance_error": KeyNote("A warm winding has 0.4 % more for each degree."),
        "reality.bus_voltage_error": KeyNote("From a full battery to one that is to be charged."),
        "reality.coulomb_friction": KeyNote(
            "Measure it: run the wheel down.", "half of the motor's no-load torque", '"5 mN m"'
        ),
        "reality.viscous_friction": KeyNote(
            "The same at speed.", "the other half at the speed it is stated for", '"3 uN m s/rad"'
        ),
        "reality.air_drag": KeyNote("0: a vacuum, as on the Moon."),
        "reality.torque_delay": KeyNote("Bus, filters and the motor's own controller."),
        "reality.attitude_noise": KeyNote("The data sheet of your inertial sensor has it."),
        "reality.attitude_bias": KeyNote("Most of what a flight is off level by."),
        "reality.gyro_noise": KeyNote("Noise density times the root of the bandwidth."),
        "reality.gyro_bias": KeyNote("What is left after it was calibrated."),
        "reality.contact_friction": KeyNote("Of your feet on your floor."),
        "reality.takeoff_rate": KeyNote("Film jumps without the device; 0: legs as planned."),
    }
)
"""By the path of the key, as in `flywheel.r_max`."""

MANEUVER_NOTES: Mapping[str, str] = MappingProxyType(
    {
        "disturbance": "A jump in which something hits the trunk; to stay level until touchdown.",
        "shove": "A torque on the trunk of a robot that stands or trots; to be at rest soon.",
        "drop": "A fall from rest with the trunk tilted; to be level before touchdown.",
        "turn": "A turn to any attitude during a vertical jump, heading included.",
        "catch": "A stop of a trunk that turns as it leaves the ground.",
        "flip": "A turn in pitch during a vertical jump; a back-flip is negative.",
        "balance": "A tilt, rate or impulse of a robot on a pivot, which feedback alone undoes.",
        "stand-up": "A climb from a tilt to upright about a pivot, by motors or by a brake.",
    }
)
"""What each kind of maneuver is."""

FIELD_NOTES: Mapping[str, str] = MappingProxyType(
    {
        "name": "yours, of each maneuver another",
        "gravity": "if not that of [requirement]",
        "incidence": "if the modules are turned by hand for it",
        "takeoff_velocity": "forward, up",
        "torque": "on the trunk, about its x (forward), y (left) and z",
        "onset": "after lift-off",
        "duration": "of the torque",
        "flip.duration": "of the turn, from lift-off",
        "turn.duration": "of the turn, from lift-off",
        "catch.duration": "from lift-off until it is stopped",
        "turn.roll": "at the end, reached by yaw, then pitch, then roll",
        "turn.pitch": "at the end",
        "catch.roll": "at the end, where end is attitude",
        "catch.pitch": "at the end",
        "yaw": "at the end",
        "rate": "of the trunk at lift-off, about its x, y and z",
        "wheel_speed": "of all wheels at lift-off",
        "end": "level, attitude (with its heading) or at rest",
        "settling": "from the end of the torque to rest",
        "velocity_change": "of the centre of mass, by a force beside the torque",
        "impulse": "of a force, from which torque and velocity_change follow",
        "point": "of the trunk that the force hits",
        "stride": "of a trot on the spot; 0: the robot stands",
        "height": "of the trunk over the ground",
        "roll": "at release",
        "pitch": "at release",
        "jump_height": "of the centre of mass",
        "angle": "of pitch",
        "pivot": "that it stands on, in the trunk's frame",
        "edge": "direction of the edge that it stands on; zeros: a point",
        "actuation": "motor, or brake: wheels spun up before are stopped in an instant",
        **{
            f"{kind}.{name}": note
            for kind in ("balance", "stand-up")
            for name, note in (
                ("roll", "at the start, from where it balances"),
                ("pitch", "at the start"),
                ("duration", "until it is upright and at rest"),
                ("wheel_speed", "of all wheels at the start"),
                ("end", "level, or attitude: with its heading too"),
            )
        },
        "balance.rate": "of the trunk at the start, about its x, y and z",
        "balance.impulse": "of a force at the start",
    }
)
"""What each field of a `[[maneuver]]` is; by `kind.field`, of that kind alone."""


def field_note(kind: str, field: str) -> str:
    """Note on a field of a kind of maneuver."""
    return FIELD_NOTES.get(f"{kind}.{field}") or FIELD_NOTES[field]


INTRODUCTION = """\
Every key that there is. A line such as `# h_max = "10 mm"` shows what holds anyway, or an example
where it says so: take away the `# ` to state it. A quantity is SI if it is a bare number, or text
with one of the units in brackets. Whatever is left out is assumed for the robot, and `size` prints
what it assumed."""

_WIDTH = 40
"""Columns from the start of a maneuver's line to its comment."""


def commented_toml(
    stated: Specification,
    default: Specification,
    *,
    title: str,
    chosen: Collection[str] = (),
    examples: tuple[Maneuver, ...] = (),
) -> str:
    """The text of the file; it is read back as `stated` with the chosen maneuvers.

    Args:
        stated: is written as it is, to the last digit.
        default: what holds where nothing is stated, to four digits, behind a `#`.
        title: of the file, for people; may have several lines.
        chosen: names of default maneuvers to state as well.
        examples: maneuvers that are not assumed, shown behind a `#` where none of the kind is.
    """
    lines = [f"# {line}".rstrip() for line in (*title.splitlines(), "", *INTRODUCTION.splitlines())]
    for name, section in SECTIONS.items():
        lines += ["", f"[{name}]"]
        for key_name, key in keys_of(section).items():
            own, assumed = (getattr(getattr(one, name), key_name) for one in (stated, default))
            lines += _key_lines(key_name, key, KEY_NOTES[f"{name}.{key_name}"], own, assumed)

    lines += [
        "",
        "# What the device must do in the air, a table for each. As soon as one is stated, none",
        "# is assumed any more; requirement.maneuvers must then be left out.",
    ]
    shown = stated.maneuvers or default.maneuvers
    figures = Figures.EXACT if stated.maneuvers else Figures.ROUNDED
    for maneuver in shown:
        is_specified = bool(stated.maneuvers) or maneuver.name in chosen
        lines += ["", *_commented_maneuver(maneuver, figures, "" if is_specified else "# ")]
    kinds = {kind_of(maneuver)[0] for maneuver in shown}
    for maneuver in examples:
        if kind_of(maneuver)[0] not in kinds:
            lines += ["", "# Not assumed, an example:"]
            lines += _commented_maneuver(maneuver, Figures.ROUNDED, "# ")
    return "\n".join(lines) + "\n"


def rounded_text(specification: Specification, path: str) -> str:
    """The value of the key at `path`, as in `flywheel.r_max`, for people."""
    section, _, name = path.partition(".")
    value = getattr(getattr(specification, section), name)
    return written(value, all_keys()[path].value, Figures.ROUNDED).strip('"')


def _key_lines(
    name: str, key: Key, note: KeyNote, specified: object, default: object
) -> Iterator[str]:
    """Comment and line of one key."""
    shown = note.example if default is None else written(default, key.value, Figures.ROUNDED)
    yield from ("", f"# {key.summary} [{key.value.takes}]", f"# {note.why}")
    if specified is not None:
        yield f"# Default: {note.default or shown}"
        yield f"{name} = {written(specified, key.value, Figures.EXACT)}"
        return
    if note.default:
        yield f"# Default: {note.default}.{' Example:' if default is None else ''}"
    yield f"# {name} = {shown}"


def _commented_maneuver(maneuver: Maneuver, figures: Figures, mark: str) -> Iterator[str]:
    """Table of a maneuver with a note on each field; `mark` comments it out."""
    word, values = kind_of(maneuver)
    yield from (f"# {MANEUVER_NOTES[word]}", f"{mark}[[maneuver]]", f'{mark}kind = "{word}"')
    for name, how in values.items():
        value = getattr(maneuver, name)
        if value is not None:
            line = f"{name} = {written(value, how, figures)}"
            yield f"{mark}{line:<{_WIDTH}} # {field_note(word, name)}"
