"""Reads a robot from any file that is understood, chosen by content and not by name."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from ocs_design.exceptions import MissingToolError, RobotError
from ocs_design.robot.files.meshes import MeshFinder
from ocs_design.robot.files.source import Source, read_source
from ocs_design.robot.files.srdf import Postures, postures_beside
from ocs_design.robot.files.xacro import expand_xacro
from ocs_design.robot.remarks import Remarks
from ocs_design.robot.robot import Format
from ocs_design.robot.tree import Tree
from ocs_design.robot.urdf.reading import is_xacro, read_urdf
from ocs_design.robot.urdf.xml import parse_xml

_SUFFIXES = (".gz", ".xacro", ".urdf", ".xml")


@dataclass(frozen=True, eq=False)
class Loaded:
    """A robot file, read.

    Attributes:
        tree: moving bodies.
        format: URDF (also from xacro) or MJCF.
        content: the file's text, unzipped and expanded.
        sha256: of the bytes as they were read.
        source: as the user wrote it.
    """

    tree: Tree
    format: Format
    content: bytes
    sha256: str
    source: str


def load(source: str | Path, *, package_paths: Mapping[str, Path] | None = None) -> Loaded:
    """Read a URDF, xacro or MJCF, gzipped or not, from a path or from standard input (`-`).

    Args:
        source: a path, or `-`.
        package_paths: folder of each package that `package://` addresses name.
    """
    read = read_source(source)
    with _naming_the_file(read):
        return _load(read, package_paths or {})


@contextmanager
def _naming_the_file(read: Source) -> Iterator[None]:
    """Puts the file's name in front of what is wrong in it."""
    try:
        yield
    except (RobotError, MissingToolError) as error:
        raise type(error)(f"{read.shown}: {error.message}", hint=error.hint) from error


def _load(read: Source, package_paths: Mapping[str, Path]) -> Loaded:
    folder = read.folder or Path.cwd()
    root = parse_xml(read.content, Remarks())
    if root.tag == "mujoco":
        from ocs_design.robot.mjcf.reading import read_mjcf  # noqa: PLC0415 - MuJoCo takes 0.3 s

        tree = read_mjcf(read.content, folder)
        return Loaded(tree, Format.MJCF, read.content, read.sha256, read.path_text)
    finder = MeshFinder(folder, package_paths)
    content = read.content
    if root.tag == "robot" and is_xacro(root):
        content = expand_xacro(content, folder / Path(read.path_text).name, package_paths)
    tree = _with_remarks(read_urdf(content, find_mesh=finder), finder, read)
    return Loaded(tree, Format.URDF, content, read.sha256, read.path_text)


def _with_remarks(tree: Tree, finder: MeshFinder, read: Source) -> Tree:
    """The tree with its SRDF's postures, and with a warning for the meshes that are not there."""
    remarks = Remarks()
    if finder.missing:
        first = next(iter(finder.missing))
        remarks.add(f"{len(finder.missing)} meshes were not found, the first is {first}")
    postures: Postures = {}
    if read.folder is not None:
        postures = postures_beside(read.folder, _stem(read.path_text), tree.name, remarks)
    return replace(
        tree,
        named_postures=_of_tree(postures, tree),
        warnings=(*tree.warnings, *remarks.sentences()),
    )


def _of_tree(postures: Postures, tree: Tree) -> Postures:
    """Only what concerns joints of the tree."""
    kept = {
        name: {joint: value for joint, value in values.items() if joint in tree.joints}
        for name, values in postures.items()
    }
    return {name: values for name, values in kept.items() if values}


def _stem(path_text: str) -> str:
    name = Path(path_text).name
    for suffix in _SUFFIXES:
        name = name.removesuffix(suffix)
    return name
