"""Output folders and files that appear complete or not at all.

Results are completed in hidden folders. A run holds a lock on its own folder while it lives, and
the system releases the lock however the run ends. So a later run can distinguish leftovers from
folders that another run is writing.
"""

import errno
import hashlib
import os
import re
import secrets
import shutil
import sys
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from ocs_design.common.errors import OutputError
from ocs_design.device.records.design import DESIGN_FILE

FRONT_FILE = "front.json"
REPORT_FILE = "report.html"

NEW, OLD = "new", "old"
"""Names of the new result and of the old one that it replaces, in a hidden folder."""

_MARK = "ocs-design"
"""Part of the hidden folders' names, so that a user's own are not mistaken for them."""

_unfinished: dict[Path, Path] = {}
"""Hidden folders of this process and their targets, from before creation until removal."""

_AT_FDCWD = -100
_RENAME_EXCHANGE = 2
"""Constants of Linux' `fcntl.h` and `fs.h`, which Python has no names for."""

_CANNOT_EXCHANGE = {errno.EINVAL, errno.ENOSYS, errno.ENOTSUP}
"""Errors of file systems that cannot exchange, and of containers that block the call."""

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
"""Remedy for an error of the operating system, by its number."""


def check_target(target: Path, *, force: bool) -> None:
    """Fail early if `target` could not be written after the work.

    Leftovers of killed runs beside it are removed.

    Raises:
        OutputError: it exists and `force` is not set, it is not an ocs-design output folder, or its
            parent cannot be written to.
    """
    if not _is_there(target):
        return
    if target.is_symlink() or not target.is_dir():
        raise OutputError(f"{target}: is not a folder", hint="choose another name with -o")
    ours = any((target / name).is_file() for name in (DESIGN_FILE, FRONT_FILE))
    if any(target.iterdir()) and not ours:
        raise OutputError(
            f"{target}: exists already and is not an output of ocs-design: it has no {DESIGN_FILE} "
            f"and no {FRONT_FILE}",
            hint="choose another folder with -o",
        )
    if not force:
        raise OutputError(
            f"{target}: exists already",
            hint="choose another folder with -o, or replace this one with --force; in Python: "
            "`out=`, `force=True`",
        )


def check_file_target(target: Path, *, force: bool) -> None:
    """Refuse a file that cannot be written, or that would be overwritten without `force`.

    Raises:
        OutputError: it exists and `force` is not set, or is not a file; or its folder does not
            exist or cannot be written to.
    """
    if not _is_there(target):
        return
    if not target.is_file():
        raise OutputError(f"{target}: is not a file", hint="choose another name with -o")
    if not force:
        raise OutputError(
            f"{target}: exists already",
            hint="choose another name with -o, or replace it with --force",
        )


def _is_there(target: Path) -> bool:
    """Whether the target exists; leftovers of killed runs beside it are removed.

    Raises:
        OutputError: nothing can be created beside it.
    """
    parent = target.absolute().parent
    if not parent.is_dir():
        fault = errno.ENOTDIR if any(map(Path.is_file, target.absolute().parents)) else errno.ENOENT
        raise OutputError(f"{parent}: no such folder", hint=CURES[fault])
    clear_leftovers(target)
    # Tried, because permissions do not tell: root may write to /proc, which accepts no files.
    try:
        with staging_beside(target):
            pass
    except OSError as error:
        fault = errno.EACCES if error.errno in {None, errno.ENOENT} else error.errno
        raise OutputError(
            f"{parent}: cannot be written to: {os.strerror(fault)}", hint=CURES.get(fault, "")
        ) from error
    return os.path.lexists(target)


@contextmanager
def staged_folder(target: Path, *, force: bool) -> Iterator[Path]:
    """Temporary folder beside `target` that replaces it when the block ends without an error.

    Raises:
        OutputError: as `check_target`; or writing failed (full disk, no permission). `target` is
            then unchanged.
    """
    check_target(target, force=force)
    try:
        with staging_beside(target) as staging:
            new = staging / NEW
            new.mkdir()
            yield new
            # Another run may have written the target meanwhile.
            check_target(target, force=force)
            if not target.exists():
                new.rename(target)
            # At no moment is the target half of the new folder and half of the old one.
            elif not exchange(new, target):
                # `clear_leftovers` repairs an interrupted replacement.
                try:
                    target.rename(staging / OLD)
                    new.rename(target)
                except BaseException:
                    if not target.exists():
                        (staging / OLD).rename(target)
                    raise
    except OSError as error:
        raise output_error(error, target) from error


def output_error(error: OSError, place: Path) -> OutputError:
    """Error with remedy for an operating system's error on writing to `place`."""
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
    """Hashes that a design records: of all files except those that contain the design itself."""
    hashes = file_hashes(folder)
    return {name: hashes[name] for name in hashes if name not in (DESIGN_FILE, REPORT_FILE)}


def exchange(one: Path, other: Path) -> bool:
    """Exchange two folders atomically; False if system or file system cannot.

    Raises:
        OSError: the exchange is supported, but failed for these two.
    """
    # Slow to import, and only needed for replacing.
    import ctypes  # noqa: PLC0415

    try:
        rename = ctypes.CDLL(None, use_errno=True).renameat2
    except (AttributeError, OSError, TypeError):
        # Not Linux, or a C library without it.
        return False
    names = (os.fsencode(one), os.fsencode(other))
    if rename(_AT_FDCWD, names[0], _AT_FDCWD, names[1], _RENAME_EXCHANGE) == 0:
        return True
    fault = ctypes.get_errno()
    if fault in _CANNOT_EXCHANGE:
        return False
    raise OSError(fault, os.strerror(fault), str(other))


def keep_others(source: Path, target: Path, *, without: Collection[str]) -> None:
    """Copy files of a design's folder that `target` lacks, except design.json and `without`."""
    for path in sorted(source.rglob("*")):
        place = path.relative_to(source)
        copied = target / place
        left = place.name == DESIGN_FILE or place.as_posix() in without
        if path.is_file() and not left:
            copied.parent.mkdir(parents=True, exist_ok=True)
            if not copied.exists():
                shutil.copy2(path, copied, follow_symlinks=False)


def write_whole(target: Path, content: str | bytes, *, force: bool) -> None:
    """Write all of `content`, text as UTF-8, or leave everything unchanged.

    Raises:
        OutputError: see `check_file_target`; or writing failed.
    """
    check_file_target(target, force=force)
    try:
        with whole_file(target) as complete:
            complete.write_bytes(content if isinstance(content, bytes) else content.encode())
    except OSError as error:
        raise output_error(error, target) from error


@contextmanager
def whole_file(target: Path) -> Iterator[Path]:
    """Temporary file that replaces `target` when the block ends without an error.

    Raises:
        OSError: it cannot be written; `target` is then unchanged.
    """
    clear_leftovers(target)
    with staging_beside(target) as folder:
        yield folder / target.name
        (folder / target.name).replace(target)


@contextmanager
def staging_beside(target: Path) -> Iterator[Path]:
    """Hidden folder beside `target`, on the same disk, which is removed after the block.

    Raises:
        OSError: it cannot be created there.
    """
    folder, handle = _locked_folder(target)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        _unfinished.pop(folder, None)
        if handle is not None:
            os.close(handle)


def remove_unfinished() -> None:
    """Remove folders of blocks that were interrupted outside their `finally`.

    To be called when no further interrupt can arrive.
    """
    for folder, target in _unfinished.items():
        with suppress(OSError):
            _undo(folder, target)


def clear_leftovers(target: Path) -> None:
    """Remove leftovers of killed runs beside `target`, and restore a result that one had moved."""
    pattern = re.compile(rf"\.{re.escape(target.name)}\.{_MARK}-[a-z0-9_]{{8}}")
    with suppress(OSError):
        for folder in sorted(target.absolute().parent.iterdir()):
            if not pattern.fullmatch(folder.name) or folder.is_symlink():
                continue
            with suppress(OSError):
                handle = _lock(folder)
                try:
                    _undo(folder, target)
                finally:
                    os.close(handle)


def _locked_folder(target: Path) -> tuple[Path, int | None]:
    """Path of a new folder, and the handle that holds its lock; None if locks are not supported.

    Its name is known before it is created, unlike with `tempfile`.
    """
    while True:
        folder = target.absolute().parent / f".{target.name}.{_MARK}-{secrets.token_hex(4)}"
        _unfinished[folder] = target
        try:
            folder.mkdir(mode=0o700)
        except OSError as error:
            del _unfinished[folder]
            if isinstance(error, FileExistsError):
                continue
            raise
        try:
            handle = _lock(folder)
        except (BlockingIOError, FileNotFoundError):
            # Another run removed it as a leftover before it was locked.
            del _unfinished[folder]
            continue
        except OSError:
            return folder, None
        if folder.exists():
            return folder, handle
        del _unfinished[folder]
        os.close(handle)


def _undo(folder: Path, target: Path) -> None:
    if (folder / OLD).exists() and not os.path.lexists(target):
        (folder / OLD).rename(target)
    shutil.rmtree(folder, ignore_errors=True)


def _lock(folder: Path) -> int:
    """Handle that holds the lock until it is closed or the process ends.

    Raises:
        BlockingIOError: another run holds the lock.
        OSError: this system or disk does not support locks.
    """
    if sys.platform == "win32":
        raise OSError(errno.ENOTSUP, os.strerror(errno.ENOTSUP), str(folder))
    import fcntl  # noqa: PLC0415  Windows has none

    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        raise
    return handle
