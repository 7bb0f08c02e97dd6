"""What was found of one thing that the program uses."""

from dataclasses import dataclass
from enum import StrEnum


class State(StrEnum):
    """How it is."""

    WORKS = "works"
    MISSING = "missing"
    UNFIT = "unfit"
    """A version that is not allowed, or a machine that does not do."""
    BROKEN = "broken"
    """There, but it does not run."""


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing.

    Attributes:
        name: of the thing. state: how it is.
        required: whether nothing works without it.
        found: version, or what there is; empty: nothing.
        wanted: versions that are allowed; empty: any.
        purpose: what it is for.
        cure: how to get it, where it does not work. reason: why it does not.
    """

    name: str
    state: State
    required: bool
    purpose: str
    found: str = ""
    wanted: str = ""
    cure: str = ""
    reason: str = ""

    @property
    def stands_in_the_way(self) -> bool:
        """Whether nothing works before it is mended."""
        return self.required and self.state is not State.WORKS
