"""Resolves a specification: reads its robot, fills in defaults and lists the assumptions."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from ocs_design.actuation.controllers import BASE_MASS, MASS_PER_CURRENT
from ocs_design.actuation.drive import RESERVE
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import DEFAULT_MATERIAL, Material, material
from ocs_design.common.errors import RobotError, SpecificationError, UsageError
from ocs_design.common.files import AnyPath
from ocs_design.common.units import (
    STANDARD_GRAVITY,
    Dimension,
    format_quantity,
    rpm,
    si_unit,
    to_unit,
)
from ocs_design.requirement.checks import contradictions, robot_contradictions
from ocs_design.requirement.choices import (
    POWER_PER_MASS,
    MotorChoice,
    default_supply,
    motor_choice,
    motor_warnings,
)
from ocs_design.requirement.device_sections import (
    LIMIT_OF_KEY,
    Envelope,
    FlywheelSection,
    MotorSection,
    OcsSection,
    SupplySection,
)
from ocs_design.requirement.froude import (
    RIM_MASS_SHARE,
    WHEEL_SPEED_MAX,
    FroudeScale,
    default_envelope,
    default_maneuvers,
    standing_height,
)
from ocs_design.requirement.keys import assumed_section
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.sections import RequirementSection, RobotSection, ValidationSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.uncertainty import default_uncertainty
from ocs_design.requirement.values import JointValue
from ocs_design.requirement.vocabulary import (
    ALUMINIUM_WEB,
    AUTO,
    BALANCING_DEPTH,
    BALANCING_DIAMETER,
    CHAMFER,
    LIGHTENING,
    MORE_PAIRS,
    NO_WEB,
    PAIR,
    RELIABILITY,
    RING,
    STEEL,
)
from ocs_design.requirement.worded_maneuvers import Worded, assumption_with_device, worded_maneuvers
from ocs_design.robot.manual import assumed_trunk, person, robot_by_hand
from ocs_design.robot.mass import DENSEST, ball_density, impossible_size
from ocs_design.robot.reader import read_robot
from ocs_design.robot.recognition import question_about
from ocs_design.robot.robot import Robot
from ocs_design.robot.tree import JointKind


def default_specification(
    robot: Robot, *, kp: float, kd: float, gravity: float = STANDARD_GRAVITY
) -> Specification:
    """Defaults of `resolve` for `robot`, as a specification.

    Keys without a default, or whose default is found while sizing, are None.

    Args:
        robot: to scale to.
        kp, kd: gains of the wheel law [1/s^2, 1/s].
        gravity: of the maneuvers on Earth [m/s^2].
    """
    envelope, supply = default_envelope(robot), default_supply(robot)
    return Specification(
        robot=RobotSection(posture=robot.posture_name),
        requirement=assumed_section(RequirementSection),
        ocs=assumed_section(OcsSection),
        flywheel=assumed_section(FlywheelSection, **envelope.by_key),
        motor=assumed_section(MotorSection),
        supply=assumed_section(SupplySection, voltage=supply.voltage, power_max=supply.power_max),
        validation=assumed_section(ValidationSection, kp=kp, kd=kd),
        reality=default_uncertainty(standing_height(robot)),
        maneuvers=default_maneuvers(robot, gravity),
    )


SCALES = 0.02
"""Relative tolerance of a robot's mass: a battery or a harness missing in its file is more."""


def read_specified_robot(
    specification: Specification,
    *,
    package_paths: Mapping[str, AnyPath] | None = None,
    strict: bool = False,
    sure: bool = True,
) -> Robot:
    """The robot of a specification, read from its file or made from figures.

    Args:
        specification: with a file, a person, or mass and inertia.
        package_paths: folder of each package, for `package://` addresses.
        strict: whether warnings are errors.
        sure: whether trunk and legs must be specified, or recognised without doubt.

    Raises:
        UsageError: no robot is given, or more than one.
        RobotError: the file cannot be read; trunk or legs are in doubt; with `strict`, also if
            there is any warning.
    """
    specified = specification.robot
    if specified.file is not None and (specified.mass is not None or specified.inertia is not None):
        raise UsageError("a robot file and --mass/--inertia exclude each other", hint="give one")
    if specified.file is not None:
        robot = read_robot(
            specified.file,
            trunk=specified.trunk,
            legs=specified.legs,
            posture=specified.posture,
            joints=specified.joints or {},
            package_paths=package_paths,
        )
        _check_units(specified.joints or {}, robot)
        impossible = impossible_size(robot.mass_properties) if sure else None
        if impossible is not None:
            likely = (
                "masses in grams"
                if ball_density(robot.mass_properties) > DENSEST
                else "lengths in millimetres, or its inertias in g mm^2 or kg mm^2"
            )
            raise RobotError(
                f"{specified.file}: {impossible}",
                hint=f"a robot file is in kg, m and kg m^2: are its {likely}? See "
                f"`ocs-design inspect {specified.file}`",
            )
        if sure and robot.recognition is not None and not robot.recognition.sure:
            question = question_about(robot.recognition)
            raise RobotError(f"{specified.file}: {question.message}", hint=question.hint)
    elif specified.human is not None:
        who = specified.human
        robot = person(who.mass, who.height, who.payload, specified.name or "person")
    elif specified.mass is not None and specified.inertia is not None:
        robot = robot_by_hand(specified.mass, specified.inertia, name=specified.name or "robot")
    elif specified.mass is not None or specified.inertia is not None:
        raise UsageError(
            "a robot without a file needs both mass and inertia",
            hint="give --mass MASS and --inertia IXX,IYY,IZZ, or both keys under [robot]",
        )
    else:
        raise UsageError(
            "no robot is given",
            hint="give a robot file, or --mass and --inertia, or --human, or [robot] in the "
            "specification; `ocs-design demo` needs none",
        )
    weighed = specified.weighed
    if weighed is not None and not 1e-2 < weighed / robot.mass < 1e2:
        unit = "g" if weighed > robot.mass else "kg"
        raise UsageError(
            f"the robot weighs {weighed:.6g} kg, but {robot.mass:.4g} kg according to its file",
            hint=f"did you mean {to_unit(weighed, 'kg' if unit == 'g' else 'g'):g}{unit}?",
        )
    if weighed is not None and abs(robot.mass - weighed) > SCALES * weighed:
        wrong = "something is missing" if robot.mass < weighed else "something is too heavy"
        warning = (
            f"the parts' masses add up to {robot.mass:.4g} kg, but the robot weighs "
            f"{weighed:.4g} kg: {wrong} in its file"
        )
        robot = replace(robot, warnings=(*robot.warnings, warning))
    robot = replace(robot, warnings=(*robot.warnings, *motor_warnings(specification)))
    if strict and robot.warnings:
        raise RobotError(
            "--strict: " + "; ".join(robot.warnings), hint="fix the files of robot and motors"
        )
    return robot


def _check_units(joints: Mapping[str, float], robot: Robot) -> None:
    """Refuse lengths for joints that turn, and angles for those that slide."""
    for name, value in joints.items():
        written = value.dimension if isinstance(value, JointValue) else None
        slides = robot.tree.joints[name].kind is JointKind.PRISMATIC
        if written is (Dimension.ANGLE if slides else Dimension.LENGTH):
            does, fit = ("slides", "30mm") if slides else ("turns", "10deg")
            raise UsageError(
                f"joint {name!r} {does}, and its value {value:.4g} {si_unit(written)} is of "
                f"{written}",
                hint=f"give it as in {name}={fit}",
            )


@dataclass(frozen=True, eq=False)
class Resolved:
    """A specification with its defaults filled in.

    Attributes:
        requirement: what the wheels must do.
        envelope: limits of a rim.
        material: of a rim.
        torque_max: of a wheel [N m]; None: not limited.
        choice: of motors, gears and materials; None: no motor is wanted, and `material` applies.
        reliability: share of sampled robots that must pass; None: no motor is wanted, and no
            reliability is specified.
        assumptions: defaults that apply, one sentence each.
    """

    requirement: Requirement
    envelope: Envelope
    material: Material
    torque_max: float | None
    choice: MotorChoice | None
    assumptions: tuple[str, ...]
    reliability: float | None = None

    def estimated(self, factors: Mapping[str, float]) -> "Resolved":
        """Requirement with these factors on the estimated demand of turns, by name of maneuver."""
        corrected = self.requirement.changed(
            lambda maneuver: maneuver.corrected(factors.get(maneuver.name, 1.0))
        )
        return replace(self, requirement=corrected)

    def carrying(self, requirement: Requirement) -> "Resolved":
        """Requirement for robot and device; notes on kicks are extended by what they do to both.

        Args:
            requirement: of robot and device.
        """
        text = tuple(
            assumption_with_device(assumption, requirement.maneuvers)
            for assumption in self.assumptions
        )
        return replace(self, requirement=requirement, assumptions=text)


def _assumptions(
    specification: Specification, robot: Robot, resolved: Resolved, worded: Worded
) -> Iterator[str]:
    """One sentence on each default in `resolved`."""
    flywheel, motor, scale = specification.flywheel, specification.motor, FroudeScale.of(robot)
    requirement, envelope, choice = resolved.requirement, resolved.envelope, resolved.choice
    lands = any(maneuver.gravity and not maneuver.on_pivot for maneuver in requirement.maneuvers)
    if robot.standing_height is None and lands:
        height = format_quantity(standing_height(robot), "mm", 3)
        yield f"No legs: standing height {height}, Solo12's scaled by radius of gyration."
    if (box := assumed_trunk(robot)) is not None:
        sides = " x ".join(f"{2e3 * half:.0f}" for half in box.size)
        yield (
            f"Trunk {robot.trunk!r}: a solid box of {sides} mm (long, wide, high) around the "
            "centre of mass, with this mass and inertia. The modules stand on it. Give their place "
            "with --position, or the trunk's own shape in a robot file."
        )
    if specification.takes_default_maneuvers:
        ratio = f"lengths x {scale.length:.3g}"
        yield f"Maneuvers: the paper's three, scaled from Solo12 ({ratio})."
        paper = requirement.maneuvers[: -len(worded.maneuvers) or None]
        yield from (f"{item.name}: {item.summary}." for item in paper)
    yield from worded.notes
    specified = specification.ocs
    pairs = specified.axes is None and specified.layout in {None, PAIR, *MORE_PAIRS}
    if pairs and specified.alpha is None and specified.alpha_criterion is None:
        yield "Incidence: alpha* = atan(Ixx/Iyy) of robot and device (equal-rate)."

    lengths = [
        f"{key} {to_unit(envelope.by_key[key], 'mm'):.3g}"
        for key in ("r_max", "r_min", "h_max", "h_min", "wall_min")
        if getattr(flywheel, key) is None
    ]
    if lengths:
        yield f"Rim: {', '.join(lengths)} mm (Solo12 x {scale.rim:.3g})."
    if flywheel.wheel_mass_max is None:
        mass = format_quantity(envelope.mass_max, "g" if envelope.mass_max < 1.0 else "kg", 3)
        yield f"Rim mass: at most {mass}, {RIM_MASS_SHARE:.0%} of the robot's."

    if choice is not None:
        yield from _assumed_supply(specification.supply, choice.supply)
        if motor.name in {None, AUTO}:
            which = "with enough data" if motor.any else "that can be built with"
            yield (
                f"Motor: {choice.motors[0].name}, the only one {which}."
                if len(choice.motors) == 1
                else f"Motor: chosen for the lightest device, of all {which}."
            )
        if motor.gear in {None, AUTO}:
            stages = len(choice.gears) - 1
            yield (
                f"Gear: none, or one of {stages} stages in the catalogue."
                if stages
                else "Gear: none, because gear mountings are not designed."
            )

    yield from _assumed_wheel(flywheel, resolved, ring=specification.ocs.wheel == RING)
    if choice is not None:
        yield (
            f"Reserve: a design uses {RESERVE:.0%} of voltage, current and speed limit; "
            "the rest is left to feedback."
        )
        requirement_section, noticed = specification.requirement, requirement.detection or 0.0
        assumed = {
            f"Reliability: {RELIABILITY:.0%} of robots sampled from `[reality]` must "
            "pass.": requirement_section.reliability is None,
            f"Detection: a failed drive is detected after {format_quantity(noticed, 'ms')}."
            "": requirement_section.notices is not None and requirement_section.detection is None,
        }
        yield from (text for text, holds in assumed.items() if holds)
        return
    if specification.requirement.wheel_speed_max is None:
        speed = rpm(requirement.wheel_speed_max)
        yield f"Wheel speed: at most {speed}, that of Solo12's own motor at 24 V."
    if motor.torque_max is None:
        yield "Motor torque: not limited."


def _assumed_supply(specified: SupplySection, supply: Supply) -> Iterator[str]:
    """Defaults of the supply, one sentence each."""
    assumed = []
    if specified.voltage is None:
        assumed.append(f"{supply.voltage:g} V")
    # A specified current may be the tighter limit; then the default does not count.
    if specified.power_max is None and supply.power_max <= supply.power:
        power = format_quantity(supply.power_max, "kW" if supply.power_max >= 1e3 else "W", 3)
        assumed.append(f"at most {power} ({POWER_PER_MASS:g} W per kg of robot)")
    if assumed:
        yield f"Supply: {', '.join(assumed)}."
    if specified.controllers in {None, AUTO}:
        base, per_current = (
            format_quantity(mass, "g", 3) for mass in (BASE_MASS, MASS_PER_CURRENT)
        )
        yield f"Controllers: {base} each, plus {per_current} per ampere of peak phase current."


def _assumed_wheel(flywheel: FlywheelSection, resolved: Resolved, *, ring: bool) -> Iterator[str]:
    """One sentence on each default of the wheels."""
    choice = resolved.choice
    # Without a motor only the rim has a mass, and its material is already decided.
    chosen = resolved.material if choice is None else choice.materials[0]
    if flywheel.web is None and not ring:
        yield "Wheel: one piece; a thin disc with a hub joins the rim to its motor."
    if choice is not None and flywheel.web != NO_WEB:
        if flywheel.lightening is None and flywheel.web != ALUMINIUM_WEB and not ring:
            yield f"Web: {LIGHTENING} lightening holes where it has room for them."
        if flywheel.chamfer is None:
            yield f"Edges: broken by {format_quantity(CHAMFER, 'mm')}."
        if flywheel.balancing_holes:
            across = flywheel.balancing_hole_diameter or BALANCING_DIAMETER
            deep = flywheel.balancing_hole_depth or BALANCING_DEPTH
            size = f"{format_quantity(across, 'mm')} wide, {format_quantity(deep, 'mm')} deep"
            yield f"Balancing holes: {flywheel.balancing_holes} in each face, {size}."
    if flywheel.material in {None, STEEL, AUTO}:
        kinds = "materials whose strength is known" if flywheel.material == AUTO else "steels"
        yield (
            f"Material: {chosen.name}, {chosen.density:g} kg/m3."
            if choice is None
            else f"Material: one of {len(choice.materials)} {kinds}."
        )
    if chosen.yield_strength is None:
        yield f"Stress: not checked, because the strength of {chosen.name} is not known."
    elif flywheel.stress_safety is None:
        safety = resolved.envelope.stress_safety
        yield f"Stress: yield strength over hoop stress at least {safety:g}."


def resolve(
    specification: Specification, robot: Robot, robot_size: float, *, varied: bool = False
) -> Resolved:
    """What to design for: the specification, and for the rest the defaults of `froude`.

    Args:
        specification: file and options merged.
        robot: to scale defaults to.
        robot_size: largest extent of the robot [m]; nothing of the device may be larger.
        varied: whether it is a variant, which is sized and not flown: parts of a flip will do.

    Raises:
        SpecificationError: keys that contradict each other or the robot; all are listed.
    """
    flywheel, requirement_section = specification.flywheel, specification.requirement
    # Unlike files, options of a command and arguments of Python have not been checked.
    if against := tuple(contradictions(specification)):
        raise SpecificationError("these requirements contradict each other:", problems=against)
    if robot.standing_height is not None and robot.standing_height <= 0.0:
        raise SpecificationError(
            f"the frame of the trunk {robot.trunk!r} is {-1e3 * robot.standing_height:.0f} mm "
            "below the feet of the standing robot: nothing can be scaled to its height",
            hint="Name a link above the legs with --trunk",
        )
    envelope = default_envelope(robot)
    for key, limit in LIMIT_OF_KEY.items():
        specified = getattr(flywheel, key)
        if specified is not None:
            envelope = replace(envelope, **{limit: specified})
    maneuvers = specification.maneuvers
    if specification.takes_default_maneuvers:
        maneuvers = default_maneuvers(robot, requirement_section.gravity or STANDARD_GRAVITY)
    worded = worded_maneuvers(requirement_section, robot, (maneuver.name for maneuver in maneuvers))
    height = standing_height(robot)
    requirement = Requirement(
        maneuvers=tuple(
            replace(maneuver, standing_height=height)
            for maneuver in (*maneuvers, *worded.maneuvers)
        ),
        rate_change=requirement_section.rate_change,
        wheel_speed_max=requirement_section.wheel_speed_max or WHEEL_SPEED_MAX,
        spin_inertia=requirement_section.spin_inertia,
        detection=requirement_section.notices,
    ).on(robot.mass_properties)
    faults = tuple(
        robot_contradictions(specification, robot, robot_size, requirement, envelope, varied=varied)
    )
    if faults:
        raise SpecificationError(f"the specification does not fit {robot.name}:", problems=faults)
    # Faults of a file of distributions are reported before anything is sized.
    default_uncertainty(height, file=specification.reality.file)
    choice = motor_choice(specification, robot)
    name = flywheel.material
    resolved = Resolved(
        requirement=requirement,
        envelope=envelope,
        material=material(DEFAULT_MATERIAL if name in {None, STEEL, AUTO} else name),
        torque_max=specification.motor.torque_max,
        choice=choice,
        assumptions=(),
        reliability=requirement_section.reliability
        if choice is None
        else requirement_section.reliability or RELIABILITY,
    )
    assumptions = tuple(_assumptions(specification, robot, resolved, worded))
    return replace(resolved, assumptions=assumptions)
