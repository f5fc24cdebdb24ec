"""Adds the tables of contents to docs/index.md: one for each of its sections, of the pages that it lists.

A page that no section lists is a warning of Sphinx, so an error of the build; one that two list is an error here.
"""

from __future__ import annotations

import re
from itertools import groupby
from pathlib import PurePosixPath
from typing import Any

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

from muster.library.documents import Entry, read_index

_BY_FILE_NAME = re.compile(r"\[[\w-]+\.md\](?=\([^)]+\.md\) \|$)", re.MULTILINE)


def with_titles(index: str) -> str:
    """An index whose links say the titles of pages, where they said names of files, which browsers do not need."""
    return _BY_FILE_NAME.sub("[]", index)


def tables_of_contents(index: str) -> str:
    """MyST directives for the pages that an index lists, in its order.

    Raises
    ------
    ExtensionError
        if it lists a page twice.
    """
    entries = list(read_index(index))
    paths = [entry.path for entry in entries]
    twice = sorted({path for path in paths if paths.count(path) > 1})
    if twice:
        raise ExtensionError(f"docs/index.md lists {', '.join(twice)} more than once; expected one section for a page")
    return "".join(_table(kind, list(pages)) for kind, pages in groupby(entries, key=lambda entry: entry.kind))


def _table(kind: str, entries: list[Entry]) -> str:
    lines = "\n".join(map(_line, entries))
    return f"\n\n```{{toctree}}\n:hidden:\n:caption: {kind}\n\n{lines}\n```\n"


def _line(entry: Entry) -> str:
    """A line of a table: by the words of the link where they are not the name of the file."""
    document = f"/{PurePosixPath(entry.path).with_suffix('')}"
    return document if entry.words.endswith(".md") else f"{entry.words} <{document}>"


def _add(app: Sphinx, name: str, source: list[str]) -> None:
    if name == app.config.root_doc:
        source[0] = with_titles(source[0]) + tables_of_contents(source[0])


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.connect("source-read", _add)
    return {"parallel_read_safe": True}
