"""What `pareto` answers: the lightest device at each value of one figure, all else as stated.

Every point is a design of its own. Its specification is part of the answer and is written beside
the front, so that `ocs-design size --spec points/NN.toml` makes that very device.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ocs_design.common.errors import Infeasible, SpecificationError, UsageError
from ocs_design.common.files import AnyPath
from ocs_design.common.records import recorded
from ocs_design.common.units import format_quantity, parse_positive, si_unit
from ocs_design.device.answers import Front, FrontDevice, FrontPoint
from ocs_design.device.records.design import SCHEMA_VERSION
from ocs_design.export.folder import check_target
from ocs_design.report.charts.front import write_front
from ocs_design.report.text.console import Steps, Tell
from ocs_design.requirement.reading import specification_of
from ocs_design.requirement.resolving import read_specified_robot
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Sweep, Task, sweep_of
from ocs_design.requirement.writing import specification_to_toml, with_absolute_files
from ocs_design.robot.meshes import size
from ocs_design.sizing.design import design_device

FEWEST, MOST = 2, 200
"""Points of a front."""


Choose = Callable[[Task], FrontDevice]
"""The lightest device for a task; raises `Infeasible` where there is none."""


def pareto_front(
    design_for: Specification | AnyPath,
    against: str = "time",
    *,
    low: str | None = None,
    high: str | None = None,
    points: int = 9,
    maneuver: str = "",
    package_paths: Mapping[str, AnyPath] | None = None,
    out: AnyPath | None = None,
    force: bool = False,
    strict: bool = False,
    progress: Steps | Tell | None = None,
) -> Front:
    """Mass of the lightest device against time, angle or room, all else as specified.

    Args:
        design_for: a specification, the path of its file, or that of a robot.
        against: `time`, `angle`, `radius`, `height` or `voltage`.
        low, high: from and to, with units, as in `300ms`; None: around the specification's own.
        points: how many values.
        maneuver: whose time or angle alone is varied; empty: those of all, in one ratio.
        package_paths: folder of each package that `package://` addresses name.
        out: folder for the front, its chart and the specification of each point; None: none.
        force: replace an existing folder.
        strict: warnings about the robot are errors.
        progress: see `design_ocs`.

    Raises:
        OcsError: the robot cannot be read, or the values make no range.
    """
    steps, sweep = Steps.of(progress), sweep_of(against, maneuver)
    if out is not None:
        check_target(Path(out), force=force)
    with steps.step("read the robot") as step:
        task = read_task(specification_of(design_for), package_paths=package_paths, strict=strict)
        step.note = task.robot.name
    steps.doubt(task.robot.warnings)
    values = front_values(sweep, task, low=low, high=high, points=points)
    with steps.step(f"choose a device for each of {points} values") as step:
        front = draw_front(task, sweep, values, lightest_device, step.update)
    if out is not None:
        steps.doubt(write_front(front, Path(out), force=force))
    return front


def read_task(
    specification: Specification,
    *,
    package_paths: Mapping[str, AnyPath] | None = None,
    strict: bool = False,
) -> Task:
    """Robot and specification as they stand.

    Raises:
        OcsError: the robot cannot be read, or the specification does not fit it.
    """
    robot = read_specified_robot(specification, package_paths=package_paths, strict=strict)
    return Task.of(specification, robot, size(robot.tree, robot.posture, robot.trunk))


def front_values(
    sweep: Sweep, task: Task, *, low: str | None, high: str | None, points: int
) -> tuple[float, ...]:
    """Values of the figure that is varied, at equal distances [SI].

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
        factor * sweep.own(task) if text is None else parse_positive(text, sweep.dimension, option)
        for factor, text, option in zip(sweep.span, (low, high), ("--from", "--to"), strict=True)
    )
    if not start < end:
        first, last = (format_quantity(value, sweep.unit) for value in (start, end))
        raise UsageError(
            f"--from {first} is not below --to {last}", hint="give both, the smaller one first"
        )
    return tuple(float(value) for value in np.linspace(start, end, points))


def lightest_device(task: Task) -> FrontDevice:
    """Lightest device that is selected for a task, before any co-design.

    Raises:
        Infeasible: there is none; does not say what would help. UsageError: no motor is wanted.
    """
    if task.resolved.choice is None:
        raise UsageError(
            "a front needs motors to choose from",
            hint="leave out --motor none, or motor.name in the specification",
        )
    stated = task.specification
    alone = replace(stated, ocs=replace(stated.ocs, co_design=False))
    designed = design_device(alone, task.robot, task.resolved, ranked=False)
    choice = designed.choice
    assert choice is not None, "there are motors to choose from"
    best = choice.chosen
    return recorded(
        FrontDevice,
        best,
        share=best.mass / task.robot.mass,
        motor=best.motor.name,
        gear=best.gear.name,
        material=best.material.name,
    )


def draw_front(
    task: Task,
    sweep: Sweep,
    values: Sequence[float],
    choose: Choose,
    progress: Callable[[float], None] | None = None,
) -> Front:
    """Front of the lightest device at each value; where there is none, why.

    Args:
        task: as it stands.
        sweep: what is varied. values: of it [SI].
        choose: makes a device.
        progress: told the part of the work that is done, 0..1.
    """
    points = []
    for index, value in enumerate(values):
        specification = with_absolute_files(sweep.at(value, task))
        file = f"points/{index + 1:02d}.toml"
        # A value for which nothing can be designed is an answer too.
        device, reason = None, ""
        try:
            device = choose(task.with_specification(specification))
        except Infeasible as error:
            reason = error.message
        except SpecificationError as error:
            reason = "; ".join(error.problems) or error.message
        what = f"{sweep.label}: {format_quantity(value, sweep.unit)}"
        text = specification_to_toml(specification, f"{what}\nocs-design size --spec {file}")
        points.append(
            FrontPoint(value=value, file=file, specification=text, device=device, reason=reason)
        )
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
