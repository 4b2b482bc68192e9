# Sphinx settings of the documentation site; tools/docs builds it. Everything comes from this machine.
import pathlib
import re
import shutil

from docutils import nodes

top = pathlib.Path(__file__).resolve().parent.parent

project = "Calendem"
copyright = "the authors of Calendem, GPL-2.0-or-later"
version = release = re.search(r"project\(Calendem VERSION (\S+)", (top / "CMakeLists.txt").read_text()).group(1)

extensions = ["myst_parser", "sphinx.ext.mathjax"]
exclude_patterns = ["figures", "paper"]
myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 3

html_theme = "furo"
html_title = f"Calendem {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
highlight_language = "none"
suppress_warnings = ["misc.highlighting_failure"]  # other languages in here-documents

# MathJax 2 of the distribution, copied into the site; its SVG output needs no fonts of its own.
mathjax_path = "mathjax/MathJax.js"
myst_update_mathjax = False
mathjax2_config = {
    "jax": ["input/TeX", "output/SVG"],
    "extensions": ["tex2jax.js"],
    "TeX": {"extensions": ["AMSmath.js", "AMSsymbols.js", "noErrors.js", "noUndefined.js"]},
    "tex2jax": {"processClass": "math"},
    "showMathMenu": False,
    "messageStyle": "none",
    "SVG": {"linebreaks": {"automatic": True}},
}
mathjax_source = pathlib.Path("/usr/share/javascript/mathjax")
mathjax_parts = ["MathJax.js", "extensions", "jax/element", "jax/input/TeX"] + [
    "jax/output/SVG/" + part for part in ("jax.js", "config.js", "autoload", "fonts/TeX")
]


def copy_mathjax(app, exception):
    if exception or app.builder.format != "html":
        return
    for part in mathjax_parts:
        source, target = mathjax_source / part, pathlib.Path(app.outdir) / "_static/mathjax" / part
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, dirs_exist_ok=True)
        else:
            shutil.copy(source, target)


units = "µm|nm|mm|cm|nN|kPa|MPa|GPa|µs|ms|s|h|m/s|mg|g|kg|points?|minutes?|hours?|nats"
number_and_unit = re.compile(rf"(?<=\d) (?=(?:{units})\b|%)")


def keep_units_with_numbers(app, doctree):
    """No line ends between a number and its unit; code stays as it is."""
    for text in list(doctree.findall(nodes.Text)):
        if isinstance(text.parent, (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block)):
            continue
        text.parent.replace(text, nodes.Text(number_and_unit.sub("\u00a0", text)))


def setup(app):
    app.connect("doctree-read", keep_units_with_numbers)
    app.connect("build-finished", copy_mathjax)
