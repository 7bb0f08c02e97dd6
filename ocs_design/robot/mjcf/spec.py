"""A user's MJCF model as an MjSpec that needs no other file: includes expanded, assets inside."""

import re
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

import mujoco

from ocs_design.bounded_files import read_plain_file
from ocs_design.exceptions import RobotError
from ocs_design.robot.files.roots import is_below, roots_of
from ocs_design.robot.files.source import MAX_BYTES
from ocs_design.robot.mjcf.assets import embed_assets
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.spec.unused_name import unused_name
from ocs_design.robot.spec.warnings import mujoco_warnings_to
from ocs_design.robot.urdf.xml import parse_xml


def parse_mjcf(content: bytes, folder: Path, remarks: Remarks) -> mujoco.MjSpec:
    """The model of an MJCF file; its bodies, joints and actuators all have names.

    Args:
        content: the file, unzipped, in any encoding that XML knows.
        folder: that its includes and assets are relative to.
        remarks: takes the names of files that are not there; what needs them is left out.
    """
    root = parse_xml(content, remarks)
    _expand_includes(root, folder, seen=set())
    spec = _parse(ET.tostring(root, encoding="unicode"), remarks)
    # Bodies that are fused lose their names, and the trunk may be one of them.
    spec.compiler.fusestatic = False
    embed_assets(spec, folder, remarks)
    _name(spec.bodies, "body")
    _name(spec.joints, "joint")
    _name(spec.actuators, "actuator")
    return spec


def _name(elements: Sequence["mujoco.MjsBody | mujoco.MjsJoint"], kind: str) -> None:
    """Name what has no name, so that a tree and a model made from the same file agree."""
    taken = {element.name for element in elements}
    for number, element in enumerate(elements):
        if not element.name:
            element.name = unused_name(f"{kind}{number}", "", taken)


def _parse(text: str, remarks: Remarks) -> mujoco.MjSpec:
    try:
        with mujoco_warnings_to(remarks):
            return mujoco.MjSpec.from_string(text)
    except ValueError as error:
        raise mujoco_refusal(error) from error


def compiled(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """The compiled model; what MuJoCo will not compile is an error of the robot's file."""
    try:
        # The reader compiles the user's model first, and has told what there is to tell.
        with mujoco_warnings_to(Remarks()):
            return spec.compile()
    except ValueError as error:
        raise mujoco_refusal(error) from error


def mujoco_refusal(error: ValueError) -> RobotError:
    """MuJoCo's own words as an error of ours."""
    # Its line numbers are those of the model with its includes expanded, not the user's.
    reason = re.sub(r",? line \d+", "", " ".join(str(error).split()))
    return RobotError(
        f"MuJoCo refuses the model: {reason}",
        hint="open it in MuJoCo's viewer (python -m mujoco.viewer --mjcf FILE) and mend it there",
    )


def _expand_includes(parent: ET.Element, folder: Path, seen: set[Path]) -> None:
    """Put the contents of each included file where its `<include>` stands."""
    for child in list(parent):
        if child.tag != "include":
            _expand_includes(child, folder, seen)
            continue
        included = _read_include(folder / child.get("file", ""), folder, seen)
        _expand_includes(included, folder, seen)
        place = list(parent).index(child)
        parent[place : place + 1] = list(included)


def _read_include(path: Path, folder: Path, seen: set[Path]) -> ET.Element:
    if not is_below(path, roots_of(folder / "model.xml")):
        raise RobotError(
            f"the included file {path} lies outside of the model's folder and repository",
            hint="put it into the model's folder",
        )
    if path.resolve() in seen:
        raise RobotError(
            f"{path} is included twice", hint="MJCF allows each file to be included once"
        )
    seen.add(path.resolve())
    try:
        return parse_xml(read_plain_file(path, MAX_BYTES), Remarks())
    except OSError as error:
        raise RobotError(
            f"the included file {path} cannot be read: {error.strerror}",
            hint="keep the model's files together; a model from standard input "
            "finds its includes in the current folder",
        ) from error
    except RobotError as error:
        raise RobotError(f"the included file {path}: {error.message}", hint=error.hint) from error
