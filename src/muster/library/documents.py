"""The documents: pages of Markdown that ship with the package, by kind, as docs/index.md lists them; and their site.

An installed package has the pages, and the site if it was built before the package was, in its folder `documents`. In a
clone they are in `docs` and `build/docs/site`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path, PurePosixPath

INDEX = "docs/index.md"
_SECTION = re.compile(r"^## (.+)$", re.MULTILINE)
_ROW = re.compile(r"^\| *(?P<purpose>.+?) *\| *\[(?P<words>[^]]+)\]\((?P<target>[^)#]+\.md)\) *\|$", re.MULTILINE)
_REMARK = re.compile(r"^<!--.*?-->\n?", re.DOTALL | re.MULTILINE)
_FRONT_MATTER = re.compile(r"\A---\n.*?\n---\n", re.DOTALL)
_HEAD = "| when you want to | read |"


@dataclass(frozen=True)
class Entry:
    """A row of docs/index.md: `path` is that of the page from the root of the documents, `words` those of its link."""

    kind: str
    purpose: str
    words: str
    path: str

    @property
    def name(self) -> str:
        """The name by which `muster docs` shows the page."""
        return PurePosixPath(self.path).stem


def read_index(text: str) -> Iterator[Entry]:
    """The rows of all sections of docs/index.md that have a table of pages.

    Raises
    ------
    ValueError
        if a row of such a table does not name one page.
    """
    titles = [*_SECTION.finditer(text)]
    ends = [title.start() for title in titles[1:]] + [len(text)]
    for title, end in zip(titles, ends, strict=True):
        section = text[title.end() : end]
        if _HEAD in section:
            rows = section.split(_HEAD, 1)[1].strip().splitlines()[1:]
            yield from (_entry(title[1], row) for row in rows if row.startswith("|"))


def _entry(kind: str, row: str) -> Entry:
    found = _ROW.match(row)
    if found is None:
        raise ValueError(f"{INDEX}: {row}; expected `| what for | [words](PAGE.md) |`")
    target = found["target"]
    path = target.removeprefix("../") if target.startswith("../") else f"docs/{target}"
    return Entry(kind, found["purpose"], found["words"], path)


def package_folders() -> list[Path]:
    """The folders of the package: of one that is installed editable those in the clone and among the packages."""
    spec = find_spec("muster")
    return [Path(home) for home in (spec.submodule_search_locations or ())] if spec is not None else []


def documents_root() -> Path | None:
    """The folder that holds `README.md` and `docs`, a clone before what is installed; None where there are none."""
    homes = package_folders()
    roots = [*(home.parents[1] for home in homes), *(home / "documents" for home in homes)]
    return next((root for root in roots if (root / INDEX).is_file()), None)


def documents() -> tuple[Entry, ...]:
    """The pages in the order of docs/index.md; none where they were not installed."""
    root = documents_root()
    return () if root is None else tuple(read_index((root / INDEX).read_text(encoding="utf-8")))


def document_text(entry: Entry) -> str:
    """The Markdown of a page.

    Raises
    ------
    FileNotFoundError
        if the installation lacks the page.
    """
    root = documents_root()
    if root is None:
        raise FileNotFoundError(entry.path)
    return (root / entry.path).read_text(encoding="utf-8")


def site_page(entry: Entry | None = None) -> Path | None:
    """The page of the site for the browser, its front page without an entry; None where there is no site."""
    root = documents_root()
    if root is None:
        return None
    name = "index.html" if entry is None else str(PurePosixPath(entry.path).with_suffix(".html"))
    return next(
        (site / name for site in (root / "site", root / "build" / "docs" / "site") if (site / name).is_file()), None
    )


@dataclass(frozen=True)
class Found:
    """A line of a page that holds what was looked for, and the heading that it stands under."""

    entry: Entry
    section: str
    line: str


def find_in_documents(words: str) -> Iterator[Found]:
    """The lines of all pages that hold all of some words, whatever their case."""
    wanted = words.casefold().split()
    for entry in documents():
        section = ""
        for line in readable_text(document_text(entry)).splitlines():
            section = line.lstrip("# ") if line.startswith("#") else section
            if all(word in line.casefold() for word in wanted):
                yield Found(entry, section, line.strip())


def readable_text(text: str) -> str:
    """A page for a reader: without the markers of the check of documents, and without what notebooks alone need."""
    text = _FRONT_MATTER.sub("", _REMARK.sub("", text))
    return text.replace("```{code-cell} python", "```python").lstrip("\n")
