"""Hidden folders in which a result is completed, and the removal of those of killed runs.

A run holds a lock on its folder for as long as it lives, and the system takes that from it however
it ends. So a later run can tell what is left over from what another one is writing just now.
"""

import errno
import os
import re
import secrets
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

NEW, OLD = "new", "old"
"""Names in such a folder of the new result, and of the old one that it replaces."""

_MARK = "ocs-design"
"""Part of the folders' names, so that a user's own hidden folders are not taken for them."""

_unfinished: dict[Path, Path] = {}
"""Folders of this process and their targets, from before they are made until they are gone."""


@contextmanager
def staging_beside(target: Path) -> Iterator[Path]:
    """Hidden folder beside `target`, on the same disk, which is gone after the block.

    Raises:
        OSError: none can be made there.
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

    To be called when nothing interrupts any longer.
    """
    for folder, target in _unfinished.items():
        with suppress(OSError):
            _undo(folder, target)


def clear_leftovers(target: Path) -> None:
    """Remove what killed runs left beside `target`; what one of them had put aside comes back."""
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
    """Path of a new folder, and the handle that bears its lock; None where there are no locks.

    Its name is known before it is made, unlike that of `tempfile`.
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
            # A run that is clearing up took it for a leftover before it was locked.
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
    """Handle that bears the lock until it is closed or the process ends.

    Raises:
        BlockingIOError: another run has it.
        OSError: there are no locks on this system or disk.
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
