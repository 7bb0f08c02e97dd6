"""Packages that are asked for are found, in a version that is allowed, and can be imported."""

import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from ocs_design.device.findings import State
from ocs_design.workflows import doctor
from ocs_design.workflows.doctor import DEVELOPMENT, PURPOSES, import_failures, package_findings

PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]

METADATA = """\
Metadata-Version: 2.4
Name: ocs-trial
Version: 1.0
Requires-Python: >=3.11
Provides-Extra: film
Provides-Extra: dev
Requires-Dist: rich>=13
Requires-Dist: typer>=99
Requires-Dist: broken-one
Requires-Dist: no-such-package<2
Requires-Dist: film-maker>=1; extra == "film"
Requires-Dist: pytest; extra == "dev"
"""


@pytest.fixture
def trial(tmp_path, monkeypatch):
    """A distribution of our own making, and a package of its that cannot be imported."""
    add_distribution(tmp_path, "ocs-trial", METADATA)
    add_distribution(
        tmp_path, "broken-one", "Metadata-Version: 2.4\nName: broken-one\nVersion: 3\n"
    )
    (tmp_path / "broken_one.py").write_text("raise RuntimeError('no luck\\ntoday')")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(doctor, "DISTRIBUTION", "ocs-trial")


def add_distribution(folder, name, text):
    info = folder / f"{name.replace('-', '_')}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(text)


@pytest.fixture
def found(trial):
    return {each.name: each for each in package_findings(doctor.wanted_packages())}


def test_those_for_developers_are_left_out(found):
    assert set(found) == {"rich", "typer", "broken-one", "no-such-package", "film-maker"}


def test_what_works(found):
    assert found["rich"].state is State.WORKS
    assert (found["rich"].cure, found["rich"].reason) == ("", "")


def test_a_version_that_is_not_allowed(found):
    assert found["typer"].state is State.UNFIT
    assert found["typer"].cure == "pip install 'typer>=99'"
    assert found["typer"].stands_in_the_way


def test_what_is_not_installed(found):
    assert found["no-such-package"].state is State.MISSING
    assert found["no-such-package"].cure == "pip install 'no-such-package<2'"


def test_what_cannot_be_imported_says_why(found):
    assert found["broken-one"].state is State.BROKEN
    assert found["broken-one"].reason == "RuntimeError: no luck"
    assert found["broken-one"].cure == "pip install --force-reinstall 'broken-one'"


def test_an_extra_is_not_required_and_its_cure_names_it(found):
    extra = found["film-maker"]
    assert not extra.stands_in_the_way
    assert extra.cure == "pip install 'ocs-trial[film]'"


def test_a_module_that_ends_the_process_is_only_told(tmp_path, monkeypatch):
    (tmp_path / "deadly.py").write_text("import os\nprint('[not ours', flush=True)\nos._exit(7)")
    (tmp_path / "quiet.py").write_text("print('hello')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    failures = import_failures(["quiet", "deadly", "json"])
    assert failures == dict.fromkeys(("deadly", "json"), "the process ended with code 7")


def test_a_module_that_hangs_is_only_told(tmp_path, monkeypatch):
    (tmp_path / "slow_one.py").write_text("import time\ntime.sleep(60)")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(doctor, "TIME_LIMIT", 1.0)
    assert import_failures(["json", "slow_one"]) == {"slow_one": "not done within 1 s"}


def test_every_package_that_users_may_want_has_its_purpose():
    lines = [*PROJECT["dependencies"]]
    for extra, requirements in PROJECT["optional-dependencies"].items():
        lines += [] if extra in DEVELOPMENT else requirements
    assert set(PURPOSES) == {Requirement(line).name for line in lines}
