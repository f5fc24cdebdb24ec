"""Writes the Python reference: each name that docs/python-reference.md lists becomes what its docstring says.

Types that signatures name are links where the reference has them. Those of the standard library, of NumPy and of other
packages are not: what they are is on pages of others, and the site is made without a network. Neither are those of
Muster that no page promises.
"""

from __future__ import annotations

import importlib
import inspect
import re
from typing import Any

from docutils.nodes import Element, Node
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

PAGE = "docs/python-reference"
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
        kind, members = "autoclass", "\n   :members:"
    return f"\n```{{eval-rst}}\n.. {kind}:: {name}{members}\n```\n"


def _write(app: Sphinx, name: str, source: list[str]) -> None:
    if name == PAGE:
        app.env.muster_names = {_true_name(listed): listed for listed in listed_names(source[0])}  # type: ignore[attr-defined]
        source[0] = with_directives(source[0])


def _true_name(name: str) -> str:
    """Where an object is defined: annotations name it so."""
    found = find(name)
    return f"{found.__module__}.{found.__qualname__}"


def _resolve(app: Sphinx, env: BuildEnvironment, node: Element, words: Node) -> Node | None:
    """A link to the name by which the reference has an object; else the words alone, where nothing is promised."""
    target = str(node.get("reftarget", ""))
    if node.get("refdomain") != "py":
        return None
    names: dict[str, str] = getattr(env, "muster_names", {})
    last = target.rpartition(".")[2]
    known = names.get(target) or next((name for name in names.values() if name.rpartition(".")[2] == last), None)
    if known is None or "." in target.removeprefix("muster.") and target not in names:
        return words
    domain = env.get_domain("py")
    found = domain.resolve_xref(env, node["refdoc"], app.builder, "obj", known, node, words)
    return found or words


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.connect("source-read", _write)
    app.connect("missing-reference", _resolve)
    return {"parallel_read_safe": False}
