"""One figure of a specification, varied while everything else stays fixed."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from math import hypot
from types import MappingProxyType
from typing import Any

import numpy as np

from ocs_design.common.errors import UsageError
from ocs_design.common.units import Dimension, format_quantity, parse_positive
from ocs_design.requirement.choices import specified_supply
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.requirement import Requirement
from ocs_design.requirement.resolving import Resolved, resolve
from ocs_design.requirement.specification import Specification
from ocs_design.robot.meshes import longest_side
from ocs_design.robot.robot import Robot


@dataclass(frozen=True, eq=False)
class Task:
    """What is designed for, before anything is varied.

    Attributes:
        specification: as given. resolved: the same with its defaults filled in.
        robot: to design for. robot_size: its largest extent [m].
    """

    specification: Specification
    resolved: Resolved
    robot: Robot
    robot_size: float

    @classmethod
    def of(cls, specification: Specification, robot: Robot) -> "Task":
        """Task for a specification, resolved.

        Raises:
            SpecificationError: see `resolve`.
        """
        extent = longest_side(robot.tree, robot.posture, robot.trunk)
        return cls(specification, resolve(specification, robot, extent), robot, extent)

    def with_specification(self, specification: Specification) -> "Task":
        """Task for the same robot with a variant of the specification, which is resolved again.

        Raises:
            SpecificationError: see `resolve`.
        """
        resolved = resolve(specification, self.robot, self.robot_size, varied=True)
        present = self.specification
        if (present.requirement, present.maneuvers) == (
            specification.requirement,
            specification.maneuvers,
        ):
            # It stays as it is: turns may have been found to need more than estimated.
            resolved = replace(resolved, requirement=self.resolved.requirement)
        return replace(self, specification=specification, resolved=resolved)

    def with_requirement(self, requirement: Requirement) -> "Task":
        """Task for the same robot and specification, with another requirement."""
        return replace(self, resolved=replace(self.resolved, requirement=requirement))

    def with_key(self, section: str, key: str, value: float) -> Specification:
        """The specification with one key of the file at another value [SI]."""
        specified: Any = getattr(self.specification, section)
        changes: dict[str, Any] = {section: replace(specified, **{key: value})}
        return replace(self.specification, **changes)

    def with_maneuvers(
        self, change: Callable[[Maneuver], Maneuver], names: Collection[str]
    ) -> Specification:
        """The specification with the maneuvers of these names changed.

        All maneuvers are written out, and no longer requested by name or in words.
        """
        maneuvers = tuple(
            change(maneuver) if maneuver.name in names else maneuver for maneuver in self.maneuvers
        )
        requirement = replace(self.specification.requirement.without_words(), maneuvers=None)
        return replace(self.specification, requirement=requirement, maneuvers=maneuvers)

    @property
    def maneuvers(self) -> tuple[Maneuver, ...]:
        """Maneuvers, specified or default."""
        return self.resolved.requirement.maneuvers


POINTS_MIN, POINTS_MAX = 2, 200
"""Fewest and most points of a front."""


@dataclass(frozen=True)
class Sweep(ABC):
    """A figure of a specification that is varied.

    Attributes:
        name: on the command line. label: of the figure, for display.
        dimension: of the figure. unit: for display.
        span: default lowest and highest values, over the specification's own.
    """

    name: str
    label: str
    dimension: Dimension
    unit: str
    span: tuple[float, float]

    @abstractmethod
    def present_value(self, task: Task) -> float:
        """The specification's own value [SI].

        Raises:
            UsageError: it has none.
        """

    @abstractmethod
    def at(self, value: float, task: Task) -> Specification:
        """The specification with this value [SI] in place of its own.

        Raises:
            SpecificationError: no maneuver can have this value.
        """

    def values(
        self, task: Task, *, low: str | None, high: str | None, points: int
    ) -> tuple[float, ...]:
        """Equally spaced values of the figure that is varied [SI].

        Args:
            task: to vary.
            low, high: first and last value, with units; None: around the specification's own
                value, which is one of the values if there are nine.
            points: how many.

        Raises:
            QuantityError, UsageError: they cannot be parsed, or form no range.
        """
        if not POINTS_MIN <= points <= POINTS_MAX:
            raise UsageError(f"--points {points}: must lie between {POINTS_MIN} and {POINTS_MAX}")
        start, end = (
            factor * self.present_value(task)
            if text is None
            else parse_positive(text, self.dimension, option)
            for factor, text, option in zip(self.span, (low, high), ("--from", "--to"), strict=True)
        )
        if not start < end:
            first, last = (format_quantity(value, self.unit) for value in (start, end))
            raise UsageError(
                f"--from {first} is not below --to {last}", hint="give both, the smaller one first"
            )
        return tuple(float(value) for value in np.linspace(start, end, points))

    def remarks(self, task: Task) -> tuple[str, ...]:
        """Sentences on what else changes, and what does not."""
        del task
        return ()


@dataclass(frozen=True)
class KeySweep(Sweep):
    """A figure that is one key of the file; nothing else changes.

    Attributes:
        section, key: of the file.
        value: specified or default.
    """

    section: str
    key: str
    value: Callable[[Task], float]

    def present_value(self, task: Task) -> float:
        """Value that the specification has (`Sweep.present_value`)."""
        return self.value(task)

    def at(self, value: float, task: Task) -> Specification:
        """Specification at another value (`Sweep.at`)."""
        return task.with_key(self.section, self.key, value)


@dataclass(frozen=True)
class ManeuverSweep(Sweep):
    """A figure of the maneuvers that turn the trunk.

    Attributes:
        figure: of a maneuver that has one (`Maneuver.turned_by`).
        scaled: a maneuver with its figure multiplied by a ratio.
        maneuver: the only one to vary; empty: all, in proportion, and the first gives the value.
    """

    figure: Callable[[Maneuver], float]
    scaled: Callable[[Maneuver, float], Maneuver]
    maneuver: str = ""

    def present_value(self, task: Task) -> float:
        """Value that the specification has (`Sweep.present_value`)."""
        figures = self._figures(task)
        if figures:
            return next(iter(figures.values()))
        names = [item.name for item in task.maneuvers]
        if self.maneuver and self.maneuver not in names:
            raise UsageError(
                f"--maneuver {self.maneuver}: there is no such maneuver",
                hint=f"known: {', '.join(names) or 'none at all'}",
            )
        raise UsageError(
            f"--against {self.name}: {self.maneuver or 'the specification'} has no turn to vary",
            hint="add a drop or a flip, or vary the radius, the height or the voltage",
        )

    def at(self, value: float, task: Task) -> Specification:
        """Specification at another value (`Sweep.at`)."""
        ratio = value / self.present_value(task)
        return task.with_maneuvers(
            lambda maneuver: self.scaled(maneuver, ratio), self._figures(task)
        )

    def remarks(self, task: Task) -> tuple[str, ...]:
        """Sentences on which maneuver gives the value, which vary with it and which do not."""
        first, *others = self._figures(task)
        unchanged = [
            maneuver.name for maneuver in task.maneuvers if maneuver.name not in (first, *others)
        ]
        return (
            f"The {self.name} is that of {first!r}.",
            *([f"Varied in proportion: {', '.join(others)}."] if others else []),
            *([f"Not varied: {', '.join(unchanged)}."] if unchanged else []),
        )

    def _figures(self, task: Task) -> Mapping[str, float]:
        """Figure of every maneuver that is varied, by the maneuver's name."""
        figures = {
            maneuver.name: self.figure(maneuver)
            for maneuver in task.maneuvers
            if self.maneuver in ("", maneuver.name) and maneuver.turned_by
        }
        return {name: figure for name, figure in figures.items() if figure}


_SWEEPS = (
    ManeuverSweep(
        "time",
        "time of the turn",
        Dimension.TIME,
        "ms",
        (0.8, 1.6),
        lambda maneuver: maneuver.boundary().duration,
        lambda maneuver, ratio: maneuver.stretched(ratio),
    ),
    ManeuverSweep(
        "angle",
        "angle of the turn",
        Dimension.ANGLE,
        "deg",
        (0.4, 1.6),
        lambda maneuver: hypot(*(getattr(maneuver, name) for name in maneuver.turned_by)),
        # Roll and pitch of a tilt keep their proportion.
        lambda maneuver, ratio: maneuver.scaled(ratio, *maneuver.turned_by),
    ),
    KeySweep(
        "radius",
        "room for the rim, r_max",
        Dimension.LENGTH,
        "mm",
        (0.6, 1.4),
        "flywheel",
        "r_max",
        lambda task: task.resolved.envelope.outer_radius_max,
    ),
    KeySweep(
        "height",
        "room for the rim, h_max",
        Dimension.LENGTH,
        "mm",
        (0.4, 2.0),
        "flywheel",
        "h_max",
        lambda task: task.resolved.envelope.height_max,
    ),
    KeySweep(
        "voltage",
        "bus voltage",
        Dimension.VOLTAGE,
        "V",
        (0.5, 2.5),
        "supply",
        "voltage",
        lambda task: specified_supply(task.specification, task.robot).voltage,
    ),
)

SWEEPS: Mapping[str, Sweep] = MappingProxyType({sweep.name: sweep for sweep in _SWEEPS})
"""Everything that can be varied, by the value of `--against`."""


def sweep_of(name: str, maneuver: str = "") -> Sweep:
    """The sweep called `name`, of one maneuver alone if that is named.

    Raises:
        UsageError: there is none, or it does not vary maneuvers.
    """
    sweep = SWEEPS.get(name)
    if sweep is None:
        raise UsageError(f"--against {name}: is not one of {', '.join(SWEEPS)}")
    if not maneuver:
        return sweep
    if not isinstance(sweep, ManeuverSweep):
        raise UsageError(f"--maneuver {maneuver}: the {name} is not a figure of a maneuver")
    return replace(sweep, maneuver=maneuver)
