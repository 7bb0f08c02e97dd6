"""Shells complete commands, options and values."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from commands import ROOT, environment, run_process
from scripts import modules_loaded_by
from typer.testing import CliRunner

from ocs_design.cli.app import app
from ocs_design.cli.completion import PAPER_MANEUVERS
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.sweep import sweep_of
from ocs_design.requirement.vocabulary import CRITERIA, GUARDS
from ocs_design.robot.manual import robot_by_hand


def completions(words):
    """Words that bash is offered for the last of `words`."""
    place = {"COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    result = CliRunner().invoke(app, env={**place, "_OCS_DESIGN_COMPLETE": "complete_bash"})
    return result.stdout.split()


SWEEPS = ["time", "angle", "radius", "height", "voltage"]


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("ocs-design in", ["inspect", "init"]),
        ("ocs-design size --mo", ["--motor", "--motors-any", "--motors"]),
        ("ocs-design doctor --j", ["--json"]),
        ("ocs-design size --motor MN4012-KV4", ["MN4012-KV400", "MN4012-KV480"]),
        ("ocs-design size --material t", ["titanium-6al-4v", "tungsten-alloy-class-4"]),
        ("ocs-design size --gear GP-16", ["GP-16-A-4.4"]),
        ("ocs-design size --guard ", list(GUARDS)),
        ("ocs-design size --alpha-criterion ", list(CRITERIA)),
        ("ocs-design size --gravity m", ["moon", "mars"]),
        ("ocs-design export x --formats stl,dr", ["stl,drawing"]),
        ("ocs-design pareto --against ", SWEEPS),
        ("ocs-design pareto --maneuver ", list(PAPER_MANEUVERS)),
        ("ocs-design pareto --spec examples/solo12.toml --maneuver ba", ["back-flip"]),
        ("ocs-design catalogue ", ["motors", "gears", "materials"]),
        ("ocs-design size examples/s", ["examples/solo12.urdf"]),
        ("ocs-design size --spec examples/b", ["examples/by_hand.toml"]),
    ],
)
def test_bash_completes(words, offered, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert completions(words) == offered


def test_a_folder_is_completed_to_the_files_in_it(tmp_path, monkeypatch):
    """Bash would take a folder alone for the complete word."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robots" / "dog").mkdir(parents=True)
    for name in ("dog.urdf", "dog.xml.gz", "dog.txt"):
        (tmp_path / "robots" / "dog" / name).touch()
    assert completions("ocs-design size ro") == ["robots/dog/dog.urdf", "robots/dog/dog.xml.gz"]
    (tmp_path / "robots" / "cat and mouse").mkdir()
    # Names with spaces are left to the shell, which quotes them.
    assert completions("ocs-design size robots/") == []


def test_completed_words_are_accepted():
    solo12 = robot_by_hand(2.5, (0.032, 0.055, 0.07))
    assert tuple(maneuver.name for maneuver in default_maneuvers(solo12)) == PAPER_MANEUVERS
    for name in SWEEPS:
        sweep_of(name, "")


def test_completion_imports_neither_solver_nor_simulator():
    names = "motors, gears, materials, formats"
    loaded = modules_loaded_by(
        f"from ocs_design.cli import app, completion as c; "
        f"[list(getattr(c, name)()) for name in '{names}'.split(', ')]; c.of_key('ocs.guard')('')"
    )
    assert loaded.isdisjoint({"scipy", "mujoco", "cvxpy", "trimesh", "casadi"})


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_the_script_completes_in_bash(tmp_path):
    """The function of the installed script is called as bash does."""
    program = tmp_path / "ocs-design"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m ocs_design "$@"\n')
    program.chmod(0o755)
    env = environment(_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION="1")
    script = run_process("--show-completion", "bash", env=env).stdout
    commands = (
        "COMP_WORDS=(ocs-design size --motor EC-90); COMP_CWORD=3; _ocs_design_completion "
        'ocs-design; printf "%s\\n" "${COMPREPLY[@]}"'
    )
    path = {**env, "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}"}
    path["PYTHONPATH"] = str(Path(__file__).parents[2])
    process = subprocess.run(
        ["bash", "--norc", "-c", f"{script}\n{commands}"],
        env=path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert process.stdout.split() == ["EC-90-flat-90-W-244879", "EC-90-flat-90-W-323772"]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_of_a_shell_is_printed(shell, monkeypatch):
    # Otherwise Typer detects the calling shell.
    monkeypatch.setenv("_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION", "1")
    result = CliRunner().invoke(app, ["--show-completion", shell])
    assert result.exit_code == 0
    assert f"_OCS_DESIGN_COMPLETE=complete_{shell}" in result.stdout
