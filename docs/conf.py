"""Settings of the documentation: Sphinx reads Markdown; the source folder is the repository, so that links are one."""

import sys
from importlib.metadata import version as version_of
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from generated import fill

project = "rfmpm"
author = "the rfmpm developers"
release = version = version_of("rfmpm")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml"]
root_doc = "docs/index"
include_patterns = ["docs/**.md", "reports/**.md"]
exclude_patterns = ["docs/_build", ".*", "build", "dist", "results", "rfmpm*", "tests", "configs", "workflows"]

myst_enable_extensions = ["dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 4
smartquotes = False  # what stands in quotes is often a value
suppress_warnings = ["myst.header"]  # pages of reports begin where their headings do

napoleon_use_rtype = False
autodoc_typehints = "none"  # the docstrings say shapes and units, which types do not
nitpick_ignore_regex = [("py:.*", r"(np|xr|numpy|xarray|pydantic)\..*"), ("py:class", "(optional|array_like|.* of .*)")]

html_theme = "furo"
html_math_renderer = "mathml"
html_title = f"rfmpm {release}"
templates_path = ["_templates"]
html_static_path = ["_static"]
html_additional_pages = {"index": "to_docs.html"}
html_show_sphinx = html_show_copyright = html_copy_source = False


def setup(app):
    """Fill the pages that the program itself writes, and let nothing of a build depend on where it was made."""
    app.connect("source-read", lambda app, page, source: source.__setitem__(0, fill(source[0])))
