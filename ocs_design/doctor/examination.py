"""Everything that the program uses, looked at."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from importlib import metadata

from ocs_design.doctor.finding import Examination
from ocs_design.doctor.machine import machine_findings
from ocs_design.doctor.packages import DISTRIBUTION, package_findings, wanted_packages
from ocs_design.exceptions import MissingToolError

SCHEMA_VERSION = 1
"""Of the document; that of `design_file` cannot be had where a package is missing."""


def examine() -> Examination:
    """Look at everything.

    Raises:
        MissingToolError: this program is not installed as a package, which tells what it needs.
    """
    try:
        wanted = wanted_packages()
    except metadata.PackageNotFoundError as error:
        raise MissingToolError(
            f"{DISTRIBUTION} runs from its source and is not installed: what it needs is not known",
            hint="pip install .",
        ) from error
    packages = tuple(package_findings(wanted))
    return Examination(metadata.version(DISTRIBUTION), machine_findings(), packages)


def examination_to_json(examination: Examination) -> str:
    """As indented JSON."""
    document: Mapping[str, object] = {
        "schema_version": SCHEMA_VERSION,
        "healthy": examination.exit_code == 0,
        **asdict(examination),
    }
    return json.dumps(document, indent=2) + "\n"
