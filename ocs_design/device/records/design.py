"""The file `design.json`, the one artefact that other commands and programs read.

Field names and units are the contract of `docs/output.md`: SI, radians, the base frame B, full
double precision. The dataclasses are the schema; a change of meaning needs a new `SCHEMA_VERSION`,
and a step in `read_design` that converts older versions.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from pathlib import Path
from typing import Annotated, Any

import msgspec

from ocs_design.actuation.supply import Supply
from ocs_design.common.errors import OcsError
from ocs_design.common.files import AnyPath, read_plain_file
from ocs_design.common.ranges import Range
from ocs_design.common.units import format_quantity
from ocs_design.device.records.device import OcsRecord
from ocs_design.device.records.flights import (
    Buildable,
    ControlRecord,
    Margin,
    ReliabilityRecord,
    SurvivalRecord,
    ValidationRecord,
)
from ocs_design.device.records.requirement import RequirementRecord, RobotRecord
from ocs_design.device.records.selection import (
    Alternative,
    DrivingManeuver,
    SelectionRecord,
    SizingRecord,
    TradeOffs,
)

DESIGN_FILE = "design.json"


SCHEMA_VERSION = 2


OLDEST_VERSION = 1
"""Oldest version of documents that is still read."""


LARGEST = 16 << 20
"""Largest `design.json` [bytes]; a humanoid's takes a fiftieth of it."""


@dataclass(frozen=True, kw_only=True)
class Tool:
    """Program that wrote the file.

    Attributes:
        name: `ocs-design`. version: of the program.
    """

    name: str
    version: str


@dataclass(frozen=True, kw_only=True)
class OcsDesign:
    """A designed, exported and simulated orientation control system."""

    schema_version: int
    tool: Tool
    seed: Annotated[int, Range(0, inf)]
    robot: RobotRecord
    requirement: RequirementRecord
    ocs: OcsRecord
    sizing: SizingRecord
    selection: SelectionRecord | None = None
    margins: tuple[Margin, ...]
    supply: Supply | None = None
    alternatives: tuple[Alternative, ...] = ()
    owed: DrivingManeuver | None = None
    lighter: TradeOffs | None = None
    buildable: Buildable = field(default_factory=lambda: Buildable(yes=None))
    validation: tuple[ValidationRecord, ...]
    survival: SurvivalRecord | None = None
    reliability: ReliabilityRecord | None = None
    control: ControlRecord | None = None
    reality: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, str]

    def __repr__(self) -> str:
        ocs, flown = self.ocs, [run for run in self.validation if run.ocs]
        motor = "no motor" if self.selection is None else ocs.motor.name
        passed = [run.passed for run in flown].count(True)
        return (
            f"<OcsDesign for {self.robot.name}: {len(ocs.modules)} wheels, "
            f"{format_quantity(ocs.mass_total, 'g')}, {motor}, "
            f"{passed} of {len(flown)} flights pass>"
        )

    def _repr_html_(self) -> str:
        from ocs_design import as_html  # noqa: PLC0415 - the report stands above

        return as_html(self)


def design_file(path: AnyPath) -> Path:
    """The `design.json` at a path, or in the folder there."""
    path = Path(path)
    return path / DESIGN_FILE if path.is_dir() else path


def read_design(path: AnyPath) -> OcsDesign:
    """Read a `design.json`.

    Args:
        path: of the file, or of its folder.

    Raises:
        OcsError: the file cannot be read, or is not a design of this schema version.
    """
    path = design_file(path)
    try:
        content = read_plain_file(path, LARGEST)
        version = msgspec.json.decode(content, type=_Version).schema_version
    except OSError as error:
        raise OcsError(
            f"{path}: {error.strerror}", hint="give the path of a design.json"
        ) from error
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        hint = "give a design.json, which `ocs-design size` writes"
        if content.lstrip().startswith(b"<"):
            raise OcsError(f"{path}: is a robot or other XML, not a design", hint=hint) from error
        if path.suffix == ".toml":
            raise OcsError(f"{path}: is a specification, not a design", hint=hint) from error
        raise OcsError(f"{path}: not a design.json: {error}", hint=hint) from error
    if not OLDEST_VERSION <= version <= SCHEMA_VERSION:
        raise OcsError(
            f"{path}: schema_version {version}, but this version reads {OLDEST_VERSION} to "
            f"{SCHEMA_VERSION}",
            hint="run `ocs-design size` again to write a new one",
        )
    try:
        if version == SCHEMA_VERSION:
            return msgspec.json.decode(content, type=OcsDesign)
        # Version 1 stored only whether a run passed, which requires a level touchdown, and an
        # upright end where the legs can take it. Other missing fields take their defaults.
        document = msgspec.json.decode(content)
        for margin in _objects(document.get("margins")):
            margin["scenario"] = margin.pop("maneuver", "")
        for run in _objects(document.get("validation")):
            if run.get("passed") is True:
                run["level"] = True
                run["stands"] = True if run.get("can_stand") is True else None
        return msgspec.convert({**document, "schema_version": SCHEMA_VERSION}, OcsDesign)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OcsError(f"{path}: {error}", hint="run `ocs-design size` again") from error


def _objects(entries: object) -> list[dict[str, Any]]:
    """Objects in a list of any document; other entries are refused on conversion."""
    listed = entries if isinstance(entries, list) else []
    return [entry for entry in listed if isinstance(entry, dict)]


class _Version(msgspec.Struct):
    schema_version: int
