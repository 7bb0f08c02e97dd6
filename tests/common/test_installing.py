"""A package is brought by the tool that made the environment."""

import sys

import pytest

from ocs_design.common import errors
from ocs_design.common.errors import extra_command, install_command


@pytest.mark.parametrize(
    ("receipt", "has_pip", "command"),
    [
        ("", True, "pip install 'ocs-design[dxf,step]'"),
        ("pipx_metadata.json", False, "pipx runpip {name} install 'ocs-design[dxf,step]'"),
        ("", False, "uv pip install --python {python} 'ocs-design[dxf,step]'"),
    ],
)
def test_the_command_is_that_of_the_environment(receipt, has_pip, command, tmp_path, monkeypatch):
    if receipt:
        (tmp_path / receipt).touch()
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setattr(errors, "find_spec", lambda name: has_pip or None)
    wanted = command.format(name=tmp_path.name, python=sys.executable)
    assert extra_command("dxf", "step") == wanted


def test_options_stand_before_the_packages():
    assert install_command("a<2", "b", options="-U").endswith("install -U 'a<2' 'b'")
