"""Tutorials are stored as text, without outputs, so that a change can be read; the site offers them as notebooks, too.

While the site is built MyST-NB runs each, and an error in a cell ends the build. What the site offers to download is
made of the same text by jupytext, without outputs: whoever opens it makes them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

FOLDER = "docs/tutorials"
FORMAT = "md:myst"
_TITLE = "\n# "


def tutorial_paths(root: Path) -> list[Path]:
    """The files of all tutorials."""
    return sorted((root / FOLDER).glob("*.md"))


def with_download(name: str, text: str) -> str:
    """A tutorial with a line under its title that leads to the notebook; `name` is that of its document."""
    notebook = f"{Path(name).name}.ipynb"
    head, title, rest = text.partition(_TITLE)
    first, _, body = rest.partition("\n")
    link = f'<p class="notebook"><a href="{notebook}" download>Download as a notebook</a></p>'
    return f"{head}{title}{first}\n\n{link}\n{body}"


def _add_download(_: Sphinx, name: str, source: list[str]) -> None:
    if name.startswith(f"{FOLDER}/"):
        source[0] = with_download(name, source[0])


def _write_notebooks(app: Sphinx, error: Exception | None) -> None:
    import jupytext

    if error is None and app.builder.format == "html":
        for path in tutorial_paths(Path(app.srcdir)):
            target = Path(app.outdir) / FOLDER / f"{path.stem}.ipynb"
            jupytext.write(jupytext.read(path, fmt=FORMAT), target, fmt="ipynb")


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.connect("source-read", _add_download)
    app.connect("build-finished", _write_notebooks)
    return {"parallel_read_safe": True}
