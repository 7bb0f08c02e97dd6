"""What reaches a terminal: no control characters of strangers, and the progress of steps."""

import io
import time

import pytest
from rich.console import Console
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from ocs_design.report.text.console import CleaningHook, Steps, without_control_characters

EVIL = "a\x1b[31mb\x9b2Jc\x07d\u202ee\x7f\x85[bold]f[/nope]"


def printed(what, **options):
    stream = io.StringIO()
    console = Console(file=stream, width=80, **options)
    console.push_render_hook(CleaningHook())
    console.print(what)
    return stream.getvalue()


def table(text):
    grid = Table.grid()
    grid.add_row(Text(text))
    return grid


@pytest.mark.parametrize("make", [Text, lambda text: Panel(Text(text)), table])
def test_nothing_but_marks_is_left_of_control_characters(make):
    shown = printed(make(EVIL))
    assert not set(shown) & set("\x1b\x9b\x07\u202e\x7f\x85")
    assert "[bold]f[/nope]" in shown


def test_colours_of_our_own_are_kept():
    assert "\x1b[31m" in printed(
        Text("a", style="red"), force_terminal=True, color_system="standard"
    )


def test_lines_and_letters_of_any_language_stay():
    assert without_control_characters("Größe\tभाषा\n日本 🤖") == "Größe\tभाषा\n日本 🤖"


def test_a_step_is_shown_as_it_is_named():
    stream = io.StringIO()
    with Steps(Console(file=stream, width=80)).step("read") as step:
        step.note = "[/nope]"
    assert "[/nope]" in stream.getvalue()


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


@pytest.mark.parametrize(
    ("fractions", "left"), [([], False), ([0.01, 0.02, 0.03, 0.04], True), ([0.5, 1.0], None)]
)
def test_what_is_left_is_told_where_it_is_known_and_a_step_is_kept_with_its_time(fractions, left):
    """The time so far is there too, and could be taken for what is left."""
    screen = shown(fractions)
    assert "0:00:00" in screen
    assert left is None or (" left" in screen) is left
    last = screen.rstrip().splitlines()[-1]
    assert last.split()[-2:] == ["look", "around"]
    assert " s " in last
