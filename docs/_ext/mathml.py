"""Formulas as MathML, made by docutils at build time: no network, no script, no fonts."""

import re

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.typing import ExtensionMetadata
from sphinx.writers.html5 import HTML5Translator

LOGGER = logging.getLogger(__name__)
DOTTED = re.compile(r"(\\d?dot(?: ?\\?[A-Za-z]+|\{(?:[^{}]|\{[^{}]*\})*\}))(?=_)")


def visit_inline(translator: HTML5Translator, node: nodes.math) -> None:
    """Write a formula within a line."""
    translator.body.append(mathml(node, as_block=False))
    raise nodes.SkipNode


def visit_display(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula on lines of its own."""
    translator.body.append(f'<div class="math">{mathml(node, as_block=True)}</div>\n')
    raise nodes.SkipNode


def mathml(node: nodes.Element, *, as_block: bool) -> str:
    r"""The formula of a node.

    docutils lets \boldsymbol run on to the formula's end; \mathbf does what is meant, Greek too.
    And it puts the index of a dotted letter below it, unless nothing stands in between.
    """
    formula = node.astext()
    if r"\boldsymbol" in formula:
        LOGGER.warning(r"write \mathbf in place of \boldsymbol: %s", formula, location=node)
    return str(tex2mathml(DOTTED.sub(r"\1{}", formula), as_block=as_block))


def setup(app: Sphinx) -> ExtensionMetadata:
    """Register the renderer as `mathml`."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
