"""From the options of a command to a specification."""

import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from ocs_design.requirement.specification import Specification


def stated_specification(context: typer.Context) -> "Specification":
    """The file given with `--spec`, and over it every option of the command that is a key.

    Raises:
        OcsError: the file or an option cannot be read.
    """
    # Not for `--help`: reading specifications needs NumPy.
    from ocs_design.requirement.options import specification_from_options
    from ocs_design.requirement.reading import read_specification
    from ocs_design.requirement.specification import Specification, merge

    file = context.params["spec"]
    base = Specification() if file is None else read_specification(Path(file))
    return merge(base, specification_from_options(_options(context.params)))


def typed_command() -> str:
    """What was typed, as a shell takes it."""
    return shlex.join(["ocs-design", *sys.argv[1:]])


def stated_package_paths(context: typer.Context) -> Mapping[str, Path]:
    """`NAME=DIR` pairs of `--package-path`.

    Raises:
        UsageError: a text is no such pair.
    """
    from ocs_design.exceptions import UsageError

    found = {}
    for text in context.params["package_path"] or ():
        name, separator, folder = text.partition("=")
        if not (name and separator and folder):
            raise UsageError(
                f"--package-path {text}: is not NAME=DIR",
                hint="as in --package-path my_robot=/opt/my_robot",
            )
        found[name] = Path(folder)
    return found


def _options(parameters: Mapping[str, object]) -> Mapping[str, object]:
    """What each option says by the path of its key, as in `flywheel.r_max`."""
    from ocs_design.requirement.specification import all_keys

    stated: dict[str, object] = {}
    for path, key in all_keys().items():
        option = key.option or path.partition(".")[2]
        # A robot's file is no option but the command's argument.
        parameter = "robot" if path == "robot.file" else option.replace("-", "_")
        if parameters.get(f"no_{parameter}"):
            stated[path] = False
            continue
        value = parameters.get(parameter)
        # What repeats comes as a tuple, empty where nothing is said; a flag is then false.
        if isinstance(value, tuple):
            value = list(value)
        # Zero equals False, and is a seed.
        if value is not None and value is not False and value != []:
            stated[path] = value
    return stated
