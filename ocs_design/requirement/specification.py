"""The specification: every key of the file and every option of the command line, once.

A field is a key: its name is the TOML key and, with dashes, the option; its value says how it
is read. None means that it was not stated and that a default holds.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, TypeVar, get_type_hints

from ocs_design.common.errors import UsageError
from ocs_design.common.units import Dimension
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.uncertainty import UncertaintySection
from ocs_design.requirement.values import (
    HEIGHT,
    INCIDENCE,
    SUPPLY,
    TRUNK_RATE,
    WHEEL_SPEED,
    Chance,
    Choice,
    Count,
    Faults,
    JointValues,
    Key,
    LinkNames,
    Names,
    Number,
    Quantities,
    Quantity,
    Several,
    Sign,
    Switch,
    Text,
    WordOr,
    keyed,
    keys_of,
)
from ocs_design.requirement.words import (
    CATCH_TEXT,
    FLIP,
    GRAVITY,
    TURN_TEXT,
    About,
    Climb,
    ClimbText,
    Kick,
    KickText,
    Person,
    PersonText,
    Pivot,
    PivotText,
    Tilt,
    TiltText,
    UpsetText,
)

Section = TypeVar("Section")

LIGHTEST = "lightest"
"""Criterion of the incidence: whatever makes the device lightest, which only a real motor tells."""

CRITERIA = (LIGHTEST, "equal-rate", "weighted", "simultaneous", "pitch-only", "roll-only")
"""How the incidence may be chosen (docs/theory.md, Incidence angle)."""

EQUAL_RATE = CRITERIA[1]
"""Criterion of the incidence where none is stated: alpha* = atan(Ixx / Iyy), as in the paper."""

PAIR, PYRAMID = "pair", "pyramid"
MORE_PAIRS = ("double-pair", "triple-pair")
"""What is tried in turn where none is stated and no pair does it."""

WHEELS = {
    "single": 1,
    PAIR: 2,
    **dict(zip(MORE_PAIRS, (4, 6), strict=True)),
    "triad": 3,
    "orthogonal": 3,
    PYRAMID: 4,
}
LAYOUTS = tuple(WHEELS)
"""How the wheels' axes may lie to each other (docs/layouts.md)."""

_OF_WHEELS = tuple(3 * wheels for wheels in range(1, 7))
"""Three numbers for each of one to six wheels."""

ALL_LAYOUTS = "all"
"""Compare them instead (`size --layout all`)."""

STEEL = "steel"
"""In place of a material's name: the steel of the catalogue with which the device is lightest."""

AUTO = "auto"
"""In place of a name: the one with which the device is lightest."""

NO_CONTROLLERS = "none"
"""In place of a mass: motor controllers are not counted."""

NO_MOTOR = "none"
"""In place of a motor's name: size the wheels by the bound alone, as the paper does."""

DISC = "disc"
"""A rim's web: a thin disc with a hub, all of one piece."""

ALUMINIUM_WEB = "aluminium"
"""A thin disc of aluminium with a hub, which the rim is shrunk on."""

NO_WEB = "none"
"""In place of a web: massless spokes, as in the paper."""

FINGERS, CONTAINING = GUARDS = "fingers", "containing"
"""Guards: the printed housing alone, or a ring of mild steel in it."""

RING = "ring"
"""A wheel that is a ring around the bell of its motor, bonded on; the other one is the disc."""

CONSTRUCTIONS = (DISC, RING)

WEBS = (DISC, ALUMINIUM_WEB, NO_WEB)

LIGHTENING, LIGHTENINGS = 6, (0, 5, 6, 7, 8)
"""Holes in a web: how many, and how many there may be."""

CHAMFER, LARGEST_CHAMFER = 0.2e-3, 0.5e-3
"""Of a wheel's edges, where nothing is stated and at most [m]: broken edges as ISO 13715 has them,
and what hubs stand."""

BALANCING_DIAMETER, BALANCING_DEPTH = 1.6e-3, 1.0e-3
"""Of balancing holes, where nothing is stated [m]: the core hole of M2, and shallow, for glue."""

RELIABILITY = 0.99
"""Share of robots that shall pass, where nothing is stated."""

NONE_STOPS, ONE_STOPS = "none", "any one motor"
SURVIVED = ("one", ONE_STOPS, NONE_STOPS)
"""Drives that may stop in flight, the last word short for the one before."""

DETECTION = 0.02
"""Until it is known that a drive has stopped, where nothing is stated [s]: four control steps, in
which a wheel that should be driven changes its speed by less than it should."""

CONTROL_PERIOD = 0.005
"""Time from one torque of the wheels to the next, where nothing is stated [s]."""

PROJECTIONS = ("pseudo-inverse", "transpose")
"""How a torque on the trunk becomes torques of the wheels (docs/theory.md, The control law)."""


_LENGTH, _MASS = Quantity(Dimension.LENGTH), Quantity(Dimension.MASS)


@dataclass(frozen=True, kw_only=True)
class RobotSection:
    """`[robot]`: which robot and how it stands; mass [kg] and inertia [kg m^2] replace a file."""

    file: str | None = keyed(Text(), "robot file: URDF, xacro or MJCF")
    name: str | None = keyed(Text(), "name of the robot")
    trunk: str | None = keyed(Text(), "link that carries the device")
    legs: tuple[str, ...] | None = keyed(LinkNames(), "a link of each foot; none: it has no legs")
    posture: str | None = keyed(Text(), "zero, stand, or a name from the file")
    joints: Mapping[str, float] | None = keyed(
        JointValues(), "joint values on top of the posture", "joint"
    )
    mass: float | None = keyed(_MASS, "mass of the robot")
    inertia: tuple[float, ...] | None = keyed(
        Quantities(Dimension.INERTIA, (3, 6)),
        "inertia about the centre of mass: Ixx, Iyy, Izz[, Ixy, Ixz, Iyz]",
    )
    human: Person | None = keyed(PersonText(), "a person in place of a file, who wears the device")
    weighed: float | None = keyed(
        _MASS, "what the robot weighs on scales, to check its file's parts"
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
"""Keys of `[requirement]` that ask for a maneuver (`froude.worded_maneuvers`)."""

TURNS = ("turn", "catch")
"""Those of them that need no gravity."""


@dataclass(frozen=True, kw_only=True)
class RequirementSection:
    """`[requirement]`: what the wheels must do [rad/s, rad/s, kg m^2, m/s^2]."""

    rate_change: float | None = keyed(TRUNK_RATE, "change of the trunk's rate")
    wheel_speed_max: float | None = keyed(WHEEL_SPEED, "highest speed of a wheel")
    spin_inertia: float | None = keyed(
        Quantity(Dimension.INERTIA), "spin inertia of one wheel, asked directly"
    )
    gravity: float | None = keyed(GRAVITY, "where maneuvers state none")
    jump_height: tuple[float, ...] | None = keyed(
        Several(HEIGHT), "height of a jump, of the centre of mass"
    )
    kick: tuple[Kick, ...] | None = keyed(Several(KickText()), "impulse on the trunk during a jump")
    fall: tuple[float, ...] | None = keyed(
        Several(HEIGHT), "height of the trunk that a fall starts at"
    )
    tilt: tuple[Tilt, ...] | None = keyed(Several(TiltText()), "of the trunk when a fall starts")
    flip: tuple[float, ...] | None = keyed(Several(FLIP), "turn in pitch during a jump")
    turn: tuple[About, ...] | None = keyed(Several(TURN_TEXT), "turn to any attitude during a jump")
    catch: tuple[About, ...] | None = keyed(
        Several(CATCH_TEXT), "rates at lift-off that the wheels stop"
    )
    pivot: Pivot | None = keyed(PivotText(), "point or edge that balance and stand_up are about")
    balance: tuple[About | Kick, ...] | None = keyed(
        Several(UpsetText()), "tilt or impulse to get over on the pivot"
    )
    stand_up: tuple[Climb, ...] | None = keyed(
        Several(ClimbText()), "tilt to stand up from on the pivot"
    )
    maneuvers: str | None = keyed(
        Choice(("paper", "none")), "the paper's three beside what else is asked, or none"
    )
    reliability: float | None = keyed(
        Chance(), "share of robots that shall pass as built (`[reality]`)"
    )
    survives: str | None = keyed(
        Choice(SURVIVED), "whether it lands level though a drive stops in flight"
    )
    detection: float | None = keyed(
        Quantity(Dimension.TIME), "time until it is known that a drive has stopped"
    )

    @property
    def notices(self) -> float | None:
        """Time until a stopped drive is known [s], where the device survives one; else None."""
        survives = self.survives not in {None, NONE_STOPS}
        return (self.detection or DETECTION) if survives else None

    @property
    def is_worded(self) -> bool:
        """Whether a maneuver is asked for by a key of its own, such as `fall`."""
        return any(getattr(self, word) is not None for word in WORDS)

    def without_words(self) -> "RequirementSection":
        """All else that is asked."""
        return replace(self, **dict.fromkeys(WORDS))


@dataclass(frozen=True, kw_only=True)
class OcsSection:
    """`[ocs]`: how the device sits on the trunk, and what it may weigh [rad, m, kg]."""

    layout: str | None = keyed(Choice((*LAYOUTS, ALL_LAYOUTS)), "how the wheels' axes lie")
    axes: tuple[float, ...] | None = keyed(
        Quantities(Dimension.RATIO, _OF_WHEELS),
        "directions of the wheels' axes by hand, in place of a layout: x, y, z of each",
    )
    alpha: float | None = keyed(
        INCIDENCE, "incidence of a pair's axes, or elevation of a pyramid's"
    )
    alpha_criterion: str | None = keyed(Choice(CRITERIA), "how the incidence is chosen")
    position: tuple[float, ...] | None = keyed(
        Quantities(Dimension.LENGTH, _OF_WHEELS),
        "centre of a pair's left wheel on the trunk: x, y, z; of other layouts, of each wheel",
    )
    mass_max: float | None = keyed(_MASS, "largest mass of the device, all modules")
    lighter_by: float | None = keyed(
        _MASS, "to be told what must give for a device so much lighter"
    )
    co_design: bool | None = keyed(
        Switch(), "whether to refine all dimensions by optimal control in 3-D"
    )
    guard: str | None = keyed(
        Choice(GUARDS), "what the housings hold: fingers out, or also a wheel that bursts"
    )
    wheel: str | None = keyed(
        Choice(CONSTRUCTIONS),
        "a rim on a disc that sits on the motor, or a ring bonded around the motor's bell",
    )


@dataclass(frozen=True, kw_only=True)
class FlywheelSection:
    """`[flywheel]`: the room for a rim and what it is made of [m, kg]."""

    r_max: float | None = keyed(_LENGTH, "largest outer radius of a rim")
    r_min: float | None = keyed(_LENGTH, "smallest bore radius of a rim")
    h_max: float | None = keyed(_LENGTH, "largest height of a rim")
    h_min: float | None = keyed(_LENGTH, "smallest height of a rim")
    wall_min: float | None = keyed(_LENGTH, "smallest wall, outer less bore radius")
    wheel_mass_max: float | None = keyed(_MASS, "largest mass of a rim")
    material: str | None = keyed(
        Text((STEEL, AUTO)), "material of a rim, from the catalogue; steel or auto: of many"
    )
    web: str | None = keyed(
        Choice(WEBS),
        "what joins a rim to its motor: a disc of one piece with it, one of aluminium that "
        "it is shrunk on, or none: massless spokes",
    )
    stress_safety: float | None = keyed(
        Number(), "yield strength over hoop stress at the highest speed"
    )
    lightening: int | None = keyed(Count(), "holes in a web that has room for them; 0: none")
    chamfer: float | None = keyed(
        Quantity(Dimension.LENGTH, Sign.NOT_NEGATIVE, LARGEST_CHAMFER),
        "broken edges of a wheel with a web, at 45 deg",
    )
    balancing_holes: int | None = keyed(Count(), "in each face of a rim with a web; 0: none")
    balancing_hole_diameter: float | None = keyed(_LENGTH, "of each, on the rim's middle radius")
    balancing_hole_depth: float | None = keyed(_LENGTH, "of each, from its face")


@dataclass(frozen=True, kw_only=True)
class MotorSection:
    """`[motor]`: what drives a wheel [N m]."""

    name: str | None = keyed(
        Names(), "motors to choose from, of the catalogue; auto, or none", "motor"
    )
    gear: str | None = keyed(Text((AUTO, "direct")), "gear from the catalogue, direct, or auto")
    any: bool | None = keyed(Switch(), "whether motors may lack what a builder needs", "motors-any")
    motors: str | None = keyed(Text(), "file with motors to choose from instead, CSV or TOML")
    with_catalogue: bool | None = keyed(
        Switch(), "whether to choose from the catalogue too, beside that file"
    )
    gears: str | None = keyed(Text(), "file with gears of your own, CSV or TOML")
    torque_max: float | None = keyed(Quantity(Dimension.TORQUE), "largest torque on a wheel")


@dataclass(frozen=True, kw_only=True)
class SupplySection:
    """`[supply]`: what feeds all motors, drawn or fed back, and their controllers [V, A, W, kg]."""

    voltage: float | None = keyed(SUPPLY, "of the supply of all motors", "bus-voltage")
    current_max: float | None = keyed(
        Quantity(Dimension.CURRENT),
        "largest current of all motors, drawn or fed back",
        "bus-current",
    )
    power_max: float | None = keyed(
        Quantity(Dimension.POWER), "largest power of all motors, drawn or fed back", "bus-power"
    )
    controllers: float | str | None = keyed(
        WordOr((AUTO, NO_CONTROLLERS), _MASS), "mass of one motor controller; none: not counted"
    )


@dataclass(frozen=True, kw_only=True)
class ValidationSection:
    """`[validation]`: the proof by simulation; gains [1/s^2, 1/s]."""

    enabled: bool | None = keyed(Switch(), "whether to simulate at all", "validate")
    projection: str | None = keyed(Choice(PROJECTIONS), "how the law's torque falls to the wheels")
    kp: float | None = keyed(Number(), "gain on the attitude error")
    kd: float | None = keyed(Number(), "gain on the rate error")
    ballistic: bool | None = keyed(Switch(), "whether jumps start at lift-off, without a push-off")
    seed: int | None = keyed(Count(), "seed of all random numbers")
    video: bool | None = keyed(Switch(), "whether to film the flights")
    certify: bool | None = keyed(
        Switch(), "whether to fly robots as they might be built, until it is sure"
    )
    control_period: float | None = keyed(
        Quantity(Dimension.TIME, most=0.1), "from one torque to the next, whole milliseconds"
    )
    desaturate: bool | None = keyed(
        Switch(), "whether the wheels are braked while the robot stands"
    )


LONGEST_REPR = 200
"""Characters of what is stated that are shown."""


@dataclass(frozen=True, kw_only=True)
class Specification:
    """Everything that a user stated; see the sections.

    Attributes:
        maneuvers: the `[[maneuver]]` tables; empty if there are none.
    """

    robot: RobotSection = field(default_factory=RobotSection)
    requirement: RequirementSection = field(default_factory=RequirementSection)
    ocs: OcsSection = field(default_factory=OcsSection)
    flywheel: FlywheelSection = field(default_factory=FlywheelSection)
    motor: MotorSection = field(default_factory=MotorSection)
    supply: SupplySection = field(default_factory=SupplySection)
    validation: ValidationSection = field(default_factory=ValidationSection)
    reality: UncertaintySection = field(default_factory=UncertaintySection)
    maneuvers: tuple[Maneuver, ...] = ()

    @property
    def takes_default_maneuvers(self) -> bool:
        """Whether the paper's three hold: nothing is asked for, or they are, by name."""
        asked = self.requirement
        if self.maneuvers or asked.maneuvers == "none":
            return False
        # What is stated is the requirement: nothing is added to it unasked.
        nothing = asked.rate_change is None and asked.spin_inertia is None and not asked.is_worded
        return nothing or asked.maneuvers is not None

    @property
    def asks_nothing(self) -> bool:
        """Whether the paper's three hold though nobody asked for them."""
        return self.takes_default_maneuvers and self.requirement.maneuvers is None

    def __repr__(self) -> str:
        stated = [
            f"{section}.{name}={value!r}"
            for section in SECTIONS
            for name, value in vars(getattr(self, section)).items()
            if value is not None
        ]
        stated += [f"maneuver {each.name}" for each in self.maneuvers]
        text = ", ".join(stated) or "nothing stated"
        more = " ..." if len(text) > LONGEST_REPR else ""
        return f"<Specification: {text[:LONGEST_REPR]}{more}>"


SECTIONS: Mapping[str, type] = {
    name: kind for name, kind in get_type_hints(Specification).items() if name != "maneuvers"
}
"""Class of each section of the file, by its name in brackets."""


@cache
def all_keys() -> Mapping[str, Key]:
    """Every key by its path, as in `flywheel.r_max`, in the order of the file."""
    return {
        f"{name}.{key}": found
        for name, section in SECTIONS.items()
        for key, found in keys_of(section).items()
    }


def merge(base: Specification, override: Specification) -> Specification:
    """`base`, with everything that `override` states in its place; joints are merged one by one.

    A robot by file replaces one by hand, and the other way round. Maneuvers that are asked for in
    words replace all that `base` asks for: they are the requirement.
    """
    if override.robot.file is not None:
        base = replace(base, robot=replace(base.robot, mass=None, inertia=None, human=None))
    elif override.robot.mass is not None or override.robot.inertia is not None:
        base = replace(base, robot=replace(base.robot, file=None, human=None))
    elif override.robot.human is not None:
        base = replace(base, robot=replace(base.robot, file=None, mass=None, inertia=None))
    if override.requirement.is_worded:
        asked = replace(base.requirement.without_words(), maneuvers=None)
        base = replace(base, requirement=asked, maneuvers=())
    sections = {
        name: merge_section(getattr(base, name), getattr(override, name)) for name in SECTIONS
    }
    return Specification(**sections, maneuvers=override.maneuvers or base.maneuvers)


def merge_section(base: Section, override: Section) -> Section:
    """One section, with everything that `override` states in its place."""
    changes: dict[str, Any] = {}
    for name, own in vars(base).items():
        other = getattr(override, name)
        if isinstance(own, Mapping) and isinstance(other, Mapping):
            changes[name] = {**own, **other}
        else:
            changes[name] = own if other is None else other
    return type(base)(**changes)


def specification_from_options(options: Mapping[str, object]) -> Specification:
    """The specification that options of the command line state, read as the file's keys are.

    Args:
        options: text or flag by the key's path, as in `flywheel.r_max`; None is not stated.

    Raises:
        UsageError: all faults, each with its option.
    """
    faults = Faults()
    sections: dict[str, dict[str, Any]] = {name: {} for name in SECTIONS}
    for path, raw in options.items():
        section, name = path.split(".")
        key = all_keys()[path]
        if raw is not None:
            named = f"--{key.option or name.replace('_', '-')}"
            option = "ROBOT" if path == "robot.file" else named
            sections[section][name] = faults.read(key.value, raw, option)
    if faults:
        raise UsageError("\n".join(faults))
    return Specification(**{name: SECTIONS[name](**found) for name, found in sections.items()})
