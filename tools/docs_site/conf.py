"""The settings of Sphinx. Its sources are the repository's own pages, so their links lead where they lead there."""

from __future__ import annotations

import logging
import os
import sys
from importlib.metadata import version as installed_version
from pathlib import Path

from pygments.lexers.special import TextLexer
from sphinx.highlighting import lexers

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # where `tools` is

project = "Muster"
release = version = installed_version("muster-robotics")
project_copyright = "Muster contributors"

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "tools.docs_site.navigation",
    "tools.docs_site.reference",
    "tools.docs_site.remarks",
    "tools.docs_site.tutorials",
    "tools.docs_site.finish",
]
include_patterns = [
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "CODE_OF_CONDUCT.md",
    "SECURITY.md",
    "docs/*.md",
    "docs/tutorials/*.md",
]
exclude_patterns = [".venv", "build", "src", "tests", ".git"]  # not even looked through
root_doc = "docs/index"
nitpicky = True
lexers["csv"] = TextLexer()

myst_heading_anchors = 6  # a link to a heading is checked, as a forge makes its anchor
myst_links_external_new_tab = False

nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300  # of a cell; tutorials take seconds, a machine that is busy takes longer
nb_execution_in_temp = True
nb_merge_streams = True
os.environ["JUPYTER_PATH"] = str(Path(__file__).with_name("jupyter"))  # a kernel that says nothing but errors
logging.getLogger("traitlets").setLevel(logging.WARNING)  # nor does what starts it

default_role = "code"  # of words between single backticks in docstrings
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True
napoleon_google_docstring = False
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100

html_theme = "furo"
html_title = f"Muster {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_sphinx = False
html_show_search_summary = False  # read from disk, a page may not fetch the others
html_favicon = "../../src/muster_control/pages/assets/icon.svg"
html_theme_options = {"navigation_with_keys": True}
