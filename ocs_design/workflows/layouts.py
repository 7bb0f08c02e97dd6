"""What `size --layout all` answers: a device of each layout, for the same requirement."""

from collections.abc import Mapping
from dataclasses import replace

from ocs_design.actuation.wheel_load import reach, reach_without_one
from ocs_design.common.arrays import vector
from ocs_design.common.errors import Infeasible
from ocs_design.common.files import AnyPath
from ocs_design.device.answers import LayoutAnswer, LayoutsAnswer
from ocs_design.device.records.design import SCHEMA_VERSION
from ocs_design.report.text.console import Steps, Tell
from ocs_design.requirement.reading import specification_of
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.vocabulary import DETECTION, LAYOUTS
from ocs_design.sizing.design import design_device
from ocs_design.sizing.mounting import mounting_of, mounting_open_points
from ocs_design.sizing.selection.device import survived
from ocs_design.workflows.pareto import read_task


def compare_layouts(
    design_for: Specification | AnyPath,
    *,
    package_paths: Mapping[str, AnyPath] | None = None,
    strict: bool = False,
    progress: Steps | Tell | None = None,
) -> LayoutsAnswer:
    """The lightest device of each layout, what momentum it takes, and what one lost wheel leaves.

    Nothing is flown or exported.

    Args:
        design_for: a specification, the path of its file, or that of a robot; its own layout is
            not looked at.
        package_paths: folder of each package that `package://` addresses name.
        strict: warnings about the robot are errors.
        progress: see `design_ocs`.

    Raises:
        OcsError: the robot cannot be read, or the specification does not fit it.
    """
    steps, stated = Steps.of(progress), specification_of(design_for)
    answers = []
    for layout in LAYOUTS:
        asked = replace(stated, ocs=replace(stated.ocs, layout=layout))
        with steps.step(f"size {layout}") as step:
            task = read_task(asked, package_paths=package_paths, strict=strict)
            try:
                designed = design_device(asked, task.robot, task.resolved, ranked=False)
            except Infeasible as error:
                answers.append(LayoutAnswer(layout=layout, without=str(error)))
                step.note = "no device"
                continue
            device, sized, choice = designed.device, designed.sized, designed.choice
            maneuvers = task.resolved.requirement.maneuvers
            mounting = mounting_of(task.robot, device, maneuvers, sized.total)
            each = device.flywheel.spin_inertia * sized.wheel_speed_max
            answer = LayoutAnswer(
                layout=layout,
                wheels=len(device.modules),
                mass=device.mass,
                motor=device.motor.name,
                momentum=vector(each * reach(device.axes)),
                momentum_without_one=vector(each * reach_without_one(device.axes)),
                open=tuple(point.what for point in mounting_open_points(mounting)),
                survives=()
                if choice is None
                else survived(choice.problem, choice.chosen, DETECTION),
            )
            answers.append(answer)
            step.note = device.motor.name
    return LayoutsAnswer(
        schema_version=SCHEMA_VERSION, robot=task.robot.name, layouts=tuple(answers)
    )
