"""The package's metadata that follow from the project's address: its README as an index shows it, and its links.

The build asks for them (`tool.dynamic-metadata` in pyproject.toml). `address` there is the only setting: that of the
repository, such as `https://example.org/team/muster`. Without one the README is as it is, and there are no links.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

_ROOT = Path(__file__).resolve().parents[1]
_LINK = re.compile(r"(!?)\[([^]]*)\]\((?!https?:|#)([^)\s]+)\)")
_REMARK = re.compile(r"<!-- docs-check:.*?-->\n?", re.DOTALL)
_FILES = "blob/main"  # below the repository's address, as GitHub has it; pictures are found with `?raw=true`
_PLACES = {
    "Homepage": "",
    "Repository": "",
    "Documentation": f"/{_FILES}/docs/index.md",
    "Changelog": f"/{_FILES}/CHANGELOG.md",
    "Issues": "/issues",
}


def long_description(text: str, address: str) -> str:
    """A document with absolute links, and without the markers of the check of documents."""
    text = _REMARK.sub("", text)
    return _LINK.sub(lambda found: _absolute(found, address.rstrip("/")), text) if address else text


def _absolute(found: re.Match[str], address: str) -> str:
    picture, words, target = found.groups()
    return f"{picture}[{words}]({address}/{_FILES}/{target}{'?raw=true' if picture else ''})"


def urls(address: str) -> dict[str, str]:
    """The project's links as an index lists them, by label."""
    return {label: address.rstrip("/") + place for label, place in _PLACES.items()} if address else {}


def dynamic_metadata(settings: Mapping[str, Any], _project: Mapping[str, Any]) -> dict[str, Any]:
    """What scikit-build-core asks for: fields of the package's metadata."""
    address = settings.get("address", "")
    text = (_ROOT / "README.md").read_text(encoding="utf-8")
    return {
        "readme": {"content-type": "text/markdown", "text": long_description(text, address)},
        "urls": urls(address),
    }
