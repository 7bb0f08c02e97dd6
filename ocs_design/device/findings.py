"""Findings on the machine and on each component that the program uses."""

from dataclasses import dataclass
from enum import StrEnum

from ocs_design.common.errors import MissingToolError


class State(StrEnum):
    """State of a component that the program uses."""

    WORKS = "works"
    MISSING = "missing"
    UNFIT = "unfit"
    """A version that is not allowed, or an unsuitable machine."""
    BROKEN = "broken"
    """Present, but it does not run."""


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Finding on one component that the program uses.

    Attributes:
        name: of the component. state: its state.
        required: whether nothing works without it.
        found: version, or what was found; empty: nothing.
        wanted: allowed versions; empty: any.
        purpose: what it is for.
        extra: the package's extra that installs it; empty: none.
        cure: remedy where it does not work. reason: why it does not.
    """

    name: str
    state: State
    required: bool = False
    purpose: str
    found: str = ""
    wanted: str = ""
    extra: str = ""
    cure: str = ""
    reason: str = ""

    @property
    def is_blocking(self) -> bool:
        """Whether nothing works until it is fixed."""
        return self.required and self.state is not State.WORKS


@dataclass(frozen=True)
class Examination:
    """Findings on the machine and on all packages.

    Attributes:
        version: of this program.
        machine, packages: findings of each.
    """

    version: str
    machine: tuple[Finding, ...]
    packages: tuple[Finding, ...]

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings, those of the machine first."""
        return (*self.machine, *self.packages)

    @property
    def exit_code(self) -> int:
        """0, or that of a missing tool if nothing works until something is fixed."""
        broken = any(finding.is_blocking for finding in self.findings)
        return MissingToolError.exit_code if broken else 0
