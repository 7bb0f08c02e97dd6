"""Answer of `size --layout all`: a device of each layout, for the same requirement."""

from collections.abc import Mapping
from dataclasses import replace

from ocs_design.common.errors import Infeasible
from ocs_design.common.files import AnyPath
from ocs_design.device.answers import LayoutAnswer, LayoutsAnswer
from ocs_design.report.text.console import ProgressCallback, Steps
from ocs_design.requirement.reading import specification_of
from ocs_design.requirement.resolving import read_specified_robot
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import Task
from ocs_design.requirement.vocabulary import LAYOUTS
from ocs_design.sizing.comparison import layout_answer
from ocs_design.sizing.design import design_device


def compare_layouts(
    design_for: Specification | AnyPath,
    *,
    package_paths: Mapping[str, AnyPath] | None = None,
    strict: bool = False,
    progress: Steps | ProgressCallback | None = None,
) -> LayoutsAnswer:
    """The lightest device of each layout, its momentum, and what is left after losing a wheel.

    Nothing is flown or exported.

    Args:
        design_for: a specification, the path of its file, or that of a robot; its own layout is
            ignored.
        package_paths: folder of each package, for `package://` addresses.
        strict: warnings about the robot are errors.
        progress: see `design_ocs`.

    Raises:
        OcsError: the robot cannot be read, or the specification does not fit it.
    """
    steps, specified = Steps.of(progress), specification_of(design_for)
    robot = read_specified_robot(specified, package_paths=package_paths, strict=strict)
    answers = []
    for layout in LAYOUTS:
        varied = replace(specified, ocs=replace(specified.ocs, layout=layout))
        with steps.step(f"size {layout}") as step:
            task = Task.of(varied, robot)
            try:
                designed = design_device(task, ranked=False)
            except Infeasible as error:
                answers.append(LayoutAnswer(layout=layout, without=str(error)))
                step.note = "no device"
                continue
            answers.append(layout_answer(layout, task, designed))
            step.note = designed.device.motor.name
    return LayoutsAnswer(robot=robot.name, layouts=tuple(answers))
