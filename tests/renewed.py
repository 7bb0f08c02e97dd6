"""Designs that `export` is asked to write again, and what it answers for."""

from pathlib import Path

from commands import BOUND, run

MADE = ("cad", "robot", "snippets")
QUICK = (*BOUND, "--no-validate", "-q")


def files_in(folder):
    """Content of every file below `folder`, by its path."""
    paths = (path for path in Path(folder).rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def made_in(folder):
    """What `export` answers for."""
    return {name: content for name, content in files_in(folder).items() if name.startswith(MADE)}


def sized(*arguments, stdin=b""):
    """A design in the folder `ocs` of the working directory."""
    result = run("size", *arguments, *QUICK, "-o", "ocs", stdin=stdin)
    assert result.code == 0, result.stderr
    return Path("ocs")
