"""The built wheel has all files that the package reads, and requires only what it needs."""

import os
import subprocess
import sys
import zipfile
from email.parser import HeaderParser
from pathlib import Path

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]
MOVED = {
    "examples/solo12.urdf": "ocs_design/examples/solo12.urdf",
    **{
        str(path.relative_to(ROOT)): f"ocs_design/{path.relative_to(ROOT)}"
        for path in (ROOT / "templates").rglob("*")
        if path.is_file()
    },
}
"""Files that have another place in the wheel than in the sources."""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    pytest.importorskip("hatchling", reason="hatchling builds it")
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (built,) = folder.iterdir()
    assert built.name.endswith("-py3-none-any.whl")
    with zipfile.ZipFile(built) as content:
        content.extractall(folder / "installed")
    return folder / "installed"


def test_wheel_has_exactly_the_files_of_the_package(wheel):
    package = {
        str(path.relative_to(ROOT))
        for path in (ROOT / "ocs_design").rglob("*")
        if path.is_file() and path.suffix != ".pyc"
    }
    packed = {str(path.relative_to(wheel)) for path in wheel.rglob("*") if path.is_file()}
    assert {name for name in packed if ".dist-info/" not in name} == package | set(MOVED.values())
    for source, name in MOVED.items():
        assert (wheel / name).read_bytes() == (ROOT / source).read_bytes()


def test_installed_package_reads_its_own_files(wheel):
    """And not those of the checkout that it was built from."""
    code = (
        "from ocs_design.export.templates import template_file as t; "
        "from ocs_design.common.files import packaged_folder as p; "
        "print(t('any').parent, p('examples'))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONPATH": str(wheel)},
        cwd=wheel,
        check=True,
        capture_output=True,
        text=True,
    )
    inside = wheel / "ocs_design"
    assert done.stdout.split() == [str(inside / "templates"), str(inside / "examples")]


def test_wheel_requires_what_a_default_design_needs(wheel):
    (metadata,) = wheel.glob("*.dist-info/METADATA")
    lines = HeaderParser().parsestr(metadata.read_text()).get_all("Requires-Dist")
    required = {each.name for each in map(Requirement, lines) if each.marker is None}
    assert {"mujoco", "casadi", "reportlab"} <= required
    assert required.isdisjoint({"cvxpy", "ezdxf", "cadquery-ocp-novtk", "matplotlib", "pytest"})
