"""What `pareto` answers: the lightest device at each value of one figure, all else as stated.

Every point is a design of its own. Its specification is part of the answer and is written beside
the front, so that `ocs-design size --spec points/NN.toml` makes that very device.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from ocs_design.design_file import SCHEMA_VERSION
from ocs_design.exceptions import Infeasible, SpecificationError, UsageError
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.stated_robot import read_stated_robot
from ocs_design.requirement.sweep import Sweep, Task
from ocs_design.requirement.writing import specification_to_toml, with_absolute_files
from ocs_design.robot.bounds import size
from ocs_design.sizing.selection.by_criterion import select_by
from ocs_design.sizing.selection.stated import selection_problem, stated_criterion
from ocs_design.units import format_quantity, parse_quantity, si_unit

FEWEST, MOST = 2, 200
"""Points of a front."""


@dataclass(frozen=True, kw_only=True)
class FrontDevice:
    """The lightest device of a point; SI.

    Attributes:
        mass: of both modules: rims, motors, gears and housings. share: of the robot's.
        motor, gear, material: names in the catalogue.
        incidence: of the wheel axes.
        outer_radius, inner_radius, height, rim_mass: of one rim.
        spin_inertia: of one wheel, rotor included.
    """

    mass: float
    share: float
    motor: str
    gear: str
    material: str
    incidence: float
    outer_radius: float
    inner_radius: float
    height: float
    rim_mass: float
    spin_inertia: float


@dataclass(frozen=True, kw_only=True)
class FrontPoint:
    """One value of the figure that is varied.

    Attributes:
        value: [SI].
        file: of its specification, below the output folder. specification: its text.
        device: None: there is none.
        reason: why there is none; empty if there is one.
    """

    value: float
    file: str
    specification: str
    device: FrontDevice | None
    reason: str


@dataclass(frozen=True, kw_only=True)
class Front:
    """The whole answer; SI.

    Attributes:
        robot: its name. against: what is varied, by its name and for people.
        unit: in which people read the values. si_unit: in which they are.
        own_value: the specification's.
        remarks: what moves with it, and what does not.
        assumptions: of the specification as it stands.
        points: by rising value.
    """

    schema_version: int
    robot: str
    against: str
    label: str
    unit: str
    si_unit: str
    own_value: float
    remarks: tuple[str, ...]
    assumptions: tuple[str, ...]
    points: tuple[FrontPoint, ...]

    @property
    def spans_own_value(self) -> bool:
        """Whether the specification's own value lies among the points."""
        return self.points[0].value <= self.own_value <= self.points[-1].value

    @property
    def feasible(self) -> tuple[FrontPoint, ...]:
        """Points that have a device."""
        return tuple(point for point in self.points if point.device is not None)

    @property
    def exit_code(self) -> int:
        """0, or 4 if no point has a device."""
        return 0 if self.feasible else Infeasible.exit_code


Choose = Callable[[Task], FrontDevice]
"""The lightest device for a task; raises `Infeasible` where there is none."""


def read_task(
    specification: Specification,
    *,
    package_paths: Mapping[str, Path] | None = None,
    strict: bool = False,
) -> Task:
    """Robot and specification as they stand.

    Raises:
        OcsError: the robot cannot be read, or the specification does not fit it.
    """
    robot = read_stated_robot(specification, package_paths=package_paths, strict=strict)
    return Task.of(specification, robot, size(robot.tree, robot.posture, robot.trunk))


def front_values(
    sweep: Sweep, task: Task, *, low: str | None, high: str | None, points: int
) -> tuple[float, ...]:
    """Values at equal distances [SI].

    Args:
        sweep: what is varied. task: as it stands.
        low, high: from and to, with units; None: around the specification's own value, which is
            then one of the values if there are nine of them.
        points: how many.

    Raises:
        QuantityError, UsageError: they cannot be read, or make no range.
    """
    if not FEWEST <= points <= MOST:
        raise UsageError(f"--points {points}: must lie between {FEWEST} and {MOST}")
    start, end = (
        factor * sweep.own(task) if text is None else _positive(text, sweep, option)
        for factor, text, option in zip(sweep.span, (low, high), ("--from", "--to"), strict=True)
    )
    if not start < end:
        first, last = (format_quantity(value, sweep.unit) for value in (start, end))
        raise UsageError(
            f"--from {first} is not below --to {last}", hint="give both, the smaller one first"
        )
    return tuple(float(value) for value in np.linspace(start, end, points))


def lightest_device(task: Task) -> FrontDevice:
    """The selection's lightest, before any co-design.

    Raises:
        Infeasible: there is none; does not say what would help. UsageError: no motor is wanted.
    """
    problem = selection_problem(task.specification, task.robot, task.resolved)
    if problem is None:
        raise UsageError(
            "a front needs motors to choose from",
            hint="leave out --motor none, or motor.name in the specification",
        )
    best = select_by(problem, stated_criterion(task.specification), advise=False).best
    return FrontDevice(
        mass=best.mass,
        share=best.mass / task.robot.mass,
        motor=best.motor.name,
        gear=best.gear.name,
        material=best.material.name,
        incidence=best.incidence,
        outer_radius=best.outer_radius,
        inner_radius=best.inner_radius,
        height=best.height,
        rim_mass=best.rim_mass,
        spin_inertia=best.spin_inertia,
    )


def draw_front(
    task: Task,
    sweep: Sweep,
    values: Sequence[float],
    choose: Choose,
    progress: Callable[[float], None] | None = None,
) -> Front:
    """The lightest device at each value; where there is none, why.

    Args:
        task: as it stands.
        sweep: what is varied. values: of it [SI].
        choose: makes a device.
        progress: told the part of the work that is done, 0..1.
    """
    points = []
    for index, value in enumerate(values):
        points.append(_point(index, value, task, sweep, choose))
        if progress is not None:
            progress((index + 1) / len(values))
    return Front(
        schema_version=SCHEMA_VERSION,
        robot=task.robot.name,
        against=sweep.name,
        label=sweep.label,
        unit=sweep.unit,
        si_unit=si_unit(sweep.dimension),
        own_value=sweep.own(task),
        remarks=sweep.remarks(task),
        assumptions=task.resolved.assumptions,
        points=tuple(points),
    )


def front_to_json(front: Front) -> bytes:
    """As indented UTF-8 JSON."""
    return msgspec.json.format(msgspec.json.encode(front), indent=2) + b"\n"


def _point(index: int, value: float, task: Task, sweep: Sweep, choose: Choose) -> FrontPoint:
    """One design; a value for which nothing can be designed is an answer too."""
    specification = with_absolute_files(sweep.at(value, task))
    file = f"points/{index + 1:02d}.toml"
    device, reason = None, ""
    try:
        device = choose(task.with_specification(specification))
    except Infeasible as error:
        reason = error.message
    except SpecificationError as error:
        reason = "; ".join(error.problems) or error.message
    what = f"{sweep.label}: {format_quantity(value, sweep.unit)}"
    text = specification_to_toml(specification, f"{what}\nocs-design size --spec {file}")
    return FrontPoint(value=value, file=file, specification=text, device=device, reason=reason)


def _positive(text: str, sweep: Sweep, option: str) -> float:
    value = parse_quantity(text, sweep.dimension, option)
    if value <= 0.0:
        raise UsageError(f"{option} {text}: must be positive")
    return value
