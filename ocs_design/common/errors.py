"""Errors that a user can act on.

Every error has its data as attributes, a message that says what is wrong and where, and a hint on
what to do. The command line prints them as one panel; any other exception that escapes is a bug and
keeps its traceback. Also what hints are composed of: install commands of missing packages, and
names that a mistyped one may mean.
"""

import shlex
import sys
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from enum import StrEnum
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar

INTERRUPTED = 130
"""Exit code of an interrupted command, as shells have it."""


class OcsError(Exception):
    """Base of all expected errors.

    Attributes:
        message: what is wrong, and where.
        hint: what the user can do about it; empty if nothing.
        kind: short machine-readable name, stable over versions.
        exit_code: the process exit code of the command line.
    """

    kind: ClassVar[str] = "error"
    exit_code: ClassVar[int] = 3

    def __init__(self, message: str, *, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint

    def __reduce__(self) -> tuple[Any, ...]:
        # A pool of processes hands an error on by its state, not by its constructor's arguments.
        return _restored, (type(self), self.args, vars(self))

    @property
    def sentence(self) -> str:
        """Message and hint in one line, for a list of faults."""
        return f"{self.message}. {self.hint}" if self.hint else self.message

    def data(self) -> Mapping[str, Any]:
        """Further fields for the JSON form of the error."""
        return {}


def _restored(kind: type[OcsError], texts: tuple[str, ...], state: Mapping[str, Any]) -> OcsError:
    """An error as it was pickled."""
    error = kind.__new__(kind, *texts)
    vars(error).update(state)
    return error


class UsageError(OcsError):
    """Options that contradict each other or cannot be understood (exit 2)."""

    kind = "usage"
    exit_code = 2


class QuantityError(OcsError):
    """A quantity that cannot be read: not a number, an unknown unit, or a wrong dimension."""

    kind = "quantity"
    exit_code = 2


class RobotError(OcsError):
    """The robot cannot be read or is not physical."""

    kind = "robot"


class SpecificationError(OcsError):
    """The specification is wrong; `problems` lists every fault, each with its key's path."""

    kind = "specification"

    def __init__(self, message: str, *, problems: Sequence[str] = (), hint: str = "") -> None:
        super().__init__(message, hint=hint)
        self.problems = tuple(problems)

    def __str__(self) -> str:
        return "\n  ".join((self.message, *self.problems))

    def data(self) -> Mapping[str, Any]:
        """Each fault as one line."""
        return {"problems": list(self.problems)}


class OutputError(OcsError):
    """The output folder cannot be written or exists already."""

    kind = "output"


class PartError(OcsError):
    """A part of these dimensions cannot be made."""

    kind = "part"


class Constraint(StrEnum):
    """Constraints that may rule out a design.

    Attributes:
        R_MAX, R_MIN, H_MAX, H_MIN, WALL_MIN, WHEEL_MASS_MAX, WHEEL_SPEED_MAX, MASS_MAX: the limit
            that this key of the specification sets.
        HOOP_STRESS: strength of the rim's material over `stress_safety`.
        ENVELOPE: all limits of a wheel's dimensions together.
        BUS_VOLTAGE, BUS_POWER: of the supply. TIME: for the maneuvers.
        TORQUE, SPEED: of the motor, whatever the wheel.
        FIGURES: data of the motor that its source lacks.
        INCIDENCE: leaves an axis of the robot out of the wheels' reach.
        OWN_WEIGHT: what the device adds to the robot's inertia, or to another device's mass.
        MOUNT: what holds the device on the trunk. GUARD: rings that contain a burst wheel.
        SURVIVES: that any one drive may fail.
    """

    R_MAX = "r_max"
    R_MIN = "r_min"
    H_MAX = "h_max"
    H_MIN = "h_min"
    WALL_MIN = "wall_min"
    WHEEL_MASS_MAX = "wheel_mass_max"
    HOOP_STRESS = "hoop_stress"
    ENVELOPE = "envelope"
    WHEEL_SPEED_MAX = "wheel_speed_max"
    BUS_VOLTAGE = "bus_voltage"
    BUS_POWER = "bus_power"
    TIME = "time"
    MASS_MAX = "mass_max"
    TORQUE = "torque"
    SPEED = "speed"
    FIGURES = "missing figures"
    INCIDENCE = "incidence"
    OWN_WEIGHT = "own weight"
    MOUNT = "mount"
    GUARD = "guard"
    SURVIVES = "survives"


class Infeasible(OcsError):
    """No design meets the specification.

    Attributes:
        binding: constraints that together forbid a design.
        largest_spin_inertia: the largest spin inertia that the limits allow [kg m^2].
        required_spin_inertia: the required one [kg m^2]; None: no wheel is large enough, or the
            obstacle is not the wheel.
        relaxations: for each constraint whose change alone gives a design, the limit that just
            suffices (SI).
        assumptions, warnings: defaults that apply, and warnings about the robot's file, one
            sentence each, once they are known.
    """

    kind = "infeasible"
    exit_code = 4

    def __init__(
        self,
        message: str,
        *,
        binding: Sequence[Constraint],
        required_spin_inertia: float | None = None,
        largest_spin_inertia: float = 0.0,
        relaxations: Mapping[Constraint, float] = MappingProxyType({}),
        hint: str = "",
    ) -> None:
        super().__init__(message, hint=hint)
        self.binding = tuple(binding)
        self.required_spin_inertia = required_spin_inertia
        self.largest_spin_inertia = largest_spin_inertia
        self.relaxations = dict(relaxations)
        self.assumptions: tuple[str, ...] = ()
        self.warnings: tuple[str, ...] = ()

    def data(self) -> Mapping[str, Any]:
        """Binding constraints, inertias and relaxations (SI); assumptions and warnings."""
        return {
            "binding": list(self.binding),
            "required_spin_inertia": self.required_spin_inertia,
            "largest_spin_inertia": self.largest_spin_inertia,
            "relaxations": self.relaxations,
            "assumptions": list(self.assumptions),
            "warnings": list(self.warnings),
        }


class MissingToolError(OcsError):
    """An optional tool is not installed; the hint has the command that installs it."""

    kind = "missing_tool"
    exit_code = 5


DISTRIBUTION = "ocs-design"


def install_command(*requirements: str, options: str = "") -> str:
    """Install command of the tool that made this environment: pip, pipx or uv."""
    what = " ".join([*options.split(), *(f"'{requirement}'" for requirement in requirements)])
    environment = Path(sys.prefix)
    if (environment / "pipx_metadata.json").is_file():
        return f"pipx runpip {environment.name} install {what}"
    if find_spec("pip") is None:
        return f"uv pip install --python {shlex.quote(sys.executable)} {what}"
    return f"pip install {what}"


def extra_command(*extras: str) -> str:
    """Command that installs extras of this program, such as `ocs-design[step]`."""
    return install_command(f"{DISTRIBUTION}[{','.join(extras)}]")


def closest(word: str, known: Iterable[str], *, most: int = 1, cutoff: float = 0.6) -> list[str]:
    """Names that a mistyped word may mean, whatever their case, the closest first.

    Args:
        word: as typed. known: all names.
        most: largest number of names. cutoff: least similarity, 0..1 (`difflib`).
    """
    folded = {name.casefold(): name for name in known}
    matches = get_close_matches(word.casefold(), folded, n=most, cutoff=cutoff)
    return [folded[match] for match in matches]
