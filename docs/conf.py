"""How Sphinx builds these pages: Markdown in, HTML out, nothing from the network."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent)]

from ocs_design import __version__  # noqa: E402  found through the line above

project = "ocs-design"
release = version = __version__
author = "The ocs-design developers"
copyright = author

extensions = ["myst_parser", "mathml", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
nitpicky = True
# Types that a public name is made of live in modules without a page of their own.
nitpick_ignore_regex = [("py:.*", r"(?!ocs_design\.\w+$).*")]

autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
python_use_unqualified_type_names = True
napoleon_use_ivar = True
napoleon_use_rtype = False

html_theme = "furo"
html_title = f"{project} {release}"
html_math_renderer = "mathml"
html_static_path = ["_static"]
html_css_files = ["ocs.css"]
html_show_sphinx = False
html_copy_source = False
