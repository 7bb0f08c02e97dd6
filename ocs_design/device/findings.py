"""What was found of the machine and of each thing that the program uses."""

from dataclasses import dataclass
from enum import StrEnum

from ocs_design.common.errors import MissingToolError


class State(StrEnum):
    """Whether a thing that the program uses works."""

    WORKS = "works"
    MISSING = "missing"
    UNFIT = "unfit"
    """A version that is not allowed, or a machine that does not do."""
    BROKEN = "broken"
    """There, but it does not run."""


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What was found of one thing that the program uses.

    Attributes:
        name: of the thing. state: how it is.
        required: whether nothing works without it.
        found: version, or what there is; empty: nothing.
        wanted: versions that are allowed; empty: any.
        purpose: what it is for.
        extra: of ours that asks for it; empty: none.
        cure: how to get it, where it does not work. reason: why it does not.
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
    def stands_in_the_way(self) -> bool:
        """Whether nothing works before it is mended."""
        return self.required and self.state is not State.WORKS


@dataclass(frozen=True)
class Examination:
    """What was found of the machine and of all packages.

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
        """0, or that of a missing tool if nothing works before something is mended."""
        broken = any(finding.stands_in_the_way for finding in self.findings)
        return MissingToolError.exit_code if broken else 0
