"""Sections of a specification about the robot, the requirement and the validation.

Each field is a key: its name is the TOML key and, with dashes, the option; its value is the parser.
None means that it was not specified and that a default applies.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from ocs_design.common.units import STANDARD_GRAVITY, Dimension
from ocs_design.requirement import phrases, values, vocabulary
from ocs_design.requirement.keys import keyed


@dataclass(frozen=True, kw_only=True)
class RobotSection:
    """`[robot]`: the robot and its posture; mass [kg] and inertia [kg m^2] replace a file."""

    file: str | None = keyed(
        values.Text(),
        "robot file: URDF, xacro or MJCF",
        why="Mass, inertia and legs are read from it; path relative to this file.",
        default="the robot on the command line",
        example='"robot.urdf"',
    )
    name: str | None = keyed(
        values.Text(),
        "name of the robot",
        why="Names the output folder of a robot without a file.",
        default="the file's own",
        example='"robot"',
    )
    trunk: str | None = keyed(
        values.Text(),
        "link that carries the device",
        why="Set it if the wrong link was recognised as the trunk.",
        default="detected",
        example='"trunk"',
    )
    legs: tuple[str, ...] | None = keyed(
        values.link_names,
        "feet, one link per leg; none: the robot has no legs",
        why="Set them if the wrong limbs were recognised as legs.",
        default="detected",
        example='["FL_FOOT", "FR_FOOT"]',
    )
    posture: str | None = keyed(
        values.Text(),
        "zero, stand, or a name from the file",
        why="The inertia, and with it the device, follows from this posture.",
        default="stand if legs are found",
        example='"stand"',
    )
    joints: Mapping[str, float] | None = keyed(
        values.joint_values,
        "joint values on top of the posture",
        option="joint",
        why="For a posture without a name.",
        default="none",
        example='{ "FL_HFE" = "45deg", "FL_KFE" = "-90deg" }',
    )
    mass: float | None = keyed(
        values.MASS,
        "mass of the robot",
        why="In place of a file, with the inertia.",
        default="from the file",
        example='"2.5 kg"',
    )
    inertia: tuple[float, ...] | None = keyed(
        values.Quantities(Dimension.INERTIA, (3, 6)),
        "inertia about the centre of mass: Ixx, Iyy, Izz[, Ixy, Ixz, Iyz]",
        why="In place of a file, with the mass.",
        default="from the file",
        example="[0.032, 0.055, 0.070]",
    )
    human: phrases.Person | None = keyed(
        phrases.person_text,
        "a person who wears the device, in place of a file",
        why="In place of a file: mass, height, payload.",
        default="none",
        example='"75kg 1.75m with 10kg"',
    )
    weighed: float | None = keyed(
        values.MASS,
        "mass of the robot as weighed, to check the masses in its file",
        why="Warns if the masses in the file do not add up to it.",
        default="not checked",
        example='"2.5 kg"',
    )


WORDS = (
    "jump_height",
    "kick",
    "fall",
    "tilt",
    "flip",
    "turn",
    "catch",
    "pivot",
    "balance",
    "stand_up",
)
"""Keys of `[requirement]` that request a maneuver (`worded_maneuvers`)."""

TURNS = ("turn", "catch")
"""Keys of `WORDS` whose maneuvers need no gravity."""


@dataclass(frozen=True, kw_only=True)
class RequirementSection:
    """`[requirement]`: what the wheels must do [rad/s, rad/s, kg m^2, m/s^2]."""

    rate_change: float | None = keyed(
        values.TRUNK_RATE,
        "change of the trunk's rate",
        why="The paper's requirement, about either axis, in addition to your own maneuvers.",
        example='"2 rad/s"',
    )
    wheel_speed_max: float | None = keyed(
        values.WHEEL_RATE,
        "highest speed of a wheel",
        why="The limit of bearings and balance, if below the motor's.",
        default="the motor's own; 7200 rpm without a motor",
        example='"7200 rpm"',
    )
    spin_inertia: float | None = keyed(
        values.Quantity(Dimension.INERTIA),
        "spin inertia of one wheel, specified directly",
        why="For a wheel that you already have; nothing else is then required.",
        default="computed",
        example='"7.11e-5 kg m2"',
    )
    gravity: float | None = keyed(
        values.GRAVITY,
        "gravity of maneuvers that give none of their own",
        why="1.62 m/s2 is the Moon's; the paper's back-flip stays there.",
        assumed=STANDARD_GRAVITY,
    )
    jump_height: tuple[float, ...] | None = keyed(
        values.Several(values.HEIGHT),
        "height of a jump, of the centre of mass",
        why="Alone: with the push of the paper's first test; else the jump of each kick and flip.",
        example='"0.4 m"',
    )
    kick: tuple[phrases.Kick, ...] | None = keyed(
        values.Several(phrases.kick_text),
        "impulse on the trunk during a jump",
        why="Without `along`, it comes from the side.",
        example='"12 N s at 0.1,0,0.2 along 0,1,0"',
    )
    fall: tuple[float, ...] | None = keyed(
        values.Several(values.HEIGHT),
        "height of the trunk at the start of a fall",
        why="The trunk is released at rest, with its frame this high above the ground.",
        example='"1 m"',
    )
    tilt: tuple[phrases.Tilt, ...] | None = keyed(
        values.Several(phrases.tilt_text),
        "tilt of the trunk at the start of a fall",
        why="For each fall; positive pitch is nose down, positive roll to the right.",
        example='"20 deg"',
    )
    flip: tuple[float, ...] | None = keyed(
        values.Several(phrases.FLIP),
        "turn in pitch during a jump",
        why="back, forward, or an angle of whole turns; back-flips are negative.",
        example='"back"',
    )
    turn: tuple[phrases.About, ...] | None = keyed(
        values.Several(phrases.TURN_TEXT),
        "turn to any attitude during a jump",
        why="To an attitude, heading included, within a time.",
        example='"yaw 90 deg in 2.9 s"',
    )
    catch: tuple[phrases.About, ...] | None = keyed(
        values.Several(phrases.CATCH_TEXT),
        "rates at lift-off that the wheels must stop",
        why="Rates of the trunk at lift-off; it must be level within a time.",
        example='"roll 20 deg/s pitch 45 deg/s in 0.5 s"',
    )
    pivot: phrases.Pivot | None = keyed(
        phrases.pivot_text,
        "point or edge for balance and stand_up",
        why="In the trunk's frame, below the centre of mass.",
        example='"0,0,-0.2 along left"',
    )
    balance: tuple[phrases.About | phrases.Kick, ...] | None = keyed(
        values.Several(phrases.upset_text),
        "tilt or impulse to recover from on the pivot",
        why="The robot must be upright again: after a tilt from balance, or an impulse.",
        example='"pitch 5 deg in 1 s"',
    )
    stand_up: tuple[phrases.Climb, ...] | None = keyed(
        values.Several(phrases.climb_text),
        "tilt to stand up from on the pivot",
        why="From a tilt to upright on the pivot, by the motors or by braking the wheels.",
        example='"pitch 45 deg by brake"',
    )
    maneuvers: str | None = keyed(
        values.Choice(("paper", "none")),
        "the paper's three in addition to other requirements, or none",
        why="paper: in addition to a rate_change or a spin_inertia; leave it out with your own.",
        assumed="paper",
    )
    reliability: float | None = keyed(
        values.chance,
        "share of robots sampled from `[reality]` that must pass",
        why="0.5: sized for a robot exactly as in its file; more keeps a reserve for [reality].",
        assumed=vocabulary.RELIABILITY,
    )
    survives: str | None = keyed(
        values.Choice(vocabulary.SURVIVED),
        "whether the robot must land level if any one drive fails in flight",
        why="one, or any one motor: level whichever drive fails, at any instant of a maneuver; the "
        "failed drive's wheel coasts.",
        assumed=vocabulary.NONE_STOPS,
    )
    detection: float | None = keyed(
        values.TIME,
        "time until a failed drive is detected",
        why="Until then the other drives continue as before.",
        assumed=vocabulary.DETECTION,
    )

    @property
    def notices(self) -> float | None:
        """Time until a failed drive is detected [s], if the device must survive one; else None."""
        survives = self.survives not in {None, vocabulary.NONE_STOPS}
        return (self.detection or vocabulary.DETECTION) if survives else None

    @property
    def is_worded(self) -> bool:
        """Whether a maneuver is requested by a key of its own, such as `fall`."""
        return any(getattr(self, word) is not None for word in WORDS)

    def without_words(self) -> "RequirementSection":
        """The section without the keys that request maneuvers."""
        return replace(self, **dict.fromkeys(WORDS))


@dataclass(frozen=True, kw_only=True)
class ValidationSection:
    """`[validation]`: validation by simulation; gains [1/s^2, 1/s]."""

    enabled: bool | None = keyed(
        values.true_or_false,
        "whether to simulate at all",
        option="validate",
        why="false: size and export only, in half the time.",
        assumed=True,
    )
    projection: str | None = keyed(
        values.Choice(vocabulary.PROJECTIONS),
        "how the control torque is distributed to the wheels",
        why="transpose is the paper's, which scales the gains.",
        assumed=vocabulary.PROJECTIONS[0],
    )
    kp: float | None = keyed(
        values.positive_number,
        "gain on the attitude error",
        why="Higher: faster, with more torque.",
    )
    kd: float | None = keyed(
        values.positive_number, "gain on the rate error", why="2 sqrt(kp) damps critically."
    )
    ballistic: bool | None = keyed(
        values.true_or_false,
        "whether jumps start at lift-off, without a push-off",
        why="true: the legs need not be able to make the jumps.",
        assumed=False,
    )
    seed: int | None = keyed(
        values.whole_number,
        "seed of all random numbers",
        why="The same seed gives the same figures.",
        assumed=0,
    )
    video: bool | None = keyed(
        values.true_or_false,
        "whether to film the flights",
        why="true: one film per maneuver, with the device and without.",
        assumed=False,
    )
    certify: bool | None = keyed(
        values.true_or_false,
        "whether to fly sampled robots until the reliability is certified or not",
        why="true: tests the reliability on sampled robots; takes minutes.",
        assumed=False,
    )
    control_period: float | None = keyed(
        values.Quantity(Dimension.TIME, most=0.1),
        "time between torque commands, whole milliseconds",
        why="That of your controller; longer periods fly worse.",
        assumed=vocabulary.CONTROL_PERIOD,
    )
    desaturate: bool | None = keyed(
        values.true_or_false,
        "whether the wheels are braked while the robot stands",
        why="true: the wheels shed their momentum after landing.",
        assumed=False,
    )
