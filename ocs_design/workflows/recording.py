"""Makes the records of `design.json` from live values."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from ocs_design import __version__
from ocs_design.actuation.drive import RESERVE
from ocs_design.common.arrays import matrix, vector
from ocs_design.common.files import AnyPath
from ocs_design.common.records import recorded
from ocs_design.common.units import format_quantity
from ocs_design.device.checks import device_warnings
from ocs_design.device.layout import heading_drift
from ocs_design.device.records.design import SCHEMA_VERSION, OcsDesign, Tool
from ocs_design.device.records.device import ModuleRecord, MountingRecord, OcsRecord
from ocs_design.device.records.flights import Buildable, Margin, SurvivalRecord, ValidationRecord
from ocs_design.device.records.requirement import (
    AxisInertia,
    ManeuverRecord,
    RequirementRecord,
    RobotRecord,
)
from ocs_design.device.records.selection import (
    RankedRecord,
    RejectionRecord,
    ReserveRecord,
    SelectionRecord,
)
from ocs_design.export.assembly_notes import device_notes, trunk_notes
from ocs_design.parts.printed import CLEARANCE, PANEL, WALL
from ocs_design.report.story import series_file
from ocs_design.requirement.resolving import Resolved
from ocs_design.robot.robot import Robot
from ocs_design.simulation.run import Run
from ocs_design.sizing.mounting import DeviceMounting
from ocs_design.sizing.selection.refinement import mass_prices
from ocs_design.sizing.sized import Designed, DriveChoice


def record_selection(choice: DriveChoice, reserve: ReserveRecord | None = None) -> SelectionRecord:
    """Record of how motor, gear, material and incidence were chosen."""
    problem, chosen, selection = choice.problem, choice.chosen, choice.selection
    return SelectionRecord(
        bus_voltage=problem.supply.voltage,
        reserve=RESERVE,
        candidates=selection.candidates,
        binding_maneuver=chosen.binding_maneuver,
        binding=chosen.binding,
        tasks=chosen.demands,
        ranking=tuple(
            recorded(
                RankedRecord,
                entry,
                motor=entry.motor.name,
                gear=entry.gear.name,
                gear_ratio=entry.gear.ratio,
                material=entry.material.name,
                wheels_mass=len(entry.layout) * entry.wheel_mass,
                motors_mass=len(entry.layout)
                * ((entry.motor.mass or 0.0) + entry.motor.controller_mass),
                gears_mass=len(entry.layout) * entry.gear.mass,
                housings_mass=len(entry.layout) * entry.printed_mass,
            )
            for entry in selection.ranking
        ),
        rejections=tuple(recorded(RejectionRecord, other) for other in selection.rejections),
        co_design=choice.co_design,
        prices=tuple(mass_prices(problem, selection.best)),
        kept=reserve,
    )


FOLDER = "validation"


def record_run(run: Run) -> ValidationRecord:
    """Record of one flight, without its time series."""
    metrics = {} if run.metrics is None else asdict(run.metrics)
    return recorded(ValidationRecord, run, metrics=metrics)


STOPPED_FILE = "stopped.csv"
"""File with one row per flight with a failure: which drive, when, and how the flight ended."""


def write_runs(runs: Sequence[Run], folder: Path, survival: SurvivalRecord | None = None) -> None:
    """Write one CSV per flight, six significant digits, and one for all in which a drive fails."""
    if runs:
        (folder / FOLDER).mkdir()
    for run in runs:
        path = folder / FOLDER / series_file(run.scenario, ocs=run.ocs)
        columns = run.series.columns()
        table, heads = np.column_stack(list(columns.values())), ",".join(columns)
        np.savetxt(path, table, "%.6g", ",", header=heads, comments="", encoding="utf-8")
    if survival is not None:
        with (folder / FOLDER / STOPPED_FILE).open("w", encoding="utf-8", newline="") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(
                ("scenario", "drive", "stopped_s", "known_s", "lands", "off_rad", "reason")
            )
            for flight in survival.flights:
                detected = flight.instant + survival.detection
                times = f"{flight.instant:.6g}", f"{detected:.6g}"
                lands = "" if flight.lands is None else str(flight.lands).lower()
                tilt = "" if flight.tilt is None else f"{flight.tilt:.6g}"
                row = flight.scenario, flight.module, *times, lands, tilt, flight.reason
                writer.writerow(row)


HOUSING_ASSUMPTION = (
    f"Housing: PETG, wall {format_quantity(WALL, 'mm')}, floor and lid "
    f"{format_quantity(PANEL, 'mm')}, {format_quantity(CLEARANCE, 'mm')} clear: "
    f"r_max + {format_quantity(WALL + CLEARANCE, 'mm')}."
)


def record_design(
    robot: Robot,
    resolved: Resolved,
    designed: Designed,
    *,
    margins: tuple[Margin, ...],
    buildable: Buildable,
    mounting: DeviceMounting | None,
    warnings: tuple[str, ...] = (),
    seed: int,
    package_paths: Mapping[str, AnyPath] | None = None,
) -> OcsDesign:
    """Record of a design that is not flown, without alternatives and files."""
    requirement, device, sized = resolved.requirement, designed.device, designed.sized
    speed, total = sized.wheel_speed_max, sized.total
    housing = () if resolved.choice is None else (HOUSING_ASSUMPTION,)
    return OcsDesign(
        schema_version=SCHEMA_VERSION,
        tool=Tool(name="ocs-design", version=__version__),
        seed=seed,
        robot=RobotRecord.of(robot, package_paths),
        requirement=RequirementRecord(
            maneuvers=tuple(map(ManeuverRecord.of, requirement.maneuvers)),
            rate_change=requirement.rate_change,
            wheel_speed_max=speed,
            required_inertia=AxisInertia.of([demand.momentum for demand in sized.demands], speed),
            spin_inertia_by_hand=requirement.spin_inertia,
            demands=sized.demands,
            assumptions=(*resolved.assumptions, *housing),
            reliability=resolved.reliability,
            detection=requirement.detection,
        ),
        ocs=recorded(
            OcsRecord,
            device,
            incidence_criterion=designed.criterion,
            incidence_by_criterion=dict(sized.incidence_by_criterion),
            incidence_by_criterion_robot_alone=dict(sized.incidence_by_criterion_robot),
            heading_drift=heading_drift(total.inertia),
            spin_inertia=device.flywheel.spin_inertia,
            mass_total=device.mass,
            total_mass=total.mass,
            total_inertia=matrix(total.inertia),
            total_com=vector(total.com),
            modules=tuple(
                ModuleRecord(
                    name=module.name, axis=vector(module.axis), position=vector(module.position)
                )
                for module in device.modules
            ),
            layout=device.layout.name,
            clearance=None if mounting is None else mounting.nearest,
            center_of_mass=vector(
                (total.mass * total.com - robot.mass_properties.mass * robot.com) / device.mass
            ),
            warnings=(*device_warnings(device, robot.mass_properties), *warnings),
            fitting=(*device_notes(device), *trunk_notes(device, robot)),
            mounting=None
            if mounting is None
            else recorded(
                MountingRecord,
                mounting,
                com_shift=vector(mounting.com_shift),
                inertia_change=vector(mounting.inertia_change),
            ),
        ),
        sizing=sized.optimum,
        selection=None
        if designed.choice is None
        else record_selection(designed.choice, designed.kept),
        margins=margins,
        supply=device.supply,
        buildable=buildable,
        validation=(),
        files={},
    )
