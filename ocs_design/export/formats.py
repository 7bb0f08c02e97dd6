"""Registry of the export formats of a device.

A new format is a module here with a function `write(subject, folder)` and a row in `FORMATS`; the
command line, its help and `--formats all` follow. Importing this module loads no writer.
"""

from collections.abc import Collection
from dataclasses import dataclass, field, replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Self, TypeAlias

from ocs_design.common.errors import MissingToolError, UsageError, extra_command

if TYPE_CHECKING:
    from ocs_design.common.arrays import Vector
    from ocs_design.device.device import Device
    from ocs_design.device.records.design import OcsDesign
    from ocs_design.device.records.flights import Buildable, Margin
    from ocs_design.robot.robot import Mount, Robot

Notes: TypeAlias = tuple[str, ...]
"""Remarks on the files for the user, one sentence each."""


@dataclass(frozen=True, eq=False)
class Base:
    """Place of the device on a robot.

    Attributes:
        trunk: link that carries the device; its frame is the base frame B.
        mount: how B is fixed to the robot's own link; None if `trunk` is such a link.
        com: centre of mass in B of a robot given by hand [m]; None: a file defines B.
    """

    trunk: str
    mount: "Mount | None"
    com: "Vector | None" = None


@dataclass(frozen=True, eq=False)
class Documented:
    """A device with the records for its documents.

    Attributes:
        name: name of the robot.
        device: device on the robot.
        margins: margins of its recorded flights; empty if none are known.
        fitting: manual work that the design leaves, one sentence each.
        refused: that the device cannot be built as it stands, why, and the cure; empty if nothing
            known prevents it.
    """

    name: str
    device: "Device"
    margins: "tuple[Margin, ...]" = ()
    fitting: tuple[str, ...] = ()
    refused: str = ""

    def recorded(self, design: "OcsDesign") -> Self:
        """The device with the margins, notes and open points that its design records."""
        # With a robot of unknown geometry, open points do not refuse the device, but must be shown.
        known = design.buildable.yes is not None
        points = () if known else (f"{point.what}; {point.cure}" for point in design.buildable.open)
        device, fitting = replace(self.device, supply=design.supply), (*points, *design.ocs.fitting)
        documents = replace(self, device=device, margins=design.margins, fitting=fitting)
        return replace(documents, refused=refusal(design.buildable))


@dataclass(frozen=True, eq=False)
class Subject(Documented):
    """The device to export, and the robot that carries it; `name` is safe in file names.

    Attributes:
        base: frame of the device.
        robot: robot that carries it; None if only its parts and snippets are wanted.
    """

    base: Base = field(kw_only=True)
    robot: "Robot | None" = field(default=None, kw_only=True)

    @classmethod
    def of(cls, robot: "Robot", device: "Device", name: str) -> "Subject":
        """Subject of a device on a robot that was read."""
        x, y, z = robot.com.tolist()
        com = None if robot.sha256 else (x, y, z)
        return cls(name, device, base=Base(robot.trunk, robot.mount, com), robot=robot)

    @property
    def carrier(self) -> "Robot":
        """Robot, for the formats that need one."""
        assert self.robot is not None, "formats that need a robot are refused without one"
        return self.robot


def refusal(buildable: "Buildable") -> str:
    """Sentences on why a device cannot be built, and the cure; empty if it can."""
    if buildable.yes is not False:
        return ""
    points = (
        f"{point.what[:1].upper()}{point.what[1:]}; {point.cure}." for point in buildable.open
    )
    return " ".join(("NOT buildable as it stands.", *points))


@dataclass(frozen=True)
class Format:
    """One export format.

    Attributes:
        name: name that users type.
        content: description of its files for users.
        module: module that writes it, below `ocs_design.export`.
        folder: subfolder of the output folder.
        needs_robot: whether it needs the robot's own file.
        on_request: whether it is written only if it is named.
        needs_margins: whether it reports margins of the flights, and so is written after them.
        library: module of an optional dependency, installed by the extra with the format's name;
            empty: none.
    """

    name: str
    content: str
    module: str
    folder: str = "cad"
    needs_robot: bool = False
    on_request: bool = False
    needs_margins: bool = False
    library: str = ""

    def write(self, subject: Subject, folder: Path) -> Notes:
        """Write the subject's files into `folder`.

        Raises:
            MissingToolError: the library is not installed, or cannot be loaded.
        """
        if self.library and find_spec(self.library) is None:
            raise self._missing("is not installed")
        try:
            writer = import_module(f"ocs_design.export.{self.module}")
        except ImportError as error:
            if not self.library:
                raise
            raise self._missing(f"cannot be loaded: {error}") from error
        notes: Notes = writer.write(subject, folder)
        return notes

    def _missing(self, why: str) -> MissingToolError:
        return MissingToolError(
            f"no {self.name.upper()} file can be written: {self.library} {why}",
            hint=extra_command(self.name),
        )


_DRAWN = "wheel, plate and guard ring, drilling template"
_OUTLINED = "wheel and plate, drilling template"

FORMATS = (
    Format("stl", "wheel and other metal parts, as meshes", "stl"),
    Format("bom", "parts list with stock and masses", "bill_of_materials", needs_margins=True),
    Format("drawing", f"technical drawings of {_DRAWN}", "drawing.wheel_sheet"),
    Format("3mf", "wheel for slicers", "threemf", on_request=True),
    Format("step", "exact parts", "step", on_request=True, library="OCP"),
    Format("dxf", f"outlines of {_OUTLINED}", "dxf", on_request=True, library="ezdxf"),
    Format("printed", "housing, foot and cage for printing", "printed"),
    Format("assembly", "how to build it, step by step", "assembly.booklet", needs_margins=True),
    Format("urdf", "whole robot", "urdf", "robot", needs_robot=True),
    Format("mjcf", "whole robot", "mjcf", "robot", needs_robot=True),
    Format("glb", "whole robot, for viewing", "glb", "robot", needs_robot=True),
    Format("snippets", "device alone as URDF, xacro, MJCF and SDF", "snippets", "snippets"),
    Format("ros2", "ROS 2 description package", "ros2", "ros2", needs_robot=True, on_request=True),
    Format("pictures", "views as PNG", "pictures", "pictures", needs_robot=True, on_request=True),
)
"""All formats, in writing order."""

USUAL_FORMATS = tuple(entry for entry in FORMATS if not entry.on_request)
"""Formats that are written by default."""

ALL = "all"
"""Name for all formats."""


def formats_named(names: Collection[str], others: Collection[str] = ()) -> tuple[Format, ...]:
    """Formats with these lower-case names; the usual ones if there are none.

    Names in `others`, which are written too but are not formats of a device, are skipped.

    Raises:
        UsageError: there is no format of that name.
    """
    if not names:
        return USUAL_FORMATS
    known = (*(file_format.name for file_format in FORMATS), *others, ALL)
    for name in names:
        if name not in known:
            available = ", ".join(known)
            raise UsageError(f"there is no format '{name}'", hint=f"available: {available}")
    return tuple(
        file_format for file_format in FORMATS if ALL in names or file_format.name in names
    )


def export_formats(subject: Subject, formats: Collection[Format], folder: Path) -> Notes:
    """Write a device in these formats into their folders below `folder`."""
    notes: list[str] = []
    for file_format in formats:
        target = folder / file_format.folder
        target.mkdir(exist_ok=True)
        notes += file_format.write(subject, target)
    return tuple(dict.fromkeys(notes))
