"""Templates of exported text files, filled with numbers and names."""

import re
from pathlib import Path
from string import Template
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import ArrayLike

from ocs_design.common.files import packaged_folder


class _AtTemplate(Template):
    """Template with placeholders `@name`, because dollars and braces belong to xacro."""

    delimiter = "@"


def fill(template: str, values: dict[str, str]) -> str:
    """Text of `templates/<template>` with each `@name` replaced.

    Values must be valid in XML; see `quoted` and `numbers`.
    """
    return _AtTemplate(template_text(template)).substitute(values)


def template_text(template: str) -> str:
    """Text of `templates/<template>` without changes."""
    return template_file(template).read_text(encoding="utf-8")


def template_file(name: str) -> Path:
    """Path of `templates/<name>`: in the installed package, else beside it in the sources."""
    return packaged_folder("templates") / name


def quoted(text: str) -> str:
    """Text for an XML attribute in double quotes."""
    return escape(text, {'"': "&quot;", "\n": "&#10;", "\t": "&#9;"})


def in_comment(text: str) -> str:
    """Text for an XML comment, which must not contain two consecutive hyphens."""
    return re.sub("-(?=-)", "- ", text).removesuffix("-")


def numbers(values: ArrayLike) -> str:
    """Numbers separated by spaces, each with the fewest digits that reproduce it."""
    # Zero has no sign, because readers would wonder at -0.0.
    return " ".join(repr(float(value) + 0.0) for value in np.ravel(values))
