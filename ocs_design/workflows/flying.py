"""What flights need besides the device: wheel law, references and plans of the legs."""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from ocs_design.common.errors import OcsError
from ocs_design.common.files import AnyPath
from ocs_design.device.device import Device
from ocs_design.device.records.design import OcsDesign, design_file
from ocs_design.device.records.flights import ControlRecord, SurvivalRecord, ValidationRecord
from ocs_design.device.records.selection import ReserveRecord
from ocs_design.jumping.jump import JumpPlans
from ocs_design.monte_carlo.campaign import Campaign, make_campaign
from ocs_design.monte_carlo.uncertainty import Uncertainty
from ocs_design.report.text.console import Steps
from ocs_design.requirement.froude import standing_height
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.sections import ValidationSection
from ocs_design.requirement.specification import Specification, merge_section
from ocs_design.requirement.uncertainty import UncertaintySection, entries, uncertainty_of_texts
from ocs_design.robot.robot import Robot
from ocs_design.simulation.run import Run
from ocs_design.simulation.scenario import Flights, fly_stopped, refusal, run_scenarios
from ocs_design.simulation.world_builder import Options, control_of, overridden
from ocs_design.sizing.trajectory.motion import Trajectory
from ocs_design.workflows.restoring import (
    RobotLocation,
    read_design_and_device,
    read_recorded_robot,
)

if TYPE_CHECKING:
    from ocs_design.sizing.trajectory.plans import Reference


def planned_turns(
    robot: Robot,
    device: Device,
    maneuvers: Sequence[Maneuver],
    reserve: ReserveRecord | None,
    *,
    one_stops: bool,
) -> Mapping[str, "Reference"]:
    """Planned turns that the flights of a device with a motor track, by name of maneuver.

    `reserve` is the one with which the device was sized; `one_stops`: one drive may fail.
    """
    # CasADi takes a third of a second to import, and wheels without a motor do not need it.
    from ocs_design.sizing.trajectory.plans import plan  # noqa: PLC0415

    demands = None if reserve is None else reserve.demands
    return plan(robot.mass_properties, device, maneuvers, demands, one_stops=one_stops)


def trajectories(plans: Mapping[str, "Reference"]) -> Mapping[str, Trajectory]:
    """Trajectories that flights track; other maneuvers use feedback or a smooth turn."""
    return {
        name: reference.trajectory
        for name, reference in plans.items()
        if reference.trajectory is not None
    }


@dataclass(frozen=True, eq=False, kw_only=True)
class PlannedFlights(Flights):
    """Flights of a design, with progress reports.

    Attributes:
        control: the wheel law, from which the options follow.
        uncertainty: deviations from the design, as far as specified. seed: of all samples.
        detection: time until a failed drive is detected, if one also fails in flights [s].
    """

    control: ControlRecord
    uncertainty: UncertaintySection
    seed: int
    detection: float | None = None

    def fly(self, steps: Steps, *, pose_rate: float | None = None) -> tuple[Run, ...]:
        """Flights of every maneuver as designed, with and without the device (`run_scenarios`)."""
        posed = replace(self, options=replace(self.options, pose_rate=pose_rate))
        with steps.step("fly the maneuvers with and without the device") as step:
            return run_scenarios(posed, step.update)

    def fly_stopped(self, steps: Steps) -> SurvivalRecord | None:
        """Flights of every maneuver with each drive failing in turn; None if none has to."""
        if self.detection is None:
            return None
        with steps.step("fly with each drive failing in turn") as step:
            survival = fly_stopped(self, self.detection, step.update)
            step.note = (
                f"{len(survival.lost)} of {len(survival.flights)} do not land within tolerance"
            )
        return survival

    def campaign(self, runs: Iterable[Run | ValidationRecord]) -> Campaign:
        """Everything that determines the samples; `runs`, as designed, show what the legs can take.

        Raises:
            OcsError: no flight of this robot can be judged.
        """
        if objection := refusal(self.robot):
            hint = "name a link of the trunk whose z axis points up with --trunk"
            raise OcsError(objection, hint=hint)
        uncertainty = Uncertainty.of(self.uncertainty, self.robot, self.device, self.detection)
        can_stand = [run.can_stand for run in runs if run.ocs]
        return make_campaign(self, can_stand=can_stand, uncertainty=uncertainty, seed=self.seed)


@dataclass(frozen=True, eq=False, kw_only=True)
class DesignFlights(PlannedFlights):
    """Flights of a design that was read from its file, of at least one maneuver.

    Attributes:
        path: of the `design.json`. design: its content.
        warnings: about the robot, that did not occur when the device was sized.
    """

    path: Path
    design: OcsDesign
    warnings: tuple[str, ...]

    @property
    def flown_hash(self) -> str:
        """SHA-256 of the device, the maneuvers and the wheel law that are flown."""
        return flown_hash(self.design, self.control, self.detection)


def read_flights(
    path: AnyPath,
    specified: Specification,
    *,
    robot_file: AnyPath | None = None,
    package_paths: Mapping[str, AnyPath] | None = None,
    strict: bool = False,
) -> DesignFlights:
    """Read a design and its robot, and plan its flights as when it was sized.

    Args:
        path: of a `design.json`, or of its folder.
        specified: `[validation]` and `[reality]`, which override those of the design; its other
            sections are not used.
        robot_file: of the robot, in place of the one that the design names.
        package_paths: folders of packages, in addition to those that the design names.
        strict: warnings about the robot are errors.

    Raises:
        OcsError: the design or the robot cannot be read, the robot has changed, or there is
            nothing to fly.
    """
    path = design_file(path)
    design, device = read_design_and_device(path)
    if specified.reality.file is not None:
        # An unreadable file is reported even if nothing is sampled.
        entries(Path(specified.reality.file))
    maneuvers = tuple(record.maneuver() for record in design.requirement.maneuvers)
    if not maneuvers:
        raise OcsError(
            f"{path}: the design was sized without a maneuver, so there is nothing to fly",
            hint="size it with maneuvers: the paper's, or [[maneuver]] tables",
        )
    location = RobotLocation(
        path, robot_file, package_paths or {}, "say where it is with --robot FILE"
    )
    robot, warnings = read_recorded_robot(design.robot, location, strict=strict)
    height = standing_height(robot)
    maneuvers = tuple(replace(maneuver, standing_height=height) for maneuver in maneuvers)
    control = overridden(
        design.control or control_of(ValidationSection(), robot), specified.validation
    )
    references: Mapping[str, Trajectory] = {}
    if design.selection is not None:
        # A plan is a few hundred numbers that follow from the design, so it is computed again.
        one_stops = design.requirement.detection is not None
        reserve = design.selection.kept
        references = trajectories(
            planned_turns(robot, device, maneuvers, reserve, one_stops=one_stops)
        )
    jumps: Mapping[str, JumpPlans] = {}
    if not control.ballistic:
        # It takes a third of a second to import, and flights that start at lift-off do not need it.
        from ocs_design.jumping.planning import plan_jumps  # noqa: PLC0415

        jumps = plan_jumps(robot, device, maneuvers)
    return DesignFlights(
        path=path,
        design=design,
        robot=robot,
        device=device,
        maneuvers=maneuvers,
        control=control,
        options=Options.of_record(control),
        # A file replaces all distributions of the design.
        uncertainty=specified.reality
        if specified.reality.file is not None
        else merge_section(uncertainty_of_texts(design.reality, str(path)), specified.reality),
        references=references,
        jumps=jumps,
        warnings=warnings,
        seed=design.seed if specified.validation.seed is None else specified.validation.seed,
        detection=specified.requirement.notices
        if specified.requirement.survives is not None
        else design.requirement.detection,
    )


def flown_hash(design: OcsDesign, control: ControlRecord, detection: float | None) -> str:
    """SHA-256 of the flown parts of a design: device, maneuvers and wheel law.

    It does not depend on the order in which the fields of a record are declared.

    Args:
        detection: time until a failed drive is detected, if one also fails in flights [s].
    """
    detections = () if detection is None else (detection,)
    flown = (design.ocs, design.requirement.maneuvers, control, *detections)
    return hashlib.sha256(msgspec.json.encode(flown, order="sorted")).hexdigest()
