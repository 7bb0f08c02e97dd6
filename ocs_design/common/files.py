"""Reading user files up to a bounded size; JSON; the processors that a process may use."""

import errno
import os
import re
import stat
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from ocs_design.common.errors import SpecificationError

AnyPath: TypeAlias = str | os.PathLike[str]
"""A path as a user gives it in Python."""


def safe_name(name: str) -> str:
    """The name of a robot or a maneuver as a file name."""
    return re.sub(r"[^A-Za-z0-9._-]+", "_", name).strip("._") or "robot"


def comparable_name(name: str) -> str:
    """Key that is equal for names with the same files: some file systems ignore case."""
    return safe_name(name).casefold()


_UNITS = ((1 << 20, "MiB"), (1 << 10, "KiB"))


@dataclass(frozen=True)
class TextKind:
    """One kind of file.

    Attributes:
        name: for messages, as in "catalogue".
        largest: [bytes].
        longest_line: [characters]; the TOML reader takes minutes for a key of ten thousand dots.
        path_hint: what to do if the file is missing. quotes_hint: an example of quoted text.
    """

    name: str
    largest: int
    longest_line: int
    path_hint: str
    quotes_hint: str

    def read(self, path: Path) -> str:
        """The file's text.

        Raises:
            SpecificationError: it cannot be opened, is too large or is not UTF-8.
        """
        try:
            with path.open("rb") as stream:
                content = stream.read(self.largest + 1)
        except OSError as error:
            reason = error.strerror or "it cannot be opened"
            raise SpecificationError(
                f"cannot read the {self.name} {path}: {reason}", hint=self.path_hint
            ) from error
        if len(content) > self.largest:
            size = next(
                f"{self.largest // unit} {word}" for unit, word in _UNITS if self.largest >= unit
            )
            raise SpecificationError(f"{path} is larger than {size}: not a {self.name}")
        try:
            return content.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            line = content[: error.start].count(b"\n") + 1
            raise SpecificationError(
                f"{path}, line {line}: not UTF-8", hint="Save the file as UTF-8."
            ) from error

    def check_lines(self, text: str, name: str) -> None:
        """Refuse lines that no person writes; messages call the text `name`.

        Raises:
            SpecificationError: a line is too long.
        """
        for number, line in enumerate(text.splitlines(), 1):
            if len(line) > self.longest_line:
                raise SpecificationError(
                    f"{name}, line {number}: over {self.longest_line} characters long"
                )

    def parse_toml(self, text: str, name: str) -> dict[str, Any]:
        """The content of a TOML text; messages call it `name`.

        Raises:
            SpecificationError: it is not TOML.
        """
        self.check_lines(text, name)
        try:
            return tomllib.loads(text)
        except RecursionError as error:
            raise SpecificationError(f"{name} nests its values too deeply") from error
        except ValueError as error:
            # TOMLDecodeError, or the plain ValueError of a whole number with thousands of digits.
            raise SpecificationError(
                f"{name} is not TOML: {error}",
                hint=f"Put text in quotes, as in {self.quotes_hint}.",
            ) from error


def read_plain_file(path: Path, largest: int) -> bytes:
    """The bytes of a plain file, whose path may come from an untrusted source.

    Reading a pipe could block, and a device may never end.

    Raises:
        OSError: it cannot be read, is not a plain file, or is larger than `largest` [bytes].
    """
    # Without blocking on a pipe.
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as stream:
        status = os.fstat(handle)
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, "it is a folder", str(path))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "it is not a plain file", str(path))
        content = stream.read(largest + 1)
    if len(content) > largest:
        raise OSError(errno.EFBIG, f"it is larger than {largest >> 20} MiB", str(path))
    return content


def to_json(value: object) -> bytes:
    """Value as indented UTF-8 JSON; numbers that are not finite are null."""
    # `doctor` looks for msgspec, and must run without it.
    import msgspec  # noqa: PLC0415

    return msgspec.json.format(msgspec.json.encode(value), indent=2) + b"\n"


def processors() -> int:
    """Number of processors that this process may use, at least one."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def packaged_folder(name: str) -> Path:
    """Folder `name` of the installed package, or of the checkout."""
    package = Path(__file__).parents[1]
    installed = package / name
    return installed if installed.is_dir() else package.parent / name
