"""docs/extending-rules.md names every source file that its example, `min_tasks`, touches, and they are few."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
HOUSE = ROOT / "src" / "muster"
PAGE = (ROOT / "docs" / "extending-rules.md").read_text(encoding="utf-8")
MADE = {"mission/muster-1.schema.json", "core/_core.pyi"}
MOST = 10


def _named() -> set[str]:
    """The files of the page's tables: the first cell of a row is one in backquotes, with its folder."""
    return set(re.findall(r"^\| `([\w/]+/[\w.-]+)` \|", PAGE, re.MULTILINE))


def _touched() -> set[str]:
    files = [path for path in HOUSE.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    found = (path for path in files if re.search(rb"min.?tasks", path.read_bytes(), re.IGNORECASE))
    return {path.relative_to(HOUSE).as_posix() for path in found}


def test_the_page_names_every_file_that_the_rule_touches():
    assert _touched() == _named()
    assert _named() >= MADE
    assert len(_named() - MADE) <= MOST
