"""Settings of Sphinx. Pages come from stage.py; CMake's target `docs` runs both."""
import re
from pathlib import Path

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
smartquotes = False

html_theme = "furo"
html_title = "Ropewalk"
html_static_path = ["site.css", "STIXMath-Regular.otf"]
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
        made = re.sub(r"(<mo>&ApplyFunction;</mo>)(?!\s*<mo)", r'\1<mspace width="0.17em"/>', made)
        return made.replace('<mo stretchy="false">|', '<mo stretchy="false" lspace="0" rspace="0">|')
    except SyntaxError as error:
        logger.warning("no MathML of %s: %s", tex, error, location=node)
        return ""


def visit_inline(translator, node):
    translator.body.append(mathml(node, True))
    raise nodes.SkipNode


def visit_block(translator, node):
    translator.body.append('<div class="formula">' + mathml(node, False) + "</div>")
    raise nodes.SkipNode


def complete_theme(app, error):
    """Debian's furo takes one script from another as a module, and one style sheet from a web server's folder; a browser
    that reads from a disk does neither. Both are put where they are called for. It has also lost the dark colours of
    readers whose system is dark."""
    static = Path(app.outdir) / "_static"
    script, called = static / "scripts/furo.js", 'import Gumshoe from "./gumshoe-patched.js";'
    if called in script.read_text():
        script.write_text(script.read_text().replace(called, (static / "scripts/gumshoe-patched.js").read_text()))
    style, called = static / "styles/furo.css", "@import url(/javascript/normalize.css/normalize.css);"
    text = style.read_text()
    if called in text:
        text = text.replace(called, Path("/usr/share" + called[12:-2]).read_text())
    dark = re.search(r'body\[data-theme="dark"\] (\{.*?\})', text, re.S)
    if "prefers-color-scheme" not in text and dark:
        text += f'@media screen and (prefers-color-scheme: dark) {{ body[data-theme="auto"] {dark[1]} }}\n'
    style.write_text(text)


def setup(app):
    app.connect("build-finished", complete_theme)
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
