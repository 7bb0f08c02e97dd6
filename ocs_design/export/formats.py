"""All formats that a device is written in, each by its name."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from ocs_design.design import Device
from ocs_design.exceptions import MissingToolError, UsageError
from ocs_design.export.bill_of_materials import export_bill_of_materials
from ocs_design.export.made_wheel import made_wheel
from ocs_design.export.seat import Seat
from ocs_design.export.urdf import export_robot_urdf, urdf_remarks
from ocs_design.export.workshop import (
    export_pieces_3mf,
    export_pieces_stl,
    export_printed,
    export_step,
)
from ocs_design.robot.robot import Robot

if TYPE_CHECKING:
    from ocs_design.export.robot_model import RobotModel

# MuJoCo takes a third of a second to import, and half of the formats do without.
# ruff: noqa: PLC0415


@dataclass(frozen=True, eq=False)
class Subject:
    """What is written.

    Attributes:
        name: of the robot, fit for the names of files.
        device: on the robot.
        seat: where the device sits.
        robot: that carries it; None where only its parts and its snippets are wanted.
    """

    name: str
    device: Device
    seat: Seat
    robot: Robot | None

    @classmethod
    def of(cls, robot: Robot, device: Device, name: str) -> "Subject":
        """A device on a robot that was read."""
        return cls(name, device, robot, robot)

    @cached_property
    def model(self) -> "RobotModel":
        """Robot and device in MuJoCo, made when the first format asks for it."""
        from ocs_design.export.robot_model import robot_model

        return robot_model(self.carrier, self.device)

    @property
    def carrier(self) -> Robot:
        """The robot, for the formats that need it."""
        assert self.robot is not None, "formats that need a robot are refused without one"
        return self.robot


@dataclass(frozen=True)
class Format:
    """One kind of file.

    Attributes:
        name: as users say it.
        folder: that its files go into.
        needs_robot: whether the robot's own file has to be there.
        on_request: whether it is written only if it is named.
        write: into that folder; gives what is to be told of it, one sentence each.
    """

    name: str
    folder: str
    needs_robot: bool
    write: Callable[[Subject, Path], tuple[str, ...]]
    on_request: bool = False


def _stl(subject: Subject, folder: Path) -> tuple[str, ...]:
    export_pieces_stl(subject.device, folder)
    return ()


def _3mf(subject: Subject, folder: Path) -> tuple[str, ...]:
    export_pieces_3mf(subject.device, folder)
    return ()


def _step(subject: Subject, folder: Path) -> tuple[str, ...]:
    export_step(subject.device, folder)
    return ()


def _printed(subject: Subject, folder: Path) -> tuple[str, ...]:
    return (export_printed(subject.device, folder),)


def _drawing(subject: Subject, folder: Path) -> tuple[str, ...]:
    from ocs_design.export.wheel_drawing import export_wheel_drawing, wheel_drawing

    wheel = made_wheel(subject.device.flywheel)
    export_wheel_drawing(wheel_drawing(subject.device, wheel, subject.name), folder)
    return ()


def _pictures(subject: Subject, folder: Path) -> tuple[str, ...]:
    """Where OpenGL does not work, what is in the way: never a reason to fail."""
    from ocs_design.export.pictures import draw_pictures

    wheel = made_wheel(subject.device.flywheel)
    try:
        pictures = draw_pictures(subject.device, wheel, subject.carrier, subject.model)
    except MissingToolError as error:
        return (f"{error}; {error.hint}" if error.hint else str(error),)
    for name, content in pictures.items():
        (folder / f"{name}.png").write_bytes(content)
    return ()


def _bill(subject: Subject, folder: Path) -> tuple[str, ...]:
    export_bill_of_materials(subject.device, folder / "bill_of_materials.csv")
    return ()


def _urdf(subject: Subject, folder: Path) -> tuple[str, ...]:
    export_robot_urdf(subject.carrier, subject.device, folder / f"{subject.name}_ocs.urdf")
    return urdf_remarks(subject.carrier)


def _mjcf(subject: Subject, folder: Path) -> tuple[str, ...]:
    from ocs_design.export.mjcf import export_robot_mjcf

    export_robot_mjcf(subject.model, folder / f"{subject.name}_ocs.xml")
    return subject.model.warnings


def _glb(subject: Subject, folder: Path) -> tuple[str, ...]:
    from ocs_design.export.glb import export_robot_glb

    posture = subject.carrier.posture
    export_robot_glb(subject.model.compiled, posture, folder / f"{subject.name}_ocs.glb")
    return subject.model.warnings


def _snippets(subject: Subject, folder: Path) -> tuple[str, ...]:
    from ocs_design.export.snippets import export_snippets

    export_snippets(subject.device, subject.seat, folder)
    return ()


FORMATS = (
    Format("stl", "cad", needs_robot=False, write=_stl),
    Format("bom", "cad", needs_robot=False, write=_bill),
    Format("drawing", "cad", needs_robot=False, write=_drawing),
    Format("3mf", "cad", needs_robot=False, write=_3mf, on_request=True),
    Format("step", "cad", needs_robot=False, write=_step, on_request=True),
    Format("printed", "cad", needs_robot=False, write=_printed, on_request=True),
    Format("urdf", "robot", needs_robot=True, write=_urdf),
    Format("mjcf", "robot", needs_robot=True, write=_mjcf),
    Format("glb", "robot", needs_robot=True, write=_glb),
    Format("snippets", "snippets", needs_robot=False, write=_snippets),
    Format("pictures", "pictures", needs_robot=True, write=_pictures, on_request=True),
)
"""In the order that they are written in."""

USUAL_FORMATS = tuple(each for each in FORMATS if not each.on_request)
"""That are written if nothing is said."""

ALL = "all"
"""Stands for every format."""


def formats_named(names: Collection[str], others: Collection[str] = ()) -> tuple[Format, ...]:
    """The formats of these names; the usual ones if there are none.

    Args:
        names: as users say them.
        others: names of what is written too, but is no format of a device; they are passed over.

    Raises:
        UsageError: a name is none of a format.
    """
    if not names:
        return USUAL_FORMATS
    known = (*(each.name for each in FORMATS), *others, ALL)
    for name in names:
        if name not in known:
            available = ", ".join(known)
            raise UsageError(f"there is no format '{name}'", hint=f"available: {available}")
    return tuple(each for each in FORMATS if ALL in names or each.name in names)


def export_formats(subject: Subject, formats: Collection[Format], folder: Path) -> tuple[str, ...]:
    """Write a device in these formats into their folders below `folder`.

    Returns:
        What is to be told of the files, one sentence each.
    """
    told: list[str] = []
    for each in formats:
        target = folder / each.folder
        target.mkdir(exist_ok=True)
        told += each.write(subject, target)
    return tuple(dict.fromkeys(told))
