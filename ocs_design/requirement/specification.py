"""The specification: everything that the user set, in the file or by options, as one value."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, TypeVar, get_type_hints

from ocs_design.common.errors import UsageError
from ocs_design.requirement.device_sections import (
    FlywheelSection,
    MotorSection,
    OcsSection,
    SupplySection,
)
from ocs_design.requirement.keys import Faults, Key, keys_of
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.sections import RequirementSection, RobotSection, ValidationSection
from ocs_design.requirement.uncertainty import UncertaintySection

Section = TypeVar("Section")

LONGEST_REPR = 200
"""Longest `repr` of a specification, in characters."""


@dataclass(frozen=True, kw_only=True)
class Specification:
    """Everything that the user set; see the sections.

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
        """Whether the paper's three maneuvers apply: by default, or because the user names them."""
        requirement = self.requirement
        if self.maneuvers or requirement.maneuvers == "none":
            return False
        # A specified requirement is complete: nothing is added to it.
        is_empty = (
            requirement.rate_change is None
            and requirement.spin_inertia is None
            and not requirement.is_worded
        )
        return is_empty or requirement.maneuvers is not None

    @property
    def maneuvers_are_defaults(self) -> bool:
        """Whether the paper's three maneuvers apply by default only."""
        return self.takes_default_maneuvers and self.requirement.maneuvers is None

    @property
    def specified(self) -> Mapping[str, object]:
        """Values that are specified, by the paths of their keys; without maneuvers."""
        return {
            f"{section}.{name}": value
            for section in SECTIONS
            for name, value in vars(getattr(self, section)).items()
            if value is not None
        }

    def __repr__(self) -> str:
        specified = [f"{path}={value!r}" for path, value in self.specified.items()]
        specified += [f"maneuver {maneuver.name}" for maneuver in self.maneuvers]
        text = ", ".join(specified) or "nothing specified"
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
        f"{title}.{name}": key
        for title, section in SECTIONS.items()
        for name, key in keys_of(section).items()
    }


def merge(base: Specification, override: Specification) -> Specification:
    """`base`, overridden by everything that `override` specifies; joints are merged one by one.

    A robot file replaces a robot given by figures, and vice versa. Maneuvers requested in words
    replace all those of `base`: they are the requirement.
    """
    for named in (("file",), ("mass", "inertia"), ("human",)):
        if any(getattr(override.robot, key) is not None for key in named):
            others = {"file", "mass", "inertia", "human"} - set(named)
            base = replace(base, robot=replace(base.robot, **dict.fromkeys(others)))
            break
    if override.requirement.is_worded:
        requirement = replace(base.requirement.without_words(), maneuvers=None)
        base = replace(base, requirement=requirement, maneuvers=())
    sections = {
        name: merge_section(getattr(base, name), getattr(override, name)) for name in SECTIONS
    }
    return Specification(**sections, maneuvers=override.maneuvers or base.maneuvers)


def with_files(specification: Specification, renamed: Callable[[str], str]) -> Specification:
    """Specification with its files renamed, except `-`, which is standard input."""

    def path(file: str | None) -> str | None:
        """New path of a file."""
        return file if file is None or file == "-" else renamed(file)

    robot, motor, reality = specification.robot, specification.motor, specification.reality
    return replace(
        specification,
        robot=replace(robot, file=path(robot.file)),
        motor=replace(motor, motors=path(motor.motors), gears=path(motor.gears)),
        reality=replace(reality, file=path(reality.file)),
    )


def merge_section(base: Section, override: Section) -> Section:
    """One section, overridden by everything that `override` specifies."""
    changes: dict[str, Any] = {}
    for name, own in vars(base).items():
        other = getattr(override, name)
        if isinstance(own, Mapping) and isinstance(other, Mapping):
            changes[name] = {**own, **other}
        else:
            changes[name] = own if other is None else other
    return type(base)(**changes)


def specification_from_options(options: Mapping[str, object]) -> Specification:
    """The specification given by command-line options, parsed like the keys of a file.

    Args:
        options: text or flag by the key's path, as in `flywheel.r_max`; None: not given.

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
    return Specification(**{name: SECTIONS[name](**keys) for name, keys in sections.items()})
