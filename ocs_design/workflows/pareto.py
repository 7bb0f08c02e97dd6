"""Answer of `pareto`: the lightest device at each value of one figure, all else as specified.

Every point is a complete design. Its specification is part of the answer and is written beside the
front, so that `ocs-design size --spec points/NN.toml` makes exactly that device.
"""

from collections.abc import Mapping
from pathlib import Path

from ocs_design.common.files import AnyPath
from ocs_design.device.answers import Front
from ocs_design.export.folder import check_target
from ocs_design.report.charts.front import write_front
from ocs_design.report.text.console import ProgressCallback, Steps
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
    progress: Steps | ProgressCallback | None = None,
) -> Front:
    """Mass of the lightest device against time, angle, envelope or voltage, all else as specified.

    Args:
        design_for: a specification, the path of its file, or that of a robot.
        against: `time`, `angle`, `radius`, `height` or `voltage`.
        low, high: first and last value, with units, as in `300ms`; None: around the
            specification's own.
        points: number of values.
        maneuver: the only one whose time or angle is varied; empty: all, in proportion.
        package_paths: folder of each package, for `package://` addresses.
        out: folder for the front, its chart and the specification of each point; None: none.
        force: replace an existing folder.
        strict: warnings about the robot are errors.
        progress: see `design_ocs`.

    Raises:
        OcsError: the robot cannot be read, or the values form no range.
    """
    steps, sweep = Steps.of(progress), sweep_of(against, maneuver)
    if out is not None:
        check_target(Path(out), force=force)
    with steps.step("read the robot") as step:
        task = read_task(specification_of(design_for), package_paths=package_paths, strict=strict)
        step.note = task.robot.name
    steps.warn(task.robot.warnings)
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
    """Robot and specification before anything is varied.

    Raises:
        OcsError: the robot cannot be read, or the specification does not fit it.
    """
    robot = read_specified_robot(specification, package_paths=package_paths, strict=strict)
    return Task.of(specification, robot)
