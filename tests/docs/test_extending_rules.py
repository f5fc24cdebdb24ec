"""Rules are written in few files; docs/extending-rules.md names every one that its example, `min_tasks`, touches."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HOUSE = ROOT / "src" / "muster"
PAGE = (ROOT / "docs" / "extending-rules.md").read_text(encoding="utf-8")
MADE = {"mission/muster-1.schema.json"}
MOST = 4


def _named() -> set[str]:
    """The files of the page's tables: the first cell of a row is one in backquotes, with its folder."""
    return set(re.findall(r"^\| `([\w/]+/[\w.-]+)` \|", PAGE, re.MULTILINE))


def _touched() -> set[str]:
    files = [path for path in HOUSE.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    found = (path for path in files if re.search(rb"min.?tasks", path.read_bytes(), re.IGNORECASE))
    return {path.relative_to(HOUSE).as_posix() for path in found}


@pytest.mark.parametrize("key", ["min_tasks", "shifts_s", "longest_duty_s", "longest_aboard_s", "either_or"])
def test_a_rule_is_written_once(key):
    """Its key, the rule of planning, the judge's, and what is wrong with values; a line declares that there is one."""
    sources = (path for path in HOUSE.parent.rglob("*") if path.suffix in (".py", ".cpp", ".hpp", ".js"))
    found = {path.relative_to(HOUSE.parent).as_posix() for path in sources if key in path.read_text(encoding="utf-8")}
    assert 3 <= len(found) <= MOST, sorted(found)


def test_the_page_names_every_file_that_the_rule_touches():
    assert _touched() == _named()
    assert _named() >= MADE
    assert len(_named() - MADE) <= MOST
