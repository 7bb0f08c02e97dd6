"""Commands with options that are declared elsewhere, once for all that share them."""

import functools
import inspect
from collections.abc import Callable, Mapping
from typing import TypeAlias

Command: TypeAlias = Callable[..., None]


def with_options(shared: Mapping[str, object]) -> Callable[[Command], Command]:
    """Declare these options on a command too, before its own and each left out by default.

    They are not handed on: `cli_stated` reads them from the command's context, its first parameter.
    """

    def declared(command: Command) -> Command:
        """The command with the signature that Typer makes options from."""

        @functools.wraps(command)
        def run(**given: object) -> None:
            """What is handed on is the context and the command's own options."""
            command(**{name: value for name, value in given.items() if name not in shared})

        context, *own = inspect.signature(command).parameters.values()
        redeclare(run, [context, *parameters(shared, default=None), *own])
        return run

    return declared


def parameters(options: Mapping[str, object], *, default: object) -> list[inspect.Parameter]:
    """Of a command, one for each option."""
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    return [
        inspect.Parameter(name, kind, default=default, annotation=option)
        for name, option in options.items()
    ]


def redeclare(command: Command, parameters: list[inspect.Parameter]) -> None:
    """What Typer makes options from."""
    command.__dict__["__signature__"] = inspect.Signature(parameters)
    command.__annotations__ = {each.name: each.annotation for each in parameters}
