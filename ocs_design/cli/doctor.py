"""`ocs-design doctor`: parse, call, print. No arithmetic."""

import sys

import typer

from ocs_design.cli import options as opt


def doctor(as_json: opt.AsJson = False, no_color: opt.NoColor = False) -> None:
    """Show what is installed and works, what each thing is for, and how to get what is missing.

    Packages are imported and pictures drawn to see that they can be. Exit codes: 0 all that is
    required works, 5 something required does not.
    """
    from ocs_design.doctor.examination import examination_to_json, examine
    from ocs_design.report.console import Steps, make_console
    from ocs_design.report.examination import print_examination

    console = make_console(color=not no_color)
    with Steps(console, quiet=as_json).step("import every package, draw with OpenGL"):
        examination = examine()
    if as_json:
        sys.stdout.write(examination_to_json(examination))
    else:
        print_examination(console, examination)
    raise typer.Exit(examination.exit_code)
