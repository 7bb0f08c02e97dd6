"""HTML elements. Every text is escaped unless it is `Markup`."""

import re
from collections.abc import Iterable
from html import escape

from ocs_design.report.charts.chart import Chart
from ocs_design.report.charts.svg import inline_svg
from ocs_design.report.table import CellTable, Toned, cell_text, with_nonbreaking_units

_ESCAPED = {
    "<": "\\u003c",
    ">": "\\u003e",
    "&": "\\u0026",
    "\u2028": "\\u2028",
    "\u2029": "\\u2029",
}
"""Characters that are unsafe in a script element, and their JSON escapes."""

_LONG_TEXT = 12
"""Length of a cell's text above which a phone would show one word per line."""

_POWER = re.compile(r"\b(kg m|kg mm|m/s|rad/s)\^?([23])\b")


class Markup(str):
    """Text that is already HTML."""

    __slots__ = ()


def element(name: str, *content: str, **attributes: str | bool) -> Markup:
    """Element with its content; `class_` and `for_` stand for the reserved words."""
    inside = "".join(map(_escaped, content))
    return Markup(f"<{name}{_attributes(attributes)}>{inside}</{name}>")


def void(name: str, **attributes: str | bool) -> Markup:
    """Element without content."""
    return Markup(f"<{name}{_attributes(attributes)}>")


def joined(parts: Iterable[str]) -> Markup:
    """Concatenated parts."""
    return Markup("".join(map(_escaped, parts)))


def note(*content: str) -> Markup:
    """Paragraph with a note on the neighbouring element."""
    return element("p", *content, class_="note")


def facts(rows: Iterable[tuple[str, str]]) -> Markup:
    """Definition list of names and values."""
    pairs = (joined((element("dt", name), element("dd", value))) for name, value in rows)
    return element("dl", *pairs)


def items(texts: Iterable[str], *, css_class: str = "") -> Markup:
    """List; empty markup if it has no items."""
    entries = [element("li", text) for text in texts]
    return element("ul", *entries, class_=css_class) if entries else Markup("")


def table(caption: str, content: CellTable) -> Markup:
    """Table with its caption; units are in brackets."""
    headings, classes = [], []
    for index, column in enumerate(content.columns):
        name = column.name.replace("\n", " ").strip()
        head = f"{name} [{column.unit.strip()}]" if column.unit else name
        texts = (cell_text(row[index]) for row in content.rows)
        # Long texts keep some width on a narrow screen.
        is_long = column.words and max(map(len, texts), default=0) > _LONG_TEXT
        classes.append("word long" if is_long else "word" if column.words else "number")
        css_class = "word" if column.words else "number"
        headings.append(element("th", head, scope="col", class_=css_class))
    body = []
    for row in content.rows:
        contents = (
            element("span", cell.text, class_=f"mark {cell.tone}")
            if isinstance(cell, Toned)
            else with_nonbreaking_units(cell)
            for cell in row
        )
        pairs = zip(contents, classes, strict=True)
        body.append(element("tr", *(element("td", cell, class_=kind) for cell, kind in pairs)))
    head = element("thead", element("tr", *headings))
    table_element = element("table", element("caption", caption), head, element("tbody", *body))
    # Wide tables scroll on their own on a narrow screen, also by keyboard.
    return element(
        "div", table_element, class_="scroll", tabindex="0", role="region", aria_label=caption
    )


def section(name: str, title: str, *content: str) -> Markup:
    """Section of the page with an anchor for the table of contents."""
    heading = element("h2", title, id=f"{name}-title")
    return element("section", heading, *content, id=name, aria_labelledby=f"{name}-title")


def details(summary: str, *content: str) -> Markup:
    """Element that is collapsed until opened; left out in print."""
    return element("details", element("summary", summary), *content)


def figures(charts: Iterable[Chart], *, flight: str = "") -> Markup:
    """Charts, side by side if there is room; `flight` is the number of their maneuver, if any."""
    elements = (element("figure", Markup(inline_svg(chart))) for chart in charts)
    return element("div", *elements, class_="charts", data_flight=flight)


def json_element(name: str, text: str) -> Markup:
    """JSON element for scripts and other programs, escaped so that it cannot end the element."""
    for character, escaped in _ESCAPED.items():
        text = text.replace(character, escaped)
    return Markup(f'<script type="application/json" id="{name}">{text}</script>')


def _attributes(attributes: dict[str, str | bool]) -> str:
    """Attributes as text: without value if true, left out if false or empty."""
    named = ((key.rstrip("_").replace("_", "-"), value) for key, value in attributes.items())
    return "".join(
        f" {key}" if value is True else f' {key}="{escape(value)}"'
        for key, value in named
        if value is True or (value is not False and (value != "" or key == "value"))
    )


def _escaped(content: str) -> str:
    """Markup unchanged, other text escaped, with superscripts in its units."""
    if isinstance(content, Markup):
        return content
    return escape(_POWER.sub(lambda match: match[1] + {"2": "²", "3": "³"}[match[2]], content))
