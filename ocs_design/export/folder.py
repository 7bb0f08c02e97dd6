"""An output folder that appears complete or not at all."""

import errno
import hashlib
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ocs_design.exceptions import OutputError

DESIGN_FILE = "design.json"
FRONT_FILE = "front.json"
REPORT_FILE = "report.html"

CURES = {
    errno.ENOSPC: "free some space, or choose another folder with -o",
    errno.EDQUOT: "free some space, or choose another folder with -o",
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
    parent = target.absolute().parent
    staging: Path | None = None
    try:
        staging = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=parent))
        staging.chmod(0o755 & ~_umask())
        yield staging
        _take_place(staging, target)
    except OSError as error:
        where = error.filename or target
        raise OutputError(
            f"{where}: {error.strerror or error}", hint=CURES.get(error.errno or 0, "")
        ) from error
    finally:
        if staging is not None:
            shutil.rmtree(staging, ignore_errors=True)


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


def _take_place(staging: Path, target: Path) -> None:
    if not target.exists():
        staging.rename(target)
        return
    # A folder cannot be renamed over a full one: the old one steps aside and comes back on failure.
    aside = Path(tempfile.mkdtemp(prefix=f".{target.name}-old-", dir=target.absolute().parent))
    target.rename(aside / target.name)
    try:
        staging.rename(target)
    except BaseException:
        (aside / target.name).rename(target)
        raise
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
