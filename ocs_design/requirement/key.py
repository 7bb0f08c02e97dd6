"""What a key of the specification means outside the program."""

from dataclasses import dataclass
from typing import Any

from ocs_design.requirement.values import Value


@dataclass(frozen=True)
class Key:
    """What a field of a section means outside the program.

    Attributes:
        value: how it is read.
        summary: what it is, for help and for messages.
        option: its name on the command line; empty: the key's own, with dashes.
    """

    value: Value[Any]
    summary: str
    option: str = ""
