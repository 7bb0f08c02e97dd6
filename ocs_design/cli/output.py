"""Output of a command: one JSON document, or text, with progress and warnings on the side."""

import functools
import inspect
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NoReturn, TypeVar

import typer

from ocs_design.cli import options as opt

if TYPE_CHECKING:
    from rich.console import Console

    from ocs_design.device.answers import Validated
    from ocs_design.device.records.design import OcsDesign
    from ocs_design.report.text.console import Steps

Answer = TypeVar("Answer")


@dataclass(frozen=True)
class Output:
    """Settings of a command's output, and the consoles to which it goes.

    Attributes:
        as_json, quiet, no_color: form of the output.
        force: replace existing files. strict: warnings are errors.
    """

    as_json: bool = False
    no_color: bool = False
    quiet: bool = False
    force: bool = False
    strict: bool = False

    @cached_property
    def console(self) -> "Console":
        """Console on standard output, for answers."""
        return self._console(stderr=False)

    @cached_property
    def stderr_console(self) -> "Console":
        """Console on standard error, for progress and warnings."""
        return self._console(stderr=True)

    @cached_property
    def steps(self) -> "Steps":
        """Progress of the command."""
        from ocs_design.report.text.console import Steps

        return Steps(self.stderr_console, quiet=self.quiet or self.as_json)

    def give(
        self,
        answer: Answer,
        show: "Callable[[Console, Answer], None]",
        warnings: Iterable[str] = (),
    ) -> None:
        """Print an answer as JSON, or show it after its warnings.

        Args:
            answer: a record. show: prints it. warnings: one sentence each.
        """
        if self.as_json:
            from ocs_design.common.files import to_json

            sys.stdout.buffer.write(to_json(answer))
        elif not self.quiet:
            from ocs_design.report.text.layout import warn

            warn(self.stderr_console, warnings)
            show(self.console, answer)

    def end(self, exit_code: int, judged: "OcsDesign | Validated") -> NoReturn:
        """End with an exit code; a failure that is not yet reported gets one line of verdict."""
        if exit_code and self.quiet and not self.as_json:
            from ocs_design.report.verdict import headline

            self.stderr_console.print(headline(judged).with_finding, markup=False, soft_wrap=True)
        raise typer.Exit(exit_code)

    def _console(self, *, stderr: bool) -> "Console":
        from ocs_design.report.text.console import make_console

        return make_console(color=not self.no_color, stderr=stderr)


OUTPUT_OPTIONS: Mapping[str, object] = {
    "force": opt.Force,
    "as_json": opt.AsJson,
    "strict": opt.Strict,
    "quiet": opt.Quiet,
    "no_color": opt.NoColor,
}
"""Options of the fields of `Output`, in the order of the help."""


def with_output(command: opt.Command) -> opt.Command:
    """Add the options of `Output` after a command's own; they come in its parameter `output`."""

    @functools.wraps(command)
    def run(**arguments: object) -> None:
        output = Output(**{name: bool(arguments.pop(name)) for name in OUTPUT_OPTIONS})
        command(**arguments, output=output)

    of_command = [
        parameter
        for parameter in inspect.signature(command).parameters.values()
        if parameter.name != "output"
    ]
    opt.redeclare(run, [*of_command, *opt.parameters(OUTPUT_OPTIONS, default=False)])
    return run
