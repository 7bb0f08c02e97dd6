"""`ocs-design validate`: the flights of a `design.json` once more."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path

from ocs_design.design import Device
from ocs_design.design_file import (
    ControlRecord,
    OcsDesign,
    design_to_json,
    read_design,
)
from ocs_design.exceptions import OcsError
from ocs_design.export.folder import DESIGN_FILE, file_hashes, staged_folder
from ocs_design.jumping.jump import JumpPlans
from ocs_design.monte_carlo.summary import Validated
from ocs_design.recording.control import (
    control_of,
    flight_options,
    jump_plans,
    overridden,
    trajectories,
)
from ocs_design.recording.restored import device_of, maneuver_of
from ocs_design.recording.robot import Whereabouts, read_recorded_robot
from ocs_design.recording.runs import record_run, write_runs
from ocs_design.requirement.froude import standing_height
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.reality import RealitySection, reality_of_texts
from ocs_design.requirement.specification import (
    Specification,
    ValidationSection,
    merge_section,
)
from ocs_design.robot.robot import Robot
from ocs_design.simulation.engine import Progress
from ocs_design.simulation.scenario import Run, run_scenarios
from ocs_design.sizing.trajectory import Trajectory

SCHEMA_VERSION = 1


@dataclass(frozen=True, eq=False)
class Task:
    """What is flown.

    Attributes:
        path: of the `design.json`. design: what is in it.
        robot: as it was sized for, or another in its place. device: on it.
        maneuvers: see `Maneuver`; at least one.
        control: the wheel law.
        reality: how what is built and met differs from the design, as far as that is stated.
        references: what the device tracks, by the maneuver's name.
        jumps: how the legs make a maneuver, by its name.
        warnings: about the robot, which were not there when the device was sized.
    """

    path: Path
    design: OcsDesign
    robot: Robot
    device: Device
    maneuvers: tuple[Maneuver, ...]
    control: ControlRecord
    reality: RealitySection
    references: Mapping[str, Trajectory]
    jumps: Mapping[str, JumpPlans]
    warnings: tuple[str, ...]


def read_task(
    path: Path,
    stated: Specification,
    *,
    robot_file: Path | None = None,
    package_paths: Mapping[str, Path] | None = None,
    strict: bool = False,
) -> Task:
    """Read a design and its robot, and plan what device and legs track, as when it was sized.

    Args:
        path: of a `design.json`, or of the folder that it lies in.
        stated: `[validation]` and `[reality]` over those that the design was sized with; what else
            it states is the design's by now.
        robot_file: of the robot, in place of the one that the design names.
        package_paths: folders of packages, over those that the design names.
        strict: warnings about the robot are errors.

    Raises:
        OcsError: the design or the robot cannot be read, the robot has changed, or nothing is to
            be flown.
    """
    path = path / DESIGN_FILE if path.is_dir() else path
    design = read_design(path)
    maneuvers = tuple(map(maneuver_of, design.requirement.maneuvers))
    if not maneuvers:
        raise OcsError(
            f"{path}: the design was sized for no maneuver, so there is nothing to fly",
            hint="size it with maneuvers: the paper's, or [[maneuver]] tables",
        )
    where = Whereabouts(path, robot_file, package_paths or {}, "say where it is with --robot FILE")
    robot, warnings = read_recorded_robot(design.robot, where, strict=strict)
    device = device_of(design.ocs)
    control = overridden(
        design.control or control_of(ValidationSection(), robot), stated.validation
    )
    return Task(
        path=path,
        design=design,
        robot=robot,
        device=device,
        maneuvers=maneuvers,
        control=control,
        reality=merge_section(reality_of_texts(design.reality, str(path)), stated.reality),
        references=_references(design, robot, device, maneuvers),
        jumps=jump_plans(control, robot, device, maneuvers),
        warnings=warnings,
    )


def fly_again(
    task: Task, progress: Progress | None = None, *, pose_rate: float | None = None
) -> tuple[Run, ...]:
    """Every maneuver with the device and then without; see `run_scenarios` and its `Options`."""
    return run_scenarios(
        task.robot,
        task.device,
        task.maneuvers,
        options=replace(flight_options(task.control), pose_rate=pose_rate),
        references=task.references,
        jumps=task.jumps,
        progress=progress,
    )


def validated(task: Task, runs: tuple[Run, ...]) -> Validated:
    """The record of these runs."""
    return Validated(
        schema_version=SCHEMA_VERSION,
        design=str(task.path),
        robot=task.robot.name,
        warnings=task.warnings,
        validation=tuple(map(record_run, runs)),
    )


def write_flights(
    task: Task, runs: tuple[Run, ...], found: Validated, folder: Path, *, force: bool
) -> OcsDesign:
    """Write the time series, and the design with these flights in place of its own.

    Raises:
        OutputError: the folder cannot be written, or exists already.
    """
    with staged_folder(folder, force=force) as staging:
        write_runs(runs, staging)
        design = replace(task.design, validation=found.validation, files=file_hashes(staging))
        (staging / DESIGN_FILE).write_bytes(design_to_json(design))
    return design


def _references(
    design: OcsDesign, robot: Robot, device: Device, maneuvers: tuple[Maneuver, ...]
) -> Mapping[str, Trajectory]:
    """Planned once more: a plan is a few hundred numbers that follow from the design."""
    if design.selection is None:
        return {}
    # CasADi takes a third of a second to import, and wheels without a motor do without.
    planning = import_module("ocs_design.planning")
    return trajectories(
        planning.plan(robot.mass_properties, device, maneuvers, standing_height(robot))
    )
