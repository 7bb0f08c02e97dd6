"""Options of the command line as a specification, and the examples of the commands."""

import shlex
from types import SimpleNamespace

import pytest
import typer

from ocs_design.cli.app import EXAMPLES, app
from ocs_design.cli.options import (
    REPLAY_PARAMETERS,
    package_paths_of_command,
    sample_command,
    specified_by_command,
)
from ocs_design.common.errors import UsageError
from ocs_design.requirement.choices import unknown_names


def specified(**parameters):
    return specified_by_command(SimpleNamespace(params={"spec": None, **parameters}))


def test_no_options_give_an_empty_specification():
    specification = specified(robot=None, motor=None, joint=(), co_design=False)
    assert specification.motor.name is None
    assert specification.ocs.co_design is None
    assert specification.robot.joints is None


def test_options_become_keys_of_the_specification():
    specification = specified(
        robot="dog.urdf", motor="none", r_max="40 mm", co_design=True, joint=("knee=90 deg",)
    )
    assert specification.robot.file == "dog.urdf"
    assert specification.motor.name == "none"
    assert specification.flywheel.r_max == pytest.approx(0.04)
    assert specification.ocs.co_design is True
    assert specification.robot.joints == {"knee": pytest.approx(1.5707963267948966)}


def test_zero_is_a_value():
    assert specified(seed=0).validation.seed == 0
    assert specified(seed=None).validation.seed is None


def test_an_empty_robot_is_reported_as_the_argument():
    with pytest.raises(UsageError, match=r"^ROBOT: "):
        specified(robot="")


def test_the_command_for_a_sample_has_all_relevant_options():
    """Once distributions and control law were missing, so that another robot was flown."""
    command = typer.main.get_command(app).commands["validate"]
    arguments = (
        "d.json --samples 6 --seed 3 --reality 'my reality.toml' --spec s.toml --ballistic "
        "--desaturate --survives one --detection 10ms --robot r.urdf --package-path a=/x "
        "--package-path b=/y -o out --force"
    )
    with command.make_context("validate", shlex.split(arguments)) as context:
        repeated_command = shlex.split(sample_command(context, "d.json", 3))[2:]
    with command.make_context("validate", [*repeated_command[:-1], "4"]) as repeated:
        assert repeated.params["sample"] == 4
        for name in ("design", "seed", *REPLAY_PARAMETERS):
            assert repeated.params[name] == context.params[name], name


def test_options_that_switch_off_are_false():
    assert specified(no_validate=True).validation.enabled is False
    assert specified(no_validate=False).validation.enabled is None
    assert specified(video=True).validation.video is True
    assert specified(video=False).validation.video is None


def test_options_override_the_file(tmp_path):
    file = tmp_path / "spec.toml"
    file.write_text('[motor]\nname = "MN4010 KV580"\nbus_voltage = "48 V"\n')
    specification = specified(spec=str(file), motor="none")
    assert (specification.motor.name, specification.supply.voltage) == ("none", 48.0)


def package_paths(*texts):
    return package_paths_of_command(SimpleNamespace(params={"package_path": texts}))


def test_package_paths_are_pairs(tmp_path):
    assert package_paths() == {}
    (tmp_path / "with=sign").mkdir()
    paths = package_paths(f"a={tmp_path}", f"b={tmp_path}/with=sign")
    assert paths == {"a": tmp_path, "b": tmp_path / "with=sign"}


@pytest.mark.parametrize("text", ["alone", "=folder", "name="])
def test_incomplete_package_paths_are_refused(text):
    with pytest.raises(UsageError, match="expected NAME=DIR"):
        package_paths(text)


COMMAND_GROUP = typer.main.get_command(app)


@pytest.mark.parametrize("line", [line for lines in EXAMPLES.values() for line in lines])
def test_an_example_is_parsed(line):
    program, name, *arguments = shlex.split(line)
    assert program == "ocs-design"
    assert line in EXAMPLES[name]
    outer = COMMAND_GROUP.make_context("ocs-design", [name, *arguments])
    context = COMMAND_GROUP.commands[name].make_context(name, arguments, parent=outer)
    if "spec" in context.params and "design" not in context.params:
        assert list(unknown_names(specified_by_command(context))) == []


def test_every_command_has_examples_in_its_help():
    assert set(EXAMPLES) == set(COMMAND_GROUP.commands)
    for name, command in COMMAND_GROUP.commands.items():
        context = command.context_class(command, info_name=name, max_content_width=80)
        assert all(f"\n    {line}\n" in command.get_help(context) + "\n" for line in EXAMPLES[name])


@pytest.mark.parametrize("option", ["-h", "--help"])
def test_help_has_two_options(option, capsys):
    for arguments in ([option], ["size", option]):
        assert COMMAND_GROUP.main(arguments, prog_name="ocs-design", standalone_mode=False) == 0
        assert "-h, --help" in capsys.readouterr().out
