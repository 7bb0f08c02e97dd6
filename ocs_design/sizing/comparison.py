"""Comparison of lightest devices: at each value of one figure, and for each layout."""

from collections.abc import Callable, Sequence

from ocs_design.actuation.wheel_load import reach, reach_without_one
from ocs_design.common.arrays import vector
from ocs_design.common.errors import Infeasible, SpecificationError
from ocs_design.common.units import format_quantity, si_unit
from ocs_design.device.answers import Front, FrontDevice, FrontPoint, LayoutAnswer
from ocs_design.requirement.sweep import Sweep, Task
from ocs_design.requirement.vocabulary import DETECTION
from ocs_design.requirement.writing import specification_to_toml, with_absolute_files
from ocs_design.sizing.limits import Progress, ignore_progress
from ocs_design.sizing.mounting import mounting_of, mounting_open_points
from ocs_design.sizing.selection.select import maneuvers_survived
from ocs_design.sizing.sized import Designed

Choose = Callable[[Task], FrontDevice]
"""The lightest device for a task; raises `Infeasible` where there is none."""


def draw_front(
    task: Task,
    sweep: Sweep,
    values: Sequence[float],
    choose: Choose,
    progress: Progress = ignore_progress,
) -> Front:
    """Front of the lightest device at each value [SI], or the reason why there is none."""
    points = []
    for index, value in enumerate(values):
        specification = with_absolute_files(sweep.at(value, task))
        file = f"points/{index + 1:02d}.toml"
        # A value without a feasible device is a result too.
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
        progress((index + 1) / len(values))
    overfed = [point.device.overvoltage for point in points if point.device is not None]
    return Front(
        robot=task.robot.name,
        against=sweep.name,
        label=sweep.label,
        unit=sweep.unit,
        si_unit=si_unit(sweep.dimension),
        own_value=sweep.present_value(task),
        remarks=(*sweep.remarks(task), *filter(None, dict.fromkeys(overfed))),
        assumptions=task.resolved.assumptions,
        points=tuple(points),
    )


def layout_answer(layout: str, task: Task, designed: Designed) -> LayoutAnswer:
    """Mass of a layout's device, and its momentum capacity with all wheels and with one less."""
    device, sized, choice = designed.device, designed.sized, designed.choice
    mounting = mounting_of(task.robot, device, task.maneuvers, sized.total)
    momentum = device.flywheel.spin_inertia * sized.wheel_speed_max
    return LayoutAnswer(
        layout=layout,
        wheels=len(device.modules),
        mass=device.mass,
        motor=device.motor.name,
        momentum=vector(momentum * reach(device.axes)),
        momentum_without_one=vector(momentum * reach_without_one(device.axes)),
        open=tuple(point.what for point in mounting_open_points(mounting)),
        survives=()
        if choice is None
        else maneuvers_survived(choice.problem, choice.chosen, DETECTION),
    )
