"""What `ocs-design export` wrote."""

from rich.console import Console

from ocs_design.answers import Exported
from ocs_design.report.flights import print_files
from ocs_design.report.layout import note, print_warnings


def print_export(console: Console, exported: Exported) -> None:
    """Warnings, the files by their folders, and what is to be known of them."""
    print_warnings(console, exported.warnings)
    print_files(console, exported.folder, exported.files, "the design as it was")
    for told in exported.notes:
        note(console, told)
