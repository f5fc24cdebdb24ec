"""Writes the Python reference: each name that docs/python-reference.md lists becomes what its docstring says.

Types that signatures name are links where the reference has them. Those of the standard library, of NumPy and of other
packages are not: what they are is on pages of others, and the site is made without a network. Neither are those of
Muster that no page promises.
"""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from docutils.nodes import Element, Node
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

from muster.mission.records import Checked

PAGE = "docs/python-reference"
_OF_RECORDS = sorted({"cross_check", "tied", *(name for name in vars(Checked) if not name.startswith("_"))})
"""What classes of data have for those who read and write files, which no caller needs."""
_NAME = re.compile(r"^- `(muster[\w.]*)`$", re.MULTILINE)


def listed_names(text: str) -> list[str]:
    """The names that the page lists."""
    return _NAME.findall(text)


def with_directives(text: str) -> str:
    """The page with a directive of autodoc in place of each name."""
    return _NAME.sub(lambda found: _directive(found[1]), text)


def find(name: str) -> Any:
    """The object of a name.

    Raises
    ------
    ImportError, AttributeError
        if there is none.
    """
    module, _, attribute = name.rpartition(".")
    return getattr(importlib.import_module(module), attribute)


def _directive(name: str) -> str:
    found = find(name)
    if not inspect.isclass(found):
        kind, members = "autofunction", ""
    elif issubclass(found, BaseException):
        kind, members = "autoexception", ""
    else:
        kind, members = "autoclass", f"\n   :members:\n   :exclude-members: {', '.join(_OF_RECORDS)}"
    return f"\n```{{eval-rst}}\n.. {kind}:: {name}{members}\n```\n"


def _write(_: Sphinx, name: str, source: list[str]) -> None:
    if name == PAGE:
        source[0] = with_directives(source[0])


@cache
def names_in(root: Path) -> Mapping[str, str]:
    """The names that the page lists, by the places of their definitions and their last words, as in annotations."""
    found: dict[str, str] = {}
    for name in listed_names((root / f"{PAGE}.md").read_text(encoding="utf-8")):
        defined = find(name)
        found[f"{defined.__module__}.{defined.__qualname__}"] = name
        found.setdefault(defined.__qualname__, name)
    return found


def _resolve(app: Sphinx, env: BuildEnvironment, node: Element, words: Node) -> Node | None:
    """A link to the name by which the reference has an object; else the words alone, where nothing is promised."""
    if node.get("refdomain") != "py":
        return None
    known = names_in(Path(app.srcdir)).get(node.get("reftarget", ""))
    if known is None:
        return words
    return env.get_domain("py").resolve_xref(env, node["refdoc"], app.builder, "obj", known, node, words) or words


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.connect("source-read", _write)
    app.connect("missing-reference", _resolve)
    return {"parallel_read_safe": True}
