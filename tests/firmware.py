"""The exported controller, compiled."""

import shutil
import subprocess

import pytest
from scripts import script_at

STRICT = ("-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror")


def compiler():
    """Path of the C compiler; without one the test is skipped."""
    program = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if program is None:
        pytest.skip("no C compiler")
    return program


def compiled(folder, *options, out="harness", sources=("harness.c",)):
    """Compile the controller in a folder to a program or a library."""
    (controller,) = folder.glob("*_ocs_controller.c")
    command = [compiler(), *STRICT, "-O2", *options, "-o", str(folder / out)]
    paths = [str(folder / name) for name in sources]
    subprocess.run([*command, *paths, str(controller), "-lm"], check=True)
    return folder / out


def bound(folder):
    """The controller by its Python binding, and the module of the binding."""
    (path,) = folder.glob("*_ocs_controller.py")
    module = script_at(path)
    with pytest.raises(FileNotFoundError, match="make"):
        module.Controller()
    compiled(folder, "-fPIC", "-shared", out=f"lib{path.stem}.so", sources=())
    return module.Controller(), module
