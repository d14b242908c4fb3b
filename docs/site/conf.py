"""Settings of Sphinx. Pages come from stage.py; CMake's target `docs` runs both."""
import re

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util import logging

project = "Ropewalk"
copyright = "the authors of Ropewalk, BSD-3-Clause"
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
highlight_language = "text"  # of indented blocks, which are commands and TOML in turn
nitpicky = True

html_theme = "furo"
html_title = "Ropewalk"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_extra_path = ["extra"]  # files that pages link to, laid there by stage.py
html_copy_source = False
html_show_search_summary = False  # it would read pages by script, which browsers refuse from a disk
html_math_renderer = "mathml"
html_domain_indices = False
html_use_index = False

logger = logging.getLogger(__name__)


def mathml(node, inline):
    # The converter aligns rows by itself.
    tex = re.sub(r"\\(begin|end)\{aligned\}", "", node.astext()).strip()
    try:
        made = tex2mathml(tex, inline=inline)
        return re.sub(r"(<mo>&ApplyFunction;</mo>)(?!\s*<mo)", r'\1<mspace width="0.17em"/>', made)
    except SyntaxError as error:
        logger.warning("no MathML of %s: %s", tex, error, location=node)
        return ""


def visit_inline(translator, node):
    translator.body.append(mathml(node, True))
    raise nodes.SkipNode


def visit_block(translator, node):
    translator.body.append('<div class="formula">' + mathml(node, False) + "</div>")
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
