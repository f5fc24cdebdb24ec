"""What sources and documents cite is in docs/references.md, and nothing there is cited by nobody."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
REFERENCES = ROOT / "docs" / "references.md"
_KEY = re.compile(r"\[([a-z]+(?:-[a-z]+)*[0-9]{4}|[a-z]+-(?:thesis|paper))\](?!\()")
_SOURCES = sorted(
    [path for path in (ROOT / "src").rglob("*") if path.suffix in (".py", ".cpp", ".hpp", ".yaml")]
    + [path for path in (ROOT / "docs").glob("*.md") if path != REFERENCES]
    + [ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
)


def _cited() -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for path in _SOURCES:
        for key in _KEY.findall(path.read_text(encoding="utf-8")):
            found.setdefault(key, []).append(str(path.relative_to(ROOT)))
    return found


def _listed() -> list[str]:
    return re.findall(r"^- \*\*\[(.+?)\]\*\*", REFERENCES.read_text(encoding="utf-8"), re.MULTILINE)


def test_every_key_that_is_cited_is_listed():
    unknown = {key: files for key, files in _cited().items() if key not in _listed()}
    assert not unknown


def test_every_reference_is_cited():
    assert set(_listed()) <= set(_cited())


def test_references_are_listed_once():
    assert len(_listed()) == len(set(_listed())) > 30


@pytest.mark.parametrize("words", [r"TCF\s+thesis", r"[Aa]uction\s+thesis", r"[Mm]arket\s+paper"])
def test_docstrings_and_comments_cite_by_key(words):
    """A short name may stand in what people are shown, never alone in an explanation of the code."""
    lines = re.compile(rf'^\s*(#|//|""").*{words}', re.MULTILINE)
    code = [path for path in _SOURCES if path.suffix in (".py", ".cpp", ".hpp")]
    assert [path.name for path in code if lines.search(path.read_text(encoding="utf-8"))] == []


def test_nothing_refers_to_a_design_that_readers_do_not_have():
    code = [path for path in _SOURCES if path.suffix in (".py", ".cpp", ".hpp")]
    assert [path.name for path in code if re.search(r"\bDESIGN\b", path.read_text(encoding="utf-8"))] == []


def test_sections_of_the_design_that_sources_name_are_there():
    titles = set(re.findall(r"^## (.+)$", (ROOT / "docs" / "design.md").read_text(encoding="utf-8"), re.MULTILINE))
    named = {
        title
        for path in _SOURCES
        if path.suffix in (".py", ".cpp", ".hpp")
        for title in re.findall(r"docs/design\.md,\s+([A-Z][a-z]+(?:, [a-z]+)*)", path.read_text(encoding="utf-8"))
    }
    assert named
    assert {title for title in named if not any(known.startswith(title.split(",")[0]) for known in titles)} == set()
