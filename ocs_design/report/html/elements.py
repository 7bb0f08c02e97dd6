"""Elements of HTML. Every text is escaped unless it is `Markup` already."""

import re
from collections.abc import Collection, Iterable, Sequence
from html import escape

_ESCAPED = {
    "<": "\\u003c",
    ">": "\\u003e",
    "&": "\\u0026",
    "\u2028": "\\u2028",
    "\u2029": "\\u2029",
}
"""What must not stand in a script's element, as JSON may write it too."""


_POWER = re.compile(r"\b(kg m|kg mm|m/s|rad/s)\^?([23])\b")


class Markup(str):
    """Text that is HTML."""

    __slots__ = ()


def element(name: str, *content: str, **attributes: str | bool) -> Markup:
    """An element with its content; `class_` and `for_` stand for the words of Python."""
    inside = "".join(map(_safe, content))
    return Markup(f"<{name}{_attributes(attributes)}>{inside}</{name}>")


def void(name: str, **attributes: str | bool) -> Markup:
    """An element that has no content."""
    return Markup(f"<{name}{_attributes(attributes)}>")


def joined(parts: Iterable[str]) -> Markup:
    """One behind the other."""
    return Markup("".join(map(_safe, parts)))


def facts(rows: Iterable[tuple[str, str]]) -> Markup:
    """Names and values."""
    pairs = (joined((element("dt", name), element("dd", value))) for name, value in rows)
    return element("dl", *pairs)


def items(texts: Iterable[str], *, look: str = "") -> Markup:
    """A list; nothing where there is nothing in it."""
    found = [element("li", text) for text in texts]
    return element("ul", *found, class_=look) if found else Markup("")


def table(
    caption: str,
    columns: Sequence[str],
    rows: Iterable[Sequence[str]],
    *,
    words: Collection[int] = (0,),
) -> Markup:
    """With a caption; the columns `words` hold words, the others numbers."""

    def look(column: int) -> str:
        """Class of a cell."""
        return "word" if column in words else "number"

    heads = (element("th", name, scope="col", class_=look(i)) for i, name in enumerate(columns))
    body = (
        element("tr", *(element("td", cell, class_=look(i)) for i, cell in enumerate(row)))
        for row in rows
    )
    whole = element(
        "table",
        element("caption", caption),
        element("thead", element("tr", *heads)),
        element("tbody", *body),
    )
    # Wide tables scroll by themselves on a narrow screen, and by keys too.
    return element("div", whole, class_="scroll", tabindex="0", role="region", aria_label=caption)


def section(name: str, title: str, *content: str) -> Markup:
    """A part of the page that its contents lead to."""
    head = element("h2", title, id=f"{name}-title")
    return element("section", head, *content, id=name, aria_labelledby=f"{name}-title")


def details(summary: str, *content: str) -> Markup:
    """Folded away until it is wanted; open in print."""
    return element("details", element("summary", summary), *content)


def data(name: str, text: str) -> Markup:
    """A text of JSON for scripts and other programs; nothing in it can end the element."""
    for letter, code in _ESCAPED.items():
        text = text.replace(letter, code)
    return Markup(f'<script type="application/json" id="{name}">{text}</script>')


def _attributes(attributes: dict[str, str | bool]) -> str:
    """Those that are true have no value, those that are false or empty are left out."""
    named = ((key.rstrip("_").replace("_", "-"), value) for key, value in attributes.items())
    return "".join(
        f" {key}" if value is True else f' {key}="{escape(value)}"'
        for key, value in named
        if value is True or (value is not False and (value != "" or key == "value"))
    )


def _safe(content: str) -> str:
    return content if isinstance(content, Markup) else escape(_typeset(content))


def _typeset(text: str) -> str:
    """Powers of units, which the terminal and the messages spell without raised figures."""
    return _POWER.sub(lambda found: found[1] + {"2": "²", "3": "³"}[found[2]], text)
