"""Consoles of any width, with or without colour; only answers go to standard output.

Progress, warnings and errors go to standard error, so that an answer can be stored or searched. In
a pipe no line is broken, and there are no plots or frames, so that `grep` finds whole facts.
"""

import os
import re
import sys
import time
import webbrowser
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import timedelta
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TypeAlias

from rich.console import Console, ConsoleOptions, ConsoleRenderable, RenderHook, RenderResult
from rich.measure import Measurement
from rich.panel import Panel
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    SpinnerColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
)
from rich.segment import Segment
from rich.text import Text

NARROWEST = 60
WIDEST = 110
PIPE_WIDTH = 10_000
"""Columns of a pipe, whose reader breaks lines itself; the variable COLUMNS overrides it."""

_TRAILING_SPACES = re.compile("(?<! ) +(?=\n)")
"""Trailing spaces; without the lookbehind each of a pipe's 10,000 would be tried as the first."""

_CONTROL_CHARACTERS = [
    *range(0x20),
    *range(0x7F, 0xA0),
    *range(0x202A, 0x202F),
    *range(0x2066, 0x206A),
]
_REPLACEMENTS = {
    code: "\ufffd" for code in (*_CONTROL_CHARACTERS, 0x2028, 0x2029) if chr(code) not in "\n\t"
}
"""Control characters (ECMA-48) and direction overrides (Unicode), and their replacement.

They could come in with names from robot files, catalogues and `design.json`.
"""


def open_page(console: Console, file: Path) -> None:
    """Open a page in the browser, or print its path if there is no screen or no browser."""
    # Without a screen Python would start a text browser in the terminal.
    has_screen = not sys.platform.startswith("linux") or any(map(os.environ.get, _SCREEN_VARIABLES))
    if not (has_screen and webbrowser.open(file.resolve().as_uri())):
        console.print(f"no browser to open {file.resolve()}", soft_wrap=True)


_SCREEN_VARIABLES = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
"""Variables of which at least one is set if a browser can be opened."""


def without_control_characters(text: str) -> str:
    """The text with each control character replaced, except tabs and line ends."""
    return text.translate(_REPLACEMENTS)


class CleaningHook(RenderHook):
    """Removes control characters from whatever a console prints, except its own colours."""

    def process_renderables(self, renderables: list[ConsoleRenderable]) -> list[ConsoleRenderable]:
        """Called by rich before it prints."""
        return [_Cleaned(renderable) for renderable in renderables]


class _Cleaned:
    """A renderable without control characters and trailing spaces in its texts."""

    def __init__(self, inner: ConsoleRenderable) -> None:
        self._inner = inner

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        pending = ""
        for segment in console.render(self._inner, options):
            if segment.control:
                yield segment
                continue
            # Spaces are printed only when something follows them on their line.
            text = _TRAILING_SPACES.sub("", pending + without_control_characters(segment.text))
            stripped = text.rstrip(" ")
            pending = text[len(stripped) :]
            yield Segment(stripped, segment.style)
        yield Segment(pending)

    def __rich_measure__(self, console: Console, options: ConsoleOptions) -> Measurement:
        return Measurement.get(console, options, self._inner)


def make_console(*, color: bool = True, stderr: bool = False) -> Console:
    """A console on standard output; without colour there is no bold or dim text either.

    In a pipe its lines are not broken, unless the variable COLUMNS sets a width. With `stderr`, it
    is on standard error, for progress, warnings and errors.
    """
    plain = not color or bool(os.environ.get("NO_COLOR"))
    console = Console(stderr=stderr, color_system=None if plain else "auto", highlight=False)
    if console.is_terminal or "COLUMNS" in os.environ:
        console.width = min(max(console.width, NARROWEST), WIDEST)
    else:
        console.width = PIPE_WIDTH
    console.push_render_hook(CleaningHook())
    return console


def breaks_lines(console: Console) -> bool:
    """Whether a person reads the console, and not `grep`: only then it gets plots and frames."""
    return console.width <= WIDEST


def error_panel(lines: Sequence[str], hint: str, *, color: bool = True) -> None:
    """Print an error and its remedy: one panel, in a pipe plain lines."""
    console = make_console(color=color, stderr=True)
    if not breaks_lines(console):
        console.print(Text("\n".join(filter(None, ["error: " + lines[0], *lines[1:], hint]))))
        return
    message = Text("\n".join(lines))
    if hint:
        message.append("\n\n" + hint, style="bold")
    console.print(Panel(message, title="error", title_align="left", border_style="red"))


class Steps:
    """Progress of a command: each step is shown while it runs and kept with its time when done.

    On a terminal a spinner or bar moves; in a pipe each finished step is one plain line.
    """

    _all_warnings = ": `ocs-design inspect`"

    def __init__(self, console: Console | None = None, *, quiet: bool = False) -> None:
        """Progress on a console; None: nothing is printed."""
        self._console = console or make_console(stderr=True)
        self._quiet = quiet or console is None

    @classmethod
    def of(cls, progress: "Steps | ProgressCallback | None") -> "Steps":
        """Progress reported to a function if given, in a notebook below the cell, else nowhere."""
        if isinstance(progress, Steps):
            return progress
        if progress is not None:
            return _CallbackSteps(progress)
        # Only a notebook has a kernel; IPython on a terminal has none.
        shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
        return cls() if getattr(shell, "kernel", None) is None else _NotebookSteps()

    @contextmanager
    def step(self, label: str) -> Iterator["RunningStep"]:
        """One step; `RunningStep.update` moves its bar."""
        start = time.perf_counter()
        with self._running(label) as running:
            yield running
        note = f"  {running.note}" if running.note else ""
        seconds = f"{time.perf_counter() - start:6.2f} s"
        self._print_line(Text.assemble((seconds, "dim"), f"  {label}{note}"))

    def warn(self, warnings: Sequence[str]) -> None:
        """Report warnings about the input before work on it starts."""
        for warning in warnings[:WARNINGS_SHOWN]:
            self._print_line(Text(f" warning  {warning}", style="yellow"))
        if len(warnings) > WARNINGS_SHOWN:
            self._print_line(
                Text(f"          {len(warnings) - WARNINGS_SHOWN} more{self._all_warnings}")
            )

    @contextmanager
    def _running(self, label: str) -> Iterator["RunningStep"]:
        """Show a step while it runs."""
        if self._quiet or not self._console.is_terminal:
            yield RunningStep()
            return
        wide = self._console.width >= _WIDE_TERMINAL
        with Progress(
            SpinnerColumn(),
            TextColumn("{task.description}", markup=False),
            BarColumn(bar_width=24 if wide else 8),
            TimeElapsedColumn(),
            *([_RemainingTime()] if wide else []),
            console=self._console,
            transient=True,
        ) as progress:
            yield RunningStep(
                partial(progress.update, progress.add_task(label, total=None), total=1.0)
            )

    def _print_line(self, line: Text) -> None:
        """Print a line that is kept."""
        if not self._quiet:
            self._console.print(line, soft_wrap=True)


_WIDE_TERMINAL = 80
"""Number of columns from which there is room for the remaining time."""

WARNINGS_SHOWN = 3
"""Number of warnings shown before the search; `inspect` shows all."""


class RunningStep:
    """Handle of a running step. `note` is appended to its line when it is done."""

    def __init__(self, move: Callable[..., None] | None = None) -> None:
        self.note = ""
        self._move = move

    def update(self, fraction: float) -> None:
        """Move the bar to `fraction` of the step."""
        if self._move is not None:
            self._move(completed=fraction)


ProgressCallback: TypeAlias = Callable[[str, float], None]
"""Callback that receives the running step and the fraction of it that is done, 0..1."""


class _CallbackSteps(Steps):
    """Progress reported to a callback."""

    def __init__(self, callback: ProgressCallback) -> None:
        super().__init__()
        self._callback = callback

    @contextmanager
    def _running(self, label: str) -> Iterator[RunningStep]:
        """Report a step at its start, as it advances, and at its end."""
        self._callback(label, 0.0)
        yield RunningStep(lambda completed: self._callback(label, completed))
        self._callback(label, 1.0)


class _NotebookSteps(Steps):
    """Progress below a notebook's cell: a line for each step, a bar for the one that runs."""

    _all_warnings = " in `robot.warnings`"

    def __init__(self) -> None:
        super().__init__()
        self._lines: list[str] = []
        self._shown_at = 0.0
        display = import_module("IPython.display").display
        self._handle = display({"text/plain": ""}, raw=True, display_id=True)

    @contextmanager
    def _running(self, label: str) -> Iterator[RunningStep]:
        """A bar that moves twice a second at most."""
        start = time.perf_counter()

        def move(completed: float) -> None:
            now = time.perf_counter()
            if now - self._shown_at > NOTEBOOK_INTERVAL:
                self._shown_at = now
                self._show(f"{now - start:6.2f} s  {label}  {'█' * round(24 * completed):<24}")

        self._show(f"           {label} ...")
        yield RunningStep(move)

    def _print_line(self, line: Text) -> None:
        self._lines.append(line.plain)
        self._show()

    def _show(self, *running: str) -> None:
        self._handle.update(
            {"text/plain": without_control_characters("\n".join([*self._lines, *running]))},
            raw=True,
        )


NOTEBOOK_INTERVAL = 0.5
"""Minimum time between updates of a bar in a notebook, each a message to the browser [s]."""


class _RemainingTime(ProgressColumn):
    """Column with the remaining time, once the progress of a step is known."""

    def render(self, task: Task) -> Text:
        """Remaining time of one step; empty while it is not known."""
        remaining = task.time_remaining
        is_known = remaining is not None and not task.finished
        text = f"{timedelta(seconds=int(remaining or 0))} left" if is_known else ""
        return Text(text, style="dim")
