"""Structure of the package: imports in one direction, and a fast start."""

import ast
import re
import tomllib
from functools import cache
from pathlib import Path

import pytest
from scripts import HEAVY, modules_loaded_by

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "ocs_design"


@pytest.mark.parametrize("module", ["ocs_design", "ocs_design.cli.app"])
def test_start_up_loads_nothing_heavy(module):
    assert modules_loaded_by(f"import {module}").isdisjoint(HEAVY)


def test_the_check_for_heavy_modules_sees_them():
    assert "numpy" in modules_loaded_by("import numpy.linalg")


def test_reading_a_robot_loads_no_simulator_or_solver():
    loaded = modules_loaded_by("import ocs_design.robot.urdf")
    assert loaded.isdisjoint({"mujoco", "cvxpy", "trimesh", "casadi"})


def test_parts_load_no_cad_kernel_before_export():
    loaded = modules_loaded_by("import ocs_design.parts.foot, ocs_design.export.formats")
    assert loaded.isdisjoint({"OCP", "manifold3d", "trimesh", "mujoco", "cvxpy"})


def test_every_folder_is_in_the_layers():
    """`exhaustive` checks it too, but only where import-linter is installed."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"][
        "contracts"
    ]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    named = {name.strip() for layer in layers for name in layer.split("|")}
    present = {path.stem for path in PACKAGE.iterdir() if path.suffix == ".py" or is_package(path)}
    assert present - {"__init__"} == named


def is_package(path):
    return (path / "__init__.py").exists()


def test_the_gate_names_existing_tests():
    """It runs some with the oldest versions, after everything else has passed."""
    gate = ROOT / ".ci" / "run"
    if not gate.exists():
        pytest.skip("the source package has no gate")
    named = re.findall(r"tests/[\w/]+\.py", gate.read_text())
    assert named
    assert [path for path in named if not (ROOT / path).is_file()] == []


DEEPEST = 18
"""Largest number of modules in a chain of imports."""


def test_the_chain_of_imports_is_short():
    chain = longest_chain(imports_of(PACKAGE))
    assert len(chain) <= DEEPEST, " -> ".join(chain)


def test_no_modules_import_each_other():
    """Directly or indirectly, not even for the names of types."""
    imports = {name: set(imported) for name, imported in imports_of(PACKAGE).items()}
    while leaves := [name for name, needed in imports.items() if not needed & imports.keys()]:
        for name in leaves:
            del imports[name]
    assert not imports, f"a cycle, or above one: {', '.join(sorted(imports))}"


def test_the_longest_chain_is_found():
    imports = {"a": {"b", "c"}, "b": {"c"}, "c": {"d"}, "d": set(), "e": {"d"}}
    assert longest_chain(imports) == ("a", "b", "c", "d")


IMPORT = re.compile(r"^ *from [\w.]+ import (?:\([^)]*\)|.*)", re.M)
"""An import statement; parsing the whole package would take seconds."""


@cache
def imports_of(package):
    """Modules of the package that each of its modules imports, at any place."""
    texts = {name_of(path, package): path.read_text() for path in package.rglob("*.py")}
    return {
        name: {
            source
            for statement in IMPORT.findall(text)
            for node in ast.parse(statement.strip()).body
            for source in (f"{node.module}.{alias.name}" for alias in node.names)
            for source in ((source if source in texts else node.module),)
            if source in texts and source not in (name, package.name)
        }
        for name, text in texts.items()
    }


def name_of(path, package):
    parts = path.relative_to(package.parent).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


def longest_chain(imports):
    chains = {}

    def chain(name):
        if name not in chains:
            chains[name] = ()
            below = max((chain(other) for other in imports[name]), key=len, default=())
            chains[name] = (name, *below)
        return chains[name]

    return max(map(chain, sorted(imports)), key=len)


def test_types_are_shipped():
    assert (PACKAGE / "py.typed").exists()
