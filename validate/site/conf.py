"""Settings of Sphinx for the site; build.py calls it."""

import os

project = "detp"
author = "The detp maintainers"
copyright = "2026, the detp maintainers"
version = release = os.environ["DETP_SITE_VERSION"]
extensions = ["myst_parser", "sphinx.ext.autodoc"]
source_suffix = {".md": "markdown"}
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]
html_theme = "furo"
html_title = f"detp {version}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_show_sourcelink = False
html_copy_source = False
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_member_order = "bysource"
default_role = "code"
suppress_warnings = ["myst.header"]  # pages of the repository may begin below the first level
