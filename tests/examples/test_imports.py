"""Names that scripts import from the package exist, since most scripts run in no test."""

import ast
from contextlib import suppress
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def exists(module, name):
    """Whether a module has this name, or a package this submodule."""
    if hasattr(import_module(module), name):
        return True
    with suppress(ModuleNotFoundError):
        return bool(import_module(f"{module}.{name}"))
    return False


@pytest.mark.parametrize("folder", ["examples", "benchmarks", "docs"])
def test_imported_names_exist(folder):
    imported = [
        (path.name, node.module, alias.name)
        for path in (ROOT / folder).rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("ocs_design")
        for alias in node.names
    ]
    assert imported
    assert [name for name in imported if not exists(*name[1:])] == []
