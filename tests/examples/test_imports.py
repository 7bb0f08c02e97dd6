"""What the scripts beside the package import from it exists: most of them run in no test."""

import ast
from contextlib import suppress
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def exists(module, name):
    """Whether a module has this name, or a package this module."""
    if hasattr(import_module(module), name):
        return True
    with suppress(ModuleNotFoundError):
        return bool(import_module(f"{module}.{name}"))
    return False


@pytest.mark.parametrize("folder", ["examples", "benchmarks", "docs"])
def test_what_scripts_import_from_the_package_exists(folder):
    imported = [
        (path.name, node.module, each.name)
        for path in (ROOT / folder).rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("ocs_design")
        for each in node.names
    ]
    assert imported
    assert [each for each in imported if not exists(*each[1:])] == []
