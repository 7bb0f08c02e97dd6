"""What `ocs-design init` wrote, and what to do next."""

from rich.console import Console

from ocs_design.answers import Initialized
from ocs_design.report.layout import facts


def print_initialized(console: Console, initialized: Initialized) -> None:
    """The file and the command that designs by it."""
    facts(console, [("written", initialized.file), ("next", initialized.next)])
