"""Examples of the help are command lines that the program takes."""

import shlex

import pytest
import typer

from ocs_design.cli.app import EXAMPLES, app
from ocs_design.cli.options import specified_by_command
from ocs_design.requirement.choices import unknown_names

GROUP = typer.main.get_command(app)


@pytest.mark.parametrize("line", [line for lines in EXAMPLES.values() for line in lines])
def test_an_example_is_parsed(line):
    program, name, *arguments = shlex.split(line)
    assert program == "ocs-design"
    assert line in EXAMPLES[name]
    outer = GROUP.make_context("ocs-design", [name, *arguments])
    context = GROUP.commands[name].make_context(name, arguments, parent=outer)
    if "spec" in context.params and "design" not in context.params:
        assert list(unknown_names(specified_by_command(context))) == []


def test_every_command_has_examples_in_its_help_that_no_terminal_breaks():
    assert set(EXAMPLES) == set(GROUP.commands)
    for name, command in GROUP.commands.items():
        context = command.context_class(command, info_name=name, max_content_width=80)
        assert all(f"\n    {line}\n" in command.get_help(context) + "\n" for line in EXAMPLES[name])


@pytest.mark.parametrize("option", ["-h", "--help"])
def test_help_is_asked_for_in_two_ways(option, capsys):
    for arguments in ([option], ["size", option]):
        assert GROUP.main(arguments, prog_name="ocs-design", standalone_mode=False) == 0
        assert "-h, --help" in capsys.readouterr().out
