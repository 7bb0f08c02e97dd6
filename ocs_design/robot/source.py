"""Bytes of a robot file from a path or from standard input, gzipped or not."""

import gzip
import hashlib
import io
import os
import sys
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from ocs_design.common.errors import RobotError, closest
from ocs_design.common.files import AnyPath

STANDARD_INPUT = "-"
MAX_BYTES = 64 * 2**20
"""Largest robot file, zipped and unzipped; a thousand links take about one megabyte."""

_GZIP_MAGIC = b"\x1f\x8b"


@dataclass(frozen=True)
class Source:
    """A robot file's bytes.

    Attributes:
        path_text: as the user wrote it; `-` for standard input.
        folder: that contains the file; None for standard input.
        content: unzipped.
        sha256: hexadecimal, of the bytes as they were read, before unzipping.
    """

    path_text: str
    folder: Path | None
    content: bytes
    sha256: str

    @property
    def shown(self) -> str:
        """Name of the file in messages."""
        return _shown(self.path_text)


def read_source(source: AnyPath) -> Source:
    """Bytes of the file at a path, or of standard input for `-`."""
    path_text = os.fspath(source)
    if path_text == STANDARD_INPUT:
        if sys.stdin is None or sys.stdin.isatty():
            raise RobotError(
                "standard input contains no robot", hint="pipe a file into it: cat robot.urdf | ..."
            )
        folder, raw = None, _read_bounded(sys.stdin.buffer, STANDARD_INPUT)
    else:
        path = Path(source)
        folder, raw = path.absolute().parent, _read_file(path, path_text)
    content = raw
    if raw.startswith(_GZIP_MAGIC):
        try:
            with gzip.GzipFile(fileobj=io.BytesIO(raw)) as stream:
                content = _read_bounded(stream, path_text, " unzipped")
        except EOFError as error:
            raise RobotError(
                f"{_shown(path_text)} is a gzip file that ends too early",
                hint="it was cut off in copying or downloading: fetch it again",
            ) from error
        except (OSError, zlib.error) as error:
            raise RobotError(
                f"{_shown(path_text)} is a broken gzip file: {error}",
                hint="fetch it again, or unzip it to see what is in it",
            ) from error
    if not content.strip():
        raise RobotError(f"{_shown(path_text)} is empty", hint="give a URDF or MJCF file")
    return Source(path_text, folder, content, hashlib.sha256(raw).hexdigest())


def _read_file(path: Path, name: str) -> bytes:
    try:
        with path.open("rb") as stream:
            return _read_bounded(stream, str(path))
    except FileNotFoundError as error:
        hint = "check the path"
        if path.is_symlink():
            raise RobotError(
                f"{path} is a link to {path.readlink()}, which does not exist", hint=hint
            ) from error
        if "://" in name:
            hint = "it is a web address: download the file and its meshes first"
            raise RobotError(f"{name} is not a file", hint=hint) from error
        try:
            kinds = {*_ROBOT_SUFFIXES, path.suffix}
            siblings = sorted(
                (
                    sibling
                    for sibling in path.absolute().parent.iterdir()
                    if sibling.suffix in kinds
                ),
                key=lambda sibling: sibling.suffix == path.suffix,
            )
            name_of_stem = {sibling.stem: sibling.name for sibling in siblings}
        except OSError:
            hint = f"the folder {path.parent} does not exist either"
        else:
            close = closest(path.stem, name_of_stem)
            if close:
                hint = f"did you mean {path.with_name(name_of_stem[close[0]])}?"
        raise RobotError(f"{path} does not exist", hint=hint) from error
    except IsADirectoryError as error:
        robots = _likely_robots(path)
        hint = (
            f"give a file, such as {robots[0]}" if robots else "give the URDF or MJCF file itself"
        )
        raise RobotError(f"{path} is a folder", hint=hint) from error
    except PermissionError as error:
        raise RobotError(
            f"{path} cannot be read: permission denied", hint=f"try: chmod u+r {path}"
        ) from error
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise RobotError(
            f"{str(path)!r} cannot be read: {reason}", hint="check the path"
        ) from error


def _likely_robots(folder: Path) -> list[Path]:
    """Likely robot files in a folder and its subfolders, as in packages; best first."""
    inside = (*folder.glob("*"), *folder.glob("[!.]*/*"))
    likely = (
        path
        for path in inside
        if path.suffix in _ROBOT_SUFFIXES and path.name not in _PACKAGE_FILES
    )
    return sorted(likely, key=lambda path: (len(path.parts), ".urdf" not in path.name, path))


_ROBOT_SUFFIXES = {".urdf", ".xacro", ".xml", ".gz"}
"""Suffixes of files that may be robots."""

_PACKAGE_FILES = {"package.xml", "plugin.xml", "plugins.xml"}
"""Other XML files of a ROS package than its robot."""


def _read_bounded(stream: BinaryIO | gzip.GzipFile, path_text: str, state: str = "") -> bytes:
    content = stream.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise RobotError(
            f"{_shown(path_text)} is larger than {MAX_BYTES // 2**20} MiB{state}",
            hint="a robot file contains only text; keep its meshes in separate files",
        )
    return content


def _shown(path_text: str) -> str:
    return "standard input" if path_text == STANDARD_INPUT else path_text
