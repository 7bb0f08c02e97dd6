"""What `pareto` answers: the lightest device at each value of one figure, all else as stated.

Every point is a design of its own. Its specification is part of the answer and is written beside
the front, so that `ocs-design size --spec points/NN.toml` makes that very device.
"""

from collections.abc import Mapping
from pathlib import Path

from ocs_design.common.files import AnyPath
from ocs_design.device.answers import Front
from ocs_design.export.folder import check_target
from ocs_design.report.charts.front import write_front
from ocs_design.report.text.console import Steps, Tell
from ocs_design.requirement.reading import specification_of
from ocs_design.requirement.resolving import read_specified_robot
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task, sweep_of
from ocs_design.sizing.comparison import draw_front
from ocs_design.sizing.design import lightest_device


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
    values = sweep.values(task, low=low, high=high, points=points)
    with steps.step(f"choose a device for each of {points} values") as step:
        front = draw_front(task, sweep, values, lightest_device, step.update)
    if out is not None:
        with steps.step("write the front") as step:
            step.note = "; ".join(write_front(front, Path(out), force=force))
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
    return Task.of(specification, robot)
