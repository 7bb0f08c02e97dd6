"""Findings about packages: present, in an allowed version, and importable."""

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


@pytest.fixture(scope="module")
def findings(tmp_path_factory):
    """Findings about a made-up distribution, one package of which cannot be imported."""
    folder = tmp_path_factory.mktemp("trial")
    broken = "Metadata-Version: 2.4\nName: broken-one\nVersion: 3\n"
    for name, text in (("ocs_trial", METADATA), ("broken_one", broken)):
        (folder / f"{name}-1.0.dist-info").mkdir()
        (folder / f"{name}-1.0.dist-info" / "METADATA").write_text(text)
    (folder / "broken_one.py").write_text("raise RuntimeError('no luck\\ntoday')")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder)
        patch.setenv("PYTHONPATH", str(folder))
        patch.setattr(doctor, "DISTRIBUTION", "ocs-trial")
        return {
            finding.name: finding for finding in package_findings(doctor.package_requirements())
        }


def test_packages_for_developers_are_left_out(findings):
    assert set(findings) == {"rich", "typer", "broken-one", "no-such-package", "film-maker"}


@pytest.mark.parametrize(
    ("name", "state", "cure", "reason", "in_the_way"),
    [
        ("rich", State.WORKS, "", "", False),
        ("typer", State.UNFIT, "pip install 'typer>=99'", "", True),
        ("no-such-package", State.MISSING, "pip install 'no-such-package<2'", "", True),
        (
            "broken-one",
            State.BROKEN,
            "pip install --force-reinstall 'broken-one'",
            "RuntimeError: no luck",
            True,
        ),
        ("film-maker", State.MISSING, "pip install 'ocs-trial[film]'", "", False),
    ],
)
def test_the_finding_about_a_package(findings, name, state, cure, reason, in_the_way):
    """Packages of an extra are not required, and their cure names the extra."""
    package = findings[name]
    assert (package.state, package.cure, package.reason) == (state, cure, reason)
    assert package.is_blocking is in_the_way


def test_a_module_that_ends_the_process_is_reported(tmp_path, monkeypatch):
    (tmp_path / "deadly.py").write_text("import os\nprint('[not ours', flush=True)\nos._exit(7)")
    (tmp_path / "quiet.py").write_text("print('hello')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    failures = import_failures(["quiet", "deadly", "json"])
    assert failures == dict.fromkeys(("deadly", "json"), "the process ended with code 7")


def test_a_module_that_hangs_is_reported(tmp_path, monkeypatch):
    (tmp_path / "slow_one.py").write_text("import time\ntime.sleep(60)")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(doctor, "TIME_LIMIT", 1.0)
    assert import_failures(["json", "slow_one"]) == {"slow_one": "not done within 1 s"}


def test_every_user_package_has_a_purpose():
    lines = [*PROJECT["dependencies"]]
    for extra, requirements in PROJECT["optional-dependencies"].items():
        lines += [] if extra in DEVELOPMENT else requirements
    assert set(PURPOSES) == {Requirement(line).name for line in lines}
