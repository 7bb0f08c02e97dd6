"""The products of `size`, made once for all tests that open them."""

import fcntl
import json
import shutil
import sys
from dataclasses import asdict
from pathlib import Path

import pytest
from commands import (
    BOUND,
    BY_HAND,
    DROP,
    SOLO12,
    Result,
    environment,
    run,
    run_measured,
    size_to_bound,
)
from exported import pinocchio_model
from products import CASES, Product, device_of


@pytest.fixture(scope="session", params=CASES)
def product(request, tmp_path_factory, worker_id):
    """A product of a new process with piped streams, made once for all workers."""
    case, base = CASES[request.param], tmp_path_factory.getbasetemp()
    shared = (base if worker_id == "master" else base.parent) / request.param.replace(" ", "-")
    parent, result_file = shared / "cold", shared / "result.json"
    parent.mkdir(parents=True, exist_ok=True)
    with (shared / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not result_file.exists():
            result, peak = run_measured(
                "size", SOLO12, *case.options, cwd=parent, env=environment(COLUMNS="80")
            )
            result_file.write_text(json.dumps([asdict(result), peak]))
    result, peak = json.loads(result_file.read_text())
    return Product(case, Result(**result), parent / "solo12-ocs", peak)


@pytest.fixture(scope="session")
def document(product):
    return json.loads((product.folder / "design.json").read_text())


@pytest.fixture(scope="session")
def device(document):
    return device_of(document)


@pytest.fixture(scope="session")
def exported(product):
    return pinocchio_model((product.folder / "robot" / "solo12_ocs.urdf").read_text())


@pytest.fixture(scope="session", autouse=True)
def single_process():
    """Keep commands to one process, since tests run on all processors already."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ocs_design.common.workers.processors", lambda: 1)
        yield


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty working folder, where xacro is not installed."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "xacro", None)
    return tmp_path


@pytest.fixture(scope="session")
def by_hand(tmp_path_factory):
    """The design that is quickest to simulate: a trunk, two wheels and no legs, one drop."""
    folder = tmp_path_factory.mktemp("by_hand")
    (folder / "drop.toml").write_text(DROP)
    command = ("size", *BY_HAND, *BOUND, "--spec", folder / "drop.toml", "-q", "-o", folder / "ocs")
    assert run(*command).code == 0
    return folder / "ocs"


@pytest.fixture(scope="session")
def sized_solo12(tmp_path_factory):
    """A folder with a copy of Solo12's file and the design for it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("sized"))
        patch.setitem(sys.modules, "xacro", None)
        shutil.copy(SOLO12, "solo12.urdf")
        return size_to_bound("solo12.urdf").absolute().parent


@pytest.fixture
def solo12(sized_solo12, folder):
    """A design for a copy of Solo12 in the working folder, both free to be modified."""
    shutil.copytree(sized_solo12, folder, dirs_exist_ok=True)
    return Path("ocs")
