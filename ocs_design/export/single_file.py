"""One file of text that appears complete or not at all."""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ocs_design.exceptions import OutputError
from ocs_design.export.folder import CURES, output_error
from ocs_design.export.staging import clear_leftovers, staging_beside


def check_file_target(target: Path, *, force: bool) -> None:
    """Fail before any work is done if `target` could not be written in the end.

    Raises:
        OutputError: it exists and `force` is not set, or is no file; or its folder does not exist.
    """
    if not target.absolute().parent.is_dir():
        raise OutputError(f"{target.absolute().parent}: no such folder", hint=CURES[errno.ENOENT])
    if not os.path.lexists(target):
        return
    if not target.is_file():
        raise OutputError(f"{target}: is not a file", hint="choose another name with -o")
    if not force:
        raise OutputError(
            f"{target}: exists already",
            hint="choose another name with -o, or replace it with --force",
        )


def write_whole(target: Path, text: str, *, force: bool) -> None:
    """Write all of `text` as UTF-8 or leave everything as it was.

    Raises:
        OutputError: see `check_file_target`; or writing failed.
    """
    check_file_target(target, force=force)
    try:
        with whole_file(target) as complete:
            complete.write_text(text, encoding="utf-8", newline="\n")
    except OSError as error:
        raise output_error(error, target) from error


@contextmanager
def whole_file(target: Path) -> Iterator[Path]:
    """The file to write, which takes the place of `target` when the block ends well.

    Raises:
        OSError: it cannot be written; `target` is then as it was.
    """
    clear_leftovers(target)
    with staging_beside(target) as folder:
        yield folder / target.name
        (folder / target.name).replace(target)
