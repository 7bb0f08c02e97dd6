"""What a reader found odd in a file, gathered so that each kind is told once."""

from collections.abc import Sequence


class Remarks:
    """Collects remarks; equal remarks on several links or joints become one sentence."""

    def __init__(self) -> None:
        self._subjects: dict[str, list[str]] = {}

    def add(self, what: str, subject: str = "") -> None:
        """Note `what`, with the link, joint or file that it is about."""
        self._subjects.setdefault(what, []).append(subject)

    def sentences(self) -> tuple[str, ...]:
        """One sentence each, with the names and, where there are many, their number."""
        return tuple(
            f"{what}: {listed(subjects)}" if subjects[0] else what
            for what, subjects in self._subjects.items()
        )


def listed(names: Sequence[str], most: int = 4) -> str:
    """Names with commas between them; beyond `most` only how many more there are."""
    shown = ", ".join(names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"
