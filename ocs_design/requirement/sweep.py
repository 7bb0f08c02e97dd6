"""One figure of a specification that is varied while all else stays as it is."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ocs_design.exceptions import UsageError
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.resolving import Resolved, resolve
from ocs_design.requirement.specification import Specification
from ocs_design.robot.robot import Robot
from ocs_design.units import Dimension


@dataclass(frozen=True, eq=False)
class Task:
    """What is designed for as it stands, before anything is varied.

    Attributes:
        specification: as stated. resolved: the same with nothing left open.
        robot: that it is for. robot_size: its largest extent [m].
    """

    specification: Specification
    resolved: Resolved
    robot: Robot
    robot_size: float

    @classmethod
    def of(cls, specification: Specification, robot: Robot, robot_size: float) -> "Task":
        """A specification resolved.

        Raises:
            SpecificationError: see `resolve`.
        """
        return cls(specification, resolve(specification, robot, robot_size), robot, robot_size)

    def with_specification(self, specification: Specification) -> "Task":
        """The same robot with another specification, resolved anew.

        Raises:
            SpecificationError: see `resolve`.
        """
        return Task.of(specification, self.robot, self.robot_size)

    @property
    def maneuvers(self) -> tuple[Maneuver, ...]:
        """Stated or assumed."""
        return self.resolved.requirement.maneuvers

    @property
    def standing_height(self) -> float:
        """Of the trunk over the ground [m]."""
        return self.resolved.requirement.standing_height


@dataclass(frozen=True)
class Sweep(ABC):
    """What is varied.

    Attributes:
        name: on the command line. label: of the figure, for people.
        dimension: of the figure. unit: in which people read it.
        span: lowest and highest value where none are stated, over the specification's own.
    """

    name: str
    label: str
    dimension: Dimension
    unit: str
    span: tuple[float, float]

    @abstractmethod
    def own(self, task: Task) -> float:
        """The specification's own value [SI].

        Raises:
            UsageError: it has none.
        """

    @abstractmethod
    def at(self, value: float, task: Task) -> Specification:
        """The specification with this value [SI] in place of its own.

        Raises:
            SpecificationError: nothing has this value.
        """

    @abstractmethod
    def remarks(self, task: Task) -> tuple[str, ...]:
        """What else moves, and what does not."""


@dataclass(frozen=True)
class KeySweep(Sweep):
    """One key of the file.

    Attributes:
        section, key: of the file.
        value: stated or assumed.
    """

    section: str
    key: str
    value: Callable[[Task], float]

    def own(self, task: Task) -> float:
        """See `Sweep.own`."""
        return self.value(task)

    def at(self, value: float, task: Task) -> Specification:
        """See `Sweep.at`."""
        change: dict[str, Any] = {self.key: value}
        section = replace(getattr(task.specification, self.section), **change)
        return _with_section(task.specification, self.section, section)

    def remarks(self, task: Task) -> tuple[str, ...]:
        """Nothing else moves."""
        del task
        return ()


@dataclass(frozen=True)
class ManeuverSweep(Sweep):
    """A figure of the maneuvers that turn the trunk.

    Attributes:
        figure: of one maneuver; None where it has none.
        scaled: the maneuver with its figure times a ratio.
        maneuver: which one varies alone; empty: all in one ratio, and the first gives the value.
    """

    figure: Callable[[Maneuver, float], float | None]
    scaled: Callable[[Maneuver, float, float], Maneuver]
    maneuver: str = ""

    def own(self, task: Task) -> float:
        """See `Sweep.own`."""
        found = self._figures(task)
        if found:
            return next(iter(found.values()))
        names = [item.name for item in task.maneuvers]
        if self.maneuver and self.maneuver not in names:
            raise UsageError(
                f"--maneuver {self.maneuver}: there is no such maneuver",
                hint=f"known: {', '.join(names) or 'none at all'}",
            )
        raise UsageError(
            f"--against {self.name}: {self.maneuver or 'the specification'} has no turn to vary",
            hint="state a drop or a flip, or vary the radius, the height or the voltage",
        )

    def at(self, value: float, task: Task) -> Specification:
        """See `Sweep.at`."""
        ratio, moved = value / self.own(task), self._figures(task)
        maneuvers = tuple(
            self.scaled(maneuver, ratio, task.standing_height)
            if maneuver.name in moved
            else maneuver
            for maneuver in task.maneuvers
        )
        # The paper's three are written out, and then no longer asked for by name.
        requirement = replace(task.specification.requirement, maneuvers=None)
        return replace(task.specification, requirement=requirement, maneuvers=maneuvers)

    def remarks(self, task: Task) -> tuple[str, ...]:
        """Which maneuver the value is of, which follow and which stay."""
        first, *others = self._figures(task)
        kept = [
            maneuver.name for maneuver in task.maneuvers if maneuver.name not in (first, *others)
        ]
        return (
            f"The {self.name} is that of {first!r}.",
            *([f"In the same ratio: {', '.join(others)}."] if others else []),
            *([f"As stated: {', '.join(kept)}."] if kept else []),
        )

    def _figures(self, task: Task) -> Mapping[str, float]:
        """Of every maneuver that is varied, by its name."""
        figures = {
            maneuver.name: self.figure(maneuver, task.standing_height)
            for maneuver in task.maneuvers
            if self.maneuver in ("", maneuver.name)
        }
        return {name: figure for name, figure in figures.items() if figure}


def _with_section(specification: Specification, name: str, section: object) -> Specification:
    change: dict[str, Any] = {name: section}
    return replace(specification, **change)
