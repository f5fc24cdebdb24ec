"""The README as a package index shows it: links and pictures lead to the project's address, where it has one.

The build asks for it (`tool.dynamic-metadata` in pyproject.toml), whose `address` is the only setting: the
address under which the files of the repository are found, such as `https://example.org/muster/blob/main`. Pictures are
found there with `?raw=true`. Without an address the README is as it is.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

_ROOT = Path(__file__).resolve().parents[1]
_LINK = re.compile(r"(!?)\[([^]]*)\]\((?!https?:|#)([^)\s]+)\)")
_REMARK = re.compile(r"<!-- docs-check:.*?-->\n?", re.DOTALL)


def long_description(text: str, address: str) -> str:
    """A document with absolute links, and without the markers of the check of documents."""
    text = _REMARK.sub("", text)
    return _LINK.sub(lambda found: _absolute(found, address.rstrip("/")), text) if address else text


def _absolute(found: re.Match[str], address: str) -> str:
    picture, words, target = found.groups()
    return f"{picture}[{words}]({address}/{target}{'?raw=true' if picture else ''})"


def dynamic_metadata(settings: Mapping[str, Any], _project: Mapping[str, Any]) -> dict[str, Any]:
    """What scikit-build-core asks for: fields of the package's metadata."""
    text = (_ROOT / "README.md").read_text(encoding="utf-8")
    return {"readme": {"content-type": "text/markdown", "text": long_description(text, settings.get("address", ""))}}
