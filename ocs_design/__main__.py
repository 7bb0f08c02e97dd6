"""`python -m ocs_design`."""

from ocs_design.cli import main

main()
