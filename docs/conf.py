"""How the pages are built: ``pip install ".[docs]" && sphinx-build docs docs/_build``."""

import sys
from pathlib import Path

from wrinklewave import __version__

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "wrinklewave"
author = "The wrinklewave developers"
copyright = "The wrinklewave developers, MIT licence"
release = version = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # formulae without a network
    "sphinx.ext.viewcode",
    "sphinx_gallery.gen_gallery",
    "references",
]
exclude_patterns = ["_build", "examples"]

myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "fieldlist"]
myst_heading_anchors = 3
suppress_warnings = [
    "config.cache"
]  # the gallery's options hold a class, which cannot be kept between builds

autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
autodoc_class_signature = "separated"

sphinx_gallery_conf = {
    "examples_dirs": "examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"/example_\d",
    "within_subsection_order": "FileNameSortKey",
    "download_all_examples": False,
    "show_memory": False,
    "min_reported_time": 1e9,  # how long an example took says more about the machine than about the example
    "write_computation_times": False,
}

html_theme = "pydata_sphinx_theme"
html_title = f"wrinklewave {release}"
html_theme_options = {
    "show_prev_next": False,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
html_sidebars = {"index": []}
html_show_sourcelink = False
