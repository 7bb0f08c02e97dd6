"""An output folder that appears complete or not at all."""

import errno
import hashlib
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ocs_design.exceptions import OutputError
from ocs_design.export.exchange import exchange
from ocs_design.export.staging import NEW, OLD, clear_leftovers, staging_beside

DESIGN_FILE = "design.json"
FRONT_FILE = "front.json"
REPORT_FILE = "report.html"

CURES = {
    errno.ENOSPC: "free some space, or choose another folder with -o",
    errno.EDQUOT: "free some space, or choose another folder with -o",
    errno.ENOTEMPTY: "another run was quicker; choose another folder with -o",
    errno.EFBIG: "allow larger files (`ulimit -f unlimited`), or choose another disk with -o",
    errno.EACCES: "choose a folder that you may write to with -o",
    errno.EPERM: "choose a folder that you may write to with -o",
    errno.EROFS: "choose a folder on a writable disk with -o",
    errno.ENOENT: "create the parent folder first, or choose another with -o",
    errno.ENOTDIR: "a part of the path is a file; choose another folder with -o",
    errno.ENAMETOOLONG: "choose a shorter name with -o",
}
"""What to do about an error of the operating system, by its number."""


def check_target(target: Path, *, force: bool) -> None:
    """Fail before any work is done if `target` could not be written in the end.

    What killed runs left beside it is cleared up.

    Raises:
        OutputError: it exists and `force` is not set, it is no output folder of ours, or its parent
            cannot be written to.
    """
    parent = target.absolute().parent
    if not parent.is_dir():
        fault = errno.ENOTDIR if any(map(Path.is_file, target.absolute().parents)) else errno.ENOENT
        raise OutputError(f"{parent}: no such folder", hint=CURES[fault])
    if not os.access(parent, os.W_OK | os.X_OK):
        raise OutputError(f"{parent}: cannot be written to", hint=CURES[errno.EACCES])
    clear_leftovers(target)
    if not os.path.lexists(target):
        return
    if target.is_symlink() or not target.is_dir():
        raise OutputError(f"{target}: is not a folder", hint="choose another name with -o")
    ours = any((target / name).is_file() for name in (DESIGN_FILE, FRONT_FILE))
    if any(target.iterdir()) and not ours:
        raise OutputError(
            f"{target}: exists already, and is no output of ocs-design: it holds no {DESIGN_FILE} "
            f"and no {FRONT_FILE}",
            hint="choose another folder with -o",
        )
    if not force:
        raise OutputError(
            f"{target}: exists already",
            hint="choose another folder with -o, or replace this one with --force",
        )


@contextmanager
def staged_folder(target: Path, *, force: bool) -> Iterator[Path]:
    """A temporary folder beside `target` that takes its place when the block ends well.

    Raises:
        OutputError: as `check_target`; or writing failed (full disk, no permission). `target` is
            then as it was.
    """
    check_target(target, force=force)
    try:
        with staging_beside(target) as staging:
            new = staging / NEW
            new.mkdir()
            yield new
            _take_place(staging, target, force=force)
    except OSError as error:
        raise output_error(error, target) from error


def output_error(error: OSError, place: Path) -> OutputError:
    """What the operating system said of writing to `place`, with the cure."""
    reason = error.strerror or str(error)
    return OutputError(f"{error.filename or place}: {reason}", hint=CURES.get(error.errno or 0, ""))


def file_hashes(folder: Path) -> Mapping[str, str]:
    """SHA-256 of every file below `folder` by its relative path, sorted."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
    }


def recorded_hashes(folder: Path) -> Mapping[str, str]:
    """What a design says of its files: not of those that hold the design, these hashes and all."""
    found = file_hashes(folder)
    return {name: found[name] for name in found if name not in (DESIGN_FILE, REPORT_FILE)}


def _take_place(staging: Path, target: Path, *, force: bool) -> None:
    """At no moment is `target` half of one and half of the other."""
    # Another run may have been quicker.
    check_target(target, force=force)
    if not target.exists():
        (staging / NEW).rename(target)
    elif not exchange(staging / NEW, target):
        _step_aside(staging, target)


def _step_aside(staging: Path, target: Path) -> None:
    """Where two cannot change places; `clear_leftovers` mends what is cut short."""
    try:
        target.rename(staging / OLD)
        (staging / NEW).rename(target)
    except BaseException:
        if not target.exists():
            (staging / OLD).rename(target)
        raise
