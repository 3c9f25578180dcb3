"""Configuration of the documentation."""

import importlib.metadata
import importlib.resources
import logging
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import gallery

project = "anistar"
author = "The anistar authors"
copyright = author
release = importlib.metadata.version("anistar")

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx.ext.viewcode",
    "sphinx_gallery.gen_gallery",
    "sphinxcontrib.bibtex",
]
myst_enable_extensions = ["amsmath", "deflist", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["_build"]

templates_path = ["_templates"]
autosummary_generate = True
autodoc_typehints = "none"
numpydoc_show_class_members = False

# Sphinx would show every assembly of a matrix in the examples.
logging.getLogger("skfem").setLevel(logging.WARNING)

sphinx_gallery_conf = {
    "examples_dirs": "../solver_examples",
    "gallery_dirs": "auto_examples",
    "filename_pattern": gallery.runnable(),
    "reset_argv": "gallery.small_arguments",
    "reset_modules": ("gallery.with_anistar_in_petsc",),
    "thumbnail_size": gallery.THUMBNAIL,
    "image_scrapers": ("gallery.drawn_picture",),
    "subsection_order": [f"../solver_examples/{folder}" for folder in gallery.PACKAGES],
    "download_all_examples": False,
    "show_signature": False,
    "write_computation_times": False,
    "remove_config_comments": True,
}

bibtex_bibfiles = ["references.bib"]
bibtex_default_style = "plain"
bibtex_reference_style = "author_year"

html_theme = "furo"
html_title = "anistar"

# Formulas are set without a network: the package brings MathJax, and of its files the one that
# draws them needs no fonts, which browsers refuse to load for a page opened as a file.
_MATHJAX = importlib.resources.files("sphinx-mathjax-offline") / "static" / "mathjax"
html_static_path = ["_static", str(_MATHJAX / "tex-svg.js")]
html_css_files = ["wide-enough.css"]
mathjax_path = "tex-svg.js"


def _lead_back(app, page_name, template_name, context, doctree):
    """Lead from the source of a name that is documented where it is exported to its page."""
    if page_name.startswith("_modules/"):
        context["body"] = re.sub(
            r"(generated/([\w.]+)\.html#)(?!\2)[\w.]+", r"\1\2", context["body"]
        )


def setup(app):
    """Connect what this configuration adds to the building of pages."""
    app.connect("html-page-context", _lead_back)
    app.connect("builder-inited", gallery.draw_thumbnails, priority=900)  # when it has been run
