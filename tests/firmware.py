"""The exported controller, compiled."""

import importlib.util
import shutil
import subprocess

import pytest

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
    specification = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    with pytest.raises(FileNotFoundError, match="make"):
        module.Controller()
    compiled(folder, "-fPIC", "-shared", out=f"lib{path.stem}.so", sources=())
    return module.Controller(), module
