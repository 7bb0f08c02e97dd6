"""Shells complete commands and options, once asked for."""

import pytest
from commands import environment, run_process


def completed(words):
    """What bash is offered for the last of `words`."""
    asked = environment(
        COMP_WORDS=words,
        COMP_CWORD=str(words.count(" ")),
        _OCS_DESIGN_COMPLETE="complete_bash",
    )
    return run_process(env=asked).stdout.split()


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("ocs-design in", ["inspect", "init"]),
        ("ocs-design size --mo", ["--motor", "--motors-any", "--motors"]),
        ("ocs-design doctor --j", ["--json"]),
    ],
)
def test_bash_completes(words, offered):
    assert completed(words) == offered


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_of_a_shell_is_printed(shell):
    # Typer otherwise looks at which shell called it.
    env = environment(_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION="1")
    done = run_process("--show-completion", shell, env=env)
    assert done.code == 0
    assert "_OCS_DESIGN_COMPLETE=complete_" + shell in done.stdout
