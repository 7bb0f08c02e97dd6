"""What the shape of the package promises: imports in one direction, and a quick start."""

import tomllib
from pathlib import Path

import pytest
from loading import HEAVY, modules_loaded_by

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "ocs_design"


@pytest.mark.parametrize("module", ["ocs_design", "ocs_design.cli.app"])
def test_start_up_loads_nothing_heavy(module):
    assert modules_loaded_by(f"import {module}").isdisjoint(HEAVY)


def test_the_check_for_heavy_modules_sees_them():
    assert "numpy" in modules_loaded_by("import numpy.linalg")


def test_reading_a_robot_needs_no_simulator_and_no_solver():
    loaded = modules_loaded_by("import ocs_design.robot.urdf.reading")
    assert loaded.isdisjoint({"mujoco", "cvxpy", "trimesh", "casadi"})


def test_a_part_needs_no_cad_kernel_until_it_is_written():
    loaded = modules_loaded_by("import ocs_design.parts.foot, ocs_design.parts.step")
    assert loaded.isdisjoint({"OCP", "manifold3d", "trimesh", "mujoco", "cvxpy"})


def test_every_module_stands_in_the_layers():
    """`exhaustive` would catch it too, but only where import-linter is installed."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"][
        "contracts"
    ]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    named = {name.strip(" ()") for layer in layers for name in layer.replace("|", ":").split(":")}
    present = {path.stem for path in PACKAGE.iterdir() if path.suffix == ".py" or is_package(path)}
    assert present - {"__init__"} <= named


def is_package(path):
    return (path / "__init__.py").exists()


def test_files_stay_readable():
    """One purpose a file: at most 300 lines."""
    too_long = {
        str(path.relative_to(ROOT)): lines
        for folder in (PACKAGE, ROOT / "tests")
        for path in folder.rglob("*.py")
        if (lines := len(path.read_text().splitlines())) > 300
    }
    assert not too_long


def test_types_are_shipped():
    assert (PACKAGE / "py.typed").exists()
