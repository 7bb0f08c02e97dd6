"""Blocks of a Markdown page that programs fill in.

A block stands between `<!-- begin KIND: ARGUMENT -->` and `<!-- end -->`.
"""

import re
from collections.abc import Callable, Iterable, Mapping

BLOCK = re.compile(
    r"(?P<begin><!-- begin (?P<kind>[a-z ]+): (?P<argument>.+?) -->\n)"
    r"(?P<body>.*?)"
    r"(?P<end><!-- end -->)",
    re.DOTALL,
)


def filled(text: str, kinds: Mapping[str, Callable[[str], str]]) -> str:
    """The page with the blocks of these kinds filled in; others are left as they are."""

    def fill(block: re.Match[str]) -> str:
        """The block with its body made anew."""
        make = kinds.get(block["kind"])
        body = block["body"] if make is None else make(block["argument"])
        return f"{block['begin']}{body}{block['end']}"

    return BLOCK.sub(fill, text)


def table(header: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    """A Markdown table."""
    lines = [header, tuple("---" for _ in header), *rows]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)
