"""The exported controller, compiled."""

import shutil
import subprocess

import pytest
from scripts import script_at

STRICT = ("-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror")


def compiler():
    """The C compiler; without one the test is skipped."""
    found = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if found is None:
        pytest.skip("no C compiler")
    return found


def compiled(folder, *options, out="harness", sources=("harness.c",)):
    """A program or a library of the controller in a folder."""
    (own,) = folder.glob("*_ocs_controller.c")
    command = [compiler(), *STRICT, "-O2", *options, "-o", str(folder / out)]
    names = [str(folder / each) for each in sources]
    subprocess.run([*command, *names, str(own), "-lm"], check=True)
    return folder / out


def bound(folder):
    """The controller by its own Python binding, and that module."""
    (path,) = folder.glob("*_ocs_controller.py")
    module = script_at(path)
    with pytest.raises(FileNotFoundError, match="make"):
        module.Controller()
    compiled(folder, "-fPIC", "-shared", out=f"lib{path.stem}.so", sources=())
    return module.Controller(), module
