"""Everything that the program uses, looked at."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from importlib import metadata

from ocs_design.doctor.finding import Finding
from ocs_design.doctor.machine import machine_findings
from ocs_design.doctor.packages import DISTRIBUTION, package_findings, wanted_packages
from ocs_design.exceptions import MissingToolError

SCHEMA_VERSION = 1
"""Of the document; that of `design_file` cannot be had where a package is missing."""


@dataclass(frozen=True)
class Examination:
    """What was found.

    Attributes:
        version: of this program.
        machine, packages: findings of each.
    """

    version: str
    machine: tuple[Finding, ...]
    packages: tuple[Finding, ...]

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All of them."""
        return (*self.machine, *self.packages)

    @property
    def exit_code(self) -> int:
        """0, or that of a missing tool if nothing works before something is mended."""
        broken = any(finding.stands_in_the_way for finding in self.findings)
        return MissingToolError.exit_code if broken else 0


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
