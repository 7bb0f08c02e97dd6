"""The progress of a step on a terminal, as far as it is known."""

import io
import time

import pytest
from rich.console import Console

from ocs_design.report.console import Steps


def shown(fractions):
    """All that a terminal got of a step that told these fractions."""
    screen = io.StringIO()
    console = Console(file=screen, force_terminal=True, width=100, color_system=None)
    with Steps(console).step("look around") as step:
        for fraction in fractions:
            step.update(fraction)
            time.sleep(0.15)
        time.sleep(0.0 if fractions else 0.15)
    return screen.getvalue()


def test_nothing_is_said_to_be_left_of_a_step_that_does_not_know():
    """Its time so far is there, and could be taken for what is left."""
    assert "0:00:00" in shown([])
    assert " left" not in shown([])


def test_what_is_left_is_told_where_it_is_known():
    assert " left" in shown([0.01, 0.02, 0.03, 0.04])


@pytest.mark.parametrize("fractions", [[], [0.5, 1.0]])
def test_the_step_is_kept_with_its_time(fractions):
    last = shown(fractions).rstrip().splitlines()[-1]
    assert last.split()[-2:] == ["look", "around"]
    assert " s " in last
