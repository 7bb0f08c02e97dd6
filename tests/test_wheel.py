"""The wheel that is built has all that the program reads, and asks only for what it needs."""

import os
import subprocess
import sys
import zipfile
from email.parser import HeaderParser
from pathlib import Path

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]
OUTSIDE = {
    "examples/solo12.urdf": "ocs_design/examples/solo12.urdf",
    **{
        str(path.relative_to(ROOT)): f"ocs_design/{path.relative_to(ROOT)}"
        for path in (ROOT / "templates").rglob("*")
        if path.is_file()
    },
}
"""Files that lie elsewhere in the wheel than in the sources."""


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


def test_every_file_is_in_it_and_none_besides(wheel):
    package = {
        str(path.relative_to(ROOT))
        for path in (ROOT / "ocs_design").rglob("*")
        if path.is_file() and path.suffix != ".pyc"
    }
    held = {str(path.relative_to(wheel)) for path in wheel.rglob("*") if path.is_file()}
    assert {name for name in held if ".dist-info/" not in name} == package | set(OUTSIDE.values())
    for source, name in OUTSIDE.items():
        assert (wheel / name).read_bytes() == (ROOT / source).read_bytes()


def test_what_is_read_is_read_from_it(wheel):
    """Not from the checkout that it was built in."""
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


def test_it_asks_for_what_a_default_design_needs(wheel):
    (metadata,) = wheel.glob("*.dist-info/METADATA")
    asked = HeaderParser().parsestr(metadata.read_text()).get_all("Requires-Dist")
    required = {each.name for each in map(Requirement, asked) if each.marker is None}
    assert {"mujoco", "casadi", "reportlab"} <= required
    assert required.isdisjoint({"cvxpy", "ezdxf", "cadquery-ocp-novtk", "matplotlib", "pytest"})
