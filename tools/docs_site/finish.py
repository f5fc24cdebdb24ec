"""Finishes the site: a front page, small pictures, a list of what leads out of it.

The site has no network: addresses outside of it are listed, not called. Where a page would load anything from another
address (a script, a font, a style, a picture), the build ends with an error.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util import logging

_LOG = logging.getLogger(__name__)
_ELSEWHERE = re.compile(r'<a\b[^>]*\shref="(https?://[^"]+)"')
_LOADED = re.compile(
    r'<(?:script|img|iframe|source|video)\b[^>]*\ssrc="(?:https?:)?//[^"]*"|<link\b[^>]*\shref="(?:https?:)?//[^"]*"'
    r"|@import\s+[^;]*//[^;]*;|url\(\s*['\"]?(?:https?:)?//[^)]*\)"
)
_FRONT = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>Muster</title>
<meta http-equiv="refresh" content="0; url={target}">
</head>
<body><p><a href="{target}">Muster: documents</a></p></body>
</html>
"""
_COLOURS = 256


def elsewhere(site: Path) -> dict[str, list[str]]:
    """The addresses outside of a site to which its pages lead, with the pages."""
    found: dict[str, list[str]] = {}
    for page in sorted(site.rglob("*.html")):
        for address in _ELSEWHERE.findall(page.read_text(encoding="utf-8")):
            found.setdefault(address, []).append(str(page.relative_to(site)))
    return {address: sorted(set(pages)) for address, pages in sorted(found.items())}


def loaded_from_elsewhere(site: Path) -> list[str]:
    """What pages and styles of a site would load from other addresses, each with its file."""
    files = [*site.rglob("*.html"), *site.rglob("*.css")]
    return sorted(
        f"{file.relative_to(site)}: {found}"
        for file in files
        for found in _LOADED.findall(file.read_text(encoding="utf-8"))
    )


def shrink_pictures(folder: Path) -> int:
    """Write PNGs with as many colours as the eye needs, where that makes them smaller; returns the bytes saved."""
    from PIL import Image

    saved = 0
    for path in folder.glob("*.png"):
        before = path.stat().st_size
        small = path.with_suffix(".small")
        with Image.open(path) as picture:
            picture.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE).save(small, "PNG", optimize=True)
        if small.stat().st_size < before:
            saved += before - small.stat().st_size
            small.replace(path)
        else:
            small.unlink()
    return saved


def _finish(app: Sphinx, error: Exception | None) -> None:
    if error is not None or app.builder.format != "html":
        return
    site = Path(app.outdir)
    (site / "index.html").write_text(_FRONT.format(target=f"{app.config.root_doc}.html"), encoding="utf-8")
    shrink_pictures(site / "_images")
    loaded = loaded_from_elsewhere(site)
    if loaded:
        raise ExtensionError("a page would load what is elsewhere:\n" + "\n".join(loaded))
    links = elsewhere(site)
    listed = "".join(f"{address}\t{', '.join(pages)}\n" for address, pages in links.items())
    site.with_name(f"{site.name}-links.txt").write_text(listed, encoding="utf-8")
    _LOG.info("%d addresses outside of the site, not called: %s-links.txt", len(links), site)


def setup(app: Sphinx) -> dict[str, Any]:
    """What Sphinx calls."""
    app.connect("build-finished", _finish, priority=900)
    return {"parallel_read_safe": True}
