"""Reads a robot file of any format into a robot: trunk, legs, posture and mass properties.

Named postures come from the SRDF beside a URDF: https://wiki.ros.org/srdf/review, `<group_state>`.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from ocs_design.common.errors import MissingToolError, RobotError
from ocs_design.common.files import AnyPath
from ocs_design.common.units import format_quantity
from ocs_design.common.wording import some_of
from ocs_design.robot.checks import plausibility_warnings
from ocs_design.robot.leg_geometry import (
    BASE_FRAME,
    convention_warnings,
    hanging_warnings,
    with_base_frame,
)
from ocs_design.robot.links import Warnings, check_total_mass
from ocs_design.robot.meshes import MESHES, lacks_mesh, trunk_top, unmeasured, with_y_up
from ocs_design.robot.packages import MeshFinder
from ocs_design.robot.posture import resolve_posture, unknown_name
from ocs_design.robot.recognition import recognise
from ocs_design.robot.robot import Leg, Robot, RobotFormat
from ocs_design.robot.source import Source, read_source
from ocs_design.robot.tree import Tree
from ocs_design.robot.urdf import is_xacro, read_urdf
from ocs_design.robot.xacro import expand_xacro
from ocs_design.robot.xml import number, parse_xml, text

Postures = Mapping[str, Mapping[str, float]]
"""Joint values [rad or m], by name of the posture."""


def read_group_states(content: bytes) -> Postures:
    """Joint values [rad or m] of each `<group_state>`; states of the same name are merged.

    Joints with several values, such as the pose of a floating base, are left out.
    """
    root = parse_xml(content)
    if root.tag != "robot":
        raise RobotError(f"not an SRDF: its root element is <{root.tag}>")
    postures: dict[str, dict[str, float]] = {}
    for state in root.iter("group_state"):
        name = text(state, "name", "a group_state")
        values = postures.setdefault(name, {})
        where = f"group_state {name!r}"
        for joint in state.findall("joint"):
            if len(text(joint, "value", where).split()) == 1:
                values[text(joint, "name", where)] = number(joint, "value", where)
    return {name: values for name, values in postures.items() if values}


def find_srdfs(folder: Path, stem: str, robot_name: str) -> list[Path]:
    """SRDFs in `folder` or its sibling `srdf` that belong to a robot file.

    The one with the file's name; otherwise all that name the same robot.
    """
    named = sorted([*folder.glob("*.srdf"), *folder.glob("../srdf/*.srdf")])
    # Reading a pipe of that name would block.
    files = [path for path in named if path.is_file()]
    if same_stem := [path for path in files if path.stem == stem]:
        return same_stem[:1]
    same_robot = []
    for path in files:
        with suppress(RobotError):
            if parse_xml(read_source(path).content).get("name") == robot_name:
                same_robot.append(path)
    return same_robot


def postures_beside(read: Source, tree: Tree, warnings: Warnings) -> Postures:
    """Named postures of the SRDFs that belong to a robot file, for the joints of its tree."""
    if read.folder is None:
        return {}
    stem = Path(read.path_text).name
    for suffix in (".gz", ".xacro", ".urdf", ".xml"):
        stem = stem.removesuffix(suffix)
    postures: dict[str, Mapping[str, float]] = {}
    for path in find_srdfs(read.folder, stem, tree.name):
        try:
            states = read_group_states(read_source(path).content)
        except RobotError as error:
            warnings.add(f"{path.name} was not read: {error.message}")
            continue
        postures = {**states, **postures}
    known = {
        name: {joint: value for joint, value in values.items() if joint in tree.joints}
        for name, values in postures.items()
    }
    return {name: values for name, values in known.items() if values}


@dataclass(frozen=True, eq=False)
class Loaded:
    """Tree of a robot file, with the text from which it was read.

    Attributes:
        tree: moving bodies.
        format: URDF (also from xacro) or MJCF.
        content: the file's text, unzipped and expanded.
        sha256: of the bytes as they were read.
        source: as the user wrote it.
        mesh_cure: how to make the missing meshes found; empty: none is missing.
    """

    tree: Tree
    format: RobotFormat
    content: bytes
    sha256: str
    source: str
    mesh_cure: str = ""


_NO_ROBOTS: Mapping[str, tuple[str, str]] = {
    **dict.fromkeys(
        MESHES,
        ("a mesh, which has no joints and no mass", "give the URDF or MJCF file that names it"),
    ),
    **dict.fromkeys(
        (".step", ".stp", ".iges", ".igs", ".f3d", ".sldasm", ".sldprt", ".dxf"),
        ("a drawing, which has no joints", "export the robot as URDF or MJCF from CAD"),
    ),
    **dict.fromkeys(
        (".zip", ".tar", ".tgz", ".7z", ".rar"),
        ("an archive", "unpack it and give the URDF or MJCF file in it"),
    ),
    ".toml": (
        "a specification, not a robot",
        "give it with --spec, alone if it has a section [robot], or after the robot's file",
    ),
    ".json": (
        "not a robot",
        "a design.json is read by `ocs-design validate` and `ocs-design export`; "
        "`ocs-design size` takes a URDF or MJCF file",
    ),
    ".srdf": ("a list of postures, not a robot", "give the URDF: the SRDF beside it is found"),
}
"""Other kinds of files and what to give instead, by suffix."""

_ROBOT = re.compile(rb"<(link|mujoco)\b")


def load(
    source: AnyPath,
    *,
    package_paths: Mapping[str, AnyPath] | None = None,
    named: Sequence[str] = (),
) -> Loaded:
    """Read a URDF, xacro or MJCF, gzipped or not, from a path or from standard input (`-`).

    Args:
        source: a path, or `-`.
        package_paths: folder of each package, for `package://` addresses.
        named: links that the user named, to find the robot among other bodies of an MJCF model.
    """
    read = read_source(source)
    try:
        folders = {name: Path(path) for name, path in (package_paths or {}).items()}
        return _load(read, folders, named)
    except (RobotError, MissingToolError) as error:
        raise type(error)(f"{read.shown}: {error.message}", hint=error.hint) from error


def _load(read: Source, package_paths: Mapping[str, Path], named: Sequence[str]) -> Loaded:
    folder = read.folder or Path.cwd()
    content = read.content
    other = _NO_ROBOTS.get(Path(read.path_text).suffix.lower())
    # A robot counts as one whatever the file's suffix.
    if other is not None and not _ROBOT.search(content):
        raise RobotError(f"the file is {other[0]}", hint=other[1])
    root = parse_xml(content)
    if root.tag == "mujoco":
        from ocs_design.robot.mjcf import read_mjcf  # noqa: PLC0415 - MuJoCo takes 0.3 s

        tree = read_mjcf(content, folder, named)
        ignore_progress = any(map(lacks_mesh, tree.bodies))
        cure = f"put them where the model names them, below {folder}" if ignore_progress else ""
        return Loaded(tree, RobotFormat.MJCF, content, read.sha256, read.path_text, cure)
    if root.tag == "robot" and is_xacro(root):
        content = expand_xacro(content, folder / Path(read.path_text).name, package_paths)
    finder = MeshFinder(folder, package_paths)
    tree = with_y_up(read_urdf(content, find_mesh=finder))
    warnings, cure = Warnings(), ""
    if finder.missing:
        first = next(iter(finder.missing))
        cure = finder.cure()
        warnings.add(f"{len(finder.missing)} meshes were not found, the first is {first}: {cure}")
    postures = postures_beside(read, tree, warnings)
    all_warnings = (*tree.warnings, *warnings.sentences())
    tree = replace(tree, named_postures=postures, warnings=all_warnings)
    return Loaded(tree, RobotFormat.URDF, content, read.sha256, read.path_text, cure)


def read_robot(
    source: AnyPath,
    *,
    trunk: str | None = None,
    legs: Sequence[str] | None = None,
    posture: str | None = None,
    joints: Mapping[str, float] | None = None,
    package_paths: Mapping[str, AnyPath] | None = None,
) -> Robot:
    """Read a robot and measure it in its nominal posture.

    Args:
        source: URDF, xacro or MJCF file, gzipped or not; `-` for standard input.
        trunk: link that carries the device; None: found (see `recognise`).
        legs: a link of each foot; empty: the robot has no legs; None: found.
        posture: `zero`, `stand` or a posture named in the file; None: see `resolve_posture`.
        joints: values of single joints [rad or m] that replace the posture's.
        package_paths: folder of each package that `package://` addresses name.
    """
    named = [*([] if trunk is None else [trunk]), *(legs or ())]
    loaded = load(source, package_paths=package_paths, named=named)
    tree = loaded.tree
    for name in named:
        if name not in tree.body_of_link:
            raise unknown_name("link", name, tree.body_of_link)
    recognition = recognise(tree, trunk=trunk, legs=legs)
    base, found_legs, mount = recognition.reading.trunk, recognition.reading.legs, None
    if trunk is None:
        tree, mount, frame_warnings = with_base_frame(tree, base, found_legs)
    if mount is None:
        frame_warnings = tuple(convention_warnings(tree, base, found_legs))
    else:
        base = BASE_FRAME
    if trunk is None:
        frame_warnings = (*frame_warnings, *hanging_warnings(tree, base, found_legs))
    resolved = resolve_posture(tree, base, found_legs, posture, joints or {})
    properties = tree.locked_mass_properties(resolved.values, base)
    check_total_mass(properties, tree)
    warnings = (
        *tree.warnings,
        *recognition.reading.simplifications,
        *frame_warnings,
        *resolved.warnings,
        *_assumed_heights(tree, base, found_legs, resolved.standing_height),
        *plausibility_warnings(tree, base, found_legs, resolved.values, properties),
    )
    return Robot(
        name=tree.name,
        source=loaded.source,
        sha256=loaded.sha256,
        format=loaded.format,
        content=loaded.content,
        tree=tree,
        trunk=base,
        floating_base=tree.bodies[0].name,
        posture=resolved.values,
        posture_name=resolved.name,
        mass_properties=properties,
        legs=found_legs,
        standing_height=resolved.standing_height,
        warnings=tuple(dict.fromkeys(warnings)),
        mount=mount,
        recognition=recognition,
        mesh_cure=loaded.mesh_cure,
    )


def _assumed_heights(
    tree: Tree, trunk: str, legs: Sequence[Leg], standing_height: float | None
) -> Iterator[str]:
    """Warnings of the heights assumed where meshes are missing."""
    if unmeasured(tree.bodies[tree.body_of_link[trunk]]):
        top = format_quantity(trunk_top(tree, trunk), "mm")
        yield (
            f"the top of the trunk is not known without its meshes: assumed at z = {top}; "
            "give the modules' position with --position X,Y,Z"
        )
    feet = [leg.name for leg in legs if unmeasured(tree.bodies[leg.body])]
    if feet and standing_height is not None:
        height = format_quantity(standing_height, "mm")
        yield (
            f"the reach of the feet is not known without the meshes of {some_of(feet)}: judged by "
            f"their links, the trunk stands at {height}"
        )
