"""The product of `size`, made once for all that open it."""

import json
import shutil
import sys

import pytest
from commands import SOLO12, environment, run_process
from exported import pinocchio_model
from products import CASES, Product, device_of
from renewed import sized


@pytest.fixture(scope="session", params=CASES)
def product(request, tmp_path_factory):
    """A cold process, its streams piped."""
    case, parent = CASES[request.param], tmp_path_factory.mktemp("cold")
    said = run_process("size", SOLO12, *case.options, cwd=parent, env=environment())
    return Product(case, said, parent / "solo12-ocs")


@pytest.fixture(scope="session")
def document(product):
    return json.loads((product.folder / "design.json").read_text())


@pytest.fixture(scope="session")
def device(document):
    return device_of(document)


@pytest.fixture(scope="session")
def exported(product):
    return pinocchio_model((product.folder / "robot" / "solo12_ocs.urdf").read_text())


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty working folder, where xacro is not installed."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "xacro", None)
    return tmp_path


@pytest.fixture
def solo12(folder):
    """A design for a copy of Solo12 that tests may harm, in the working directory."""
    shutil.copy(SOLO12, "solo12.urdf")
    return sized("solo12.urdf")
