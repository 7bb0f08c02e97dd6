"""Kinds of maneuver: their names and keys in a specification, and a change of one in words."""

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from functools import cached_property
from types import MappingProxyType
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from ocs_design.common.units import round_outwards, si_unit
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.pivoted import Balance, StandUp
from ocs_design.requirement.pushes import Disturbance, Shove
from ocs_design.requirement.turns import Catch, Drop, Flip, TurnTo
from ocs_design.requirement.values import Quantities, Quantity, Value


@dataclass(frozen=True)
class ManeuverKind:
    """A kind of maneuver as it is written in a specification.

    Attributes:
        maneuver: the class; a field whose annotation has a `Value` and a note is a key of the file.
        note: a sentence that describes it, for the file.
    """

    maneuver: type[Maneuver]
    note: str

    @cached_property
    def _annotations(self) -> Mapping[str, tuple[Any, ...]]:
        """Annotation of each key: its type, its parser and, last, the note."""
        hints = get_type_hints(self.maneuver, include_extras=True)
        said = {item.name: hints[item.name] for item in fields(self.maneuver)}
        return {
            name: get_args(hint) for name, hint in said.items() if get_origin(hint) is Annotated
        }

    @cached_property
    def values(self) -> Mapping[str, Value[Any]]:
        """Parser of each key, by name."""
        return {name: annotation[1] for name, annotation in self._annotations.items()}

    @cached_property
    def notes(self) -> Mapping[str, str]:
        """Note on each key, by name."""
        return {name: annotation[-1] for name, annotation in self._annotations.items()}

    @property
    def required(self) -> tuple[str, ...]:
        """Fields that have no default."""
        return tuple(item.name for item in fields(self.maneuver) if item.default is MISSING)


MANEUVER_KINDS: Mapping[str, ManeuverKind] = MappingProxyType(
    {
        "disturbance": ManeuverKind(
            Disturbance, "A jump in which something hits the trunk, which must stay level."
        ),
        "shove": ManeuverKind(
            Shove, "A torque on a standing or trotting robot, which must soon be at rest again."
        ),
        "drop": ManeuverKind(
            Drop, "A fall from rest with the trunk tilted, which must be level before touchdown."
        ),
        "flip": ManeuverKind(
            Flip, "A turn in pitch during a vertical jump; negative for a back-flip."
        ),
        "turn": ManeuverKind(
            TurnTo, "A turn to any attitude, heading included, during a vertical jump."
        ),
        "catch": ManeuverKind(Catch, "A trunk that rotates at lift-off and must be stopped."),
        "balance": ManeuverKind(
            Balance, "A tilt, rate or impulse of a robot on a pivot, corrected by feedback alone."
        ),
        "stand-up": ManeuverKind(
            StandUp, "A climb from a tilt to upright about a pivot, by motors or by a brake."
        ),
    }
)
"""Every kind, by the value of the key `kind`."""


def kind_of(maneuver: Maneuver) -> tuple[str, ManeuverKind]:
    """Kind of a maneuver, with the value of the key `kind`."""
    return next(item for item in MANEUVER_KINDS.items() if item[1].maneuver is type(maneuver))


def change_text(before: Maneuver, after: Maneuver) -> str:
    """Keys of `after` that differ from those of `before`, rounded up, as in `height 2 m`."""
    changes = []
    for name, how in kind_of(after)[1].values.items():
        old, new = getattr(before, name), getattr(after, name)
        match how:
            case Quantity(dimension=dimension) if old != new:
                changes.append(f"{name} {_up(new)} {si_unit(dimension)}")
            case Quantities(dimension=dimension) if old != new:
                kept = zip(old, new, strict=True)
                figures = [f"{a:.6g}" if a == b else _up(b) for a, b in kept]
                changes.append(f"{name} [{', '.join(figures)}] {si_unit(dimension)}")
    return f"{after.name} {' and '.join(changes)}"


def _up(value: float) -> str:
    return f"{round_outwards(value, upwards=True):.6g}"
