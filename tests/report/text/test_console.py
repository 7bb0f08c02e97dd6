"""Terminal output: no control characters from input, and the progress of steps."""

import io
import time

import pytest
from rich.console import Console
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from ocs_design.report.text.console import CleaningHook, Steps, without_control_characters

HOSTILE = "a\x1b[31mb\x9b2Jc\x07d\u202ee\x7f\x85[bold]f[/nope]"


def printed(renderable, **options):
    stream = io.StringIO()
    console = Console(file=stream, width=80, **options)
    console.push_render_hook(CleaningHook())
    console.print(renderable)
    return stream.getvalue()


def table(text):
    grid = Table.grid()
    grid.add_row(Text(text))
    return grid


@pytest.mark.parametrize("make", [Text, lambda text: Panel(Text(text)), table])
def test_control_characters_are_replaced(make):
    output = printed(make(HOSTILE))
    assert not set(output) & set("\x1b\x9b\x07\u202e\x7f\x85")
    assert "[bold]f[/nope]" in output


def test_own_colours_are_kept():
    assert "\x1b[31m" in printed(
        Text("a", style="red"), force_terminal=True, color_system="standard"
    )


def test_line_breaks_and_all_scripts_are_kept():
    assert without_control_characters("Größe\tभाषा\n日本 🤖") == "Größe\tभाषा\n日本 🤖"


def test_markup_in_a_step_is_not_interpreted():
    stream = io.StringIO()
    with Steps(Console(file=stream, width=80)).step("read") as step:
        step.note = "[/nope]"
    assert "[/nope]" in stream.getvalue()


def step_output(fractions):
    """Terminal output of a step that reports these fractions."""
    screen = io.StringIO()
    console = Console(file=screen, force_terminal=True, width=100, color_system=None)
    with Steps(console).step("look around") as step:
        for fraction in fractions:
            step.update(fraction)
            time.sleep(0.15)
        time.sleep(0.0 if fractions else 0.15)
    return screen.getvalue()


@pytest.mark.parametrize(
    ("fractions", "shows_remaining"),
    [([], False), ([0.01, 0.02, 0.03, 0.04], True), ([0.5, 1.0], None)],
)
def test_steps_show_the_remaining_time_where_known_and_end_with_their_duration(
    fractions, shows_remaining
):
    """The elapsed time is shown too, so the remaining time has to be marked."""
    screen = step_output(fractions)
    assert "0:00:00" in screen
    assert shows_remaining is None or (" left" in screen) is shows_remaining
    last = screen.rstrip().splitlines()[-1]
    assert last.split()[-2:] == ["look", "around"]
    assert " s " in last
