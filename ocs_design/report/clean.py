"""Text of strangers on a terminal: what would move the cursor or turn the line around is not sent.

Names come from robot files, catalogues and `design.json`. Terminals obey control characters of two
kinds (ECMA-48), and the bidirectional ones of Unicode show a text otherwise than it is.
"""

from collections.abc import Iterator

from rich.console import Console, ConsoleOptions, ConsoleRenderable, RenderHook, RenderResult
from rich.measure import Measurement
from rich.segment import Segment

_CONTROL = [*range(0x20), *range(0x7F, 0xA0), *range(0x202A, 0x202F), *range(0x2066, 0x206A)]
_REPLACED = {code: "\ufffd" for code in (*_CONTROL, 0x2028, 0x2029) if chr(code) not in "\n\t"}


def cleaned(text: str) -> str:
    """The text with a mark in place of each control character but tabs and ends of lines."""
    return text.translate(_REPLACED)


class CleanHook(RenderHook):
    """Cleans whatever a console prints; colours and the like are no part of the texts."""

    def process_renderables(self, renderables: list[ConsoleRenderable]) -> list[ConsoleRenderable]:
        """Called by rich before it prints."""
        return [_Clean(each) for each in renderables]


class _Clean:
    """Something to print, its texts cleaned."""

    def __init__(self, inner: ConsoleRenderable) -> None:
        self._inner = inner

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        yield from self._segments(console, options)

    def __rich_measure__(self, console: Console, options: ConsoleOptions) -> Measurement:
        return Measurement.get(console, options, self._inner)

    def _segments(self, console: Console, options: ConsoleOptions) -> Iterator[Segment]:
        for segment in console.render(self._inner, options):
            if segment.control:
                yield segment
            else:
                yield Segment(cleaned(segment.text), segment.style)
