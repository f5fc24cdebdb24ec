"""The documents that ship, by docs/index.md."""

from pathlib import Path

import pytest

from muster.library import documents
from muster.library.documents import Entry, document_text, find_in_documents, read_index, readable_text, site_page

ROOT = Path(__file__).parents[2]
KINDS = ["Tutorials", "How-to guides", "Concepts", "Reference", "Measured", "The project"]
INDEX = """# Documents

## Tutorials

Words.

| when you want to | read |
|---|---|
| begin | [first.md](tutorials/first.md) |

## The project

| when you want to | read |
|---|---|
| change it | [How to](../CONTRIBUTING.md) |

## Extras

| extra | for |
|---|---|
| `plot` | pictures |
"""


def test_an_index_is_read_by_sections():
    assert list(read_index(INDEX)) == [
        Entry("Tutorials", "begin", "first.md", "docs/tutorials/first.md"),
        Entry("The project", "change it", "How to", "CONTRIBUTING.md"),
    ]


@pytest.mark.parametrize("row", ["| a, b | [a.md](a.md), [b.md](b.md) |", "| a | a.md |", "| a | [a](https://a.org) |"])
def test_a_row_that_does_not_name_one_page_is_an_error(row):
    with pytest.raises(ValueError, match=r"expected `\| what for \|"):
        list(read_index(INDEX.replace("| begin | [first.md](tutorials/first.md) |", row)))


def test_every_page_is_in_one_section():
    listed = [entry.path for entry in documents.documents()]
    pages = [*(ROOT / "docs").glob("*.md"), *(ROOT / "docs" / "tutorials").glob("*.md"), *ROOT.glob("*.md")]
    assert sorted(listed) == sorted(str(page.relative_to(ROOT)) for page in pages if page.name != "index.md")
    assert list(dict.fromkeys(entry.kind for entry in documents.documents())) == KINDS


def test_pages_have_names_of_their_own():
    names = [entry.name.casefold() for entry in documents.documents()]
    assert len(names) == len(set(names))


def test_readers_see_no_markers():
    text = (
        "---\nfile_format: mystnb\n---\n\n# A\n\n<!-- docs-check: skip: a\nreason -->\n```{code-cell} python\n1\n```\n"
    )
    assert readable_text(text) == "# A\n\n```python\n1\n```\n"
    for entry in documents.documents():
        assert "<!--" not in readable_text(document_text(entry)), entry.path


def test_lines_are_found_with_their_headings():
    found = [at for at in find_in_documents("SUITABILITY score of a") if at.entry.name == "design"]
    assert [at.section for at in found] == ["Words"]
    assert list(find_in_documents("no such words anywhere: xyzzy")) == []


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """A package that was installed with its documents, as the build lays them out."""
    package = tmp_path / "muster"
    (package / "documents" / "docs" / "tutorials").mkdir(parents=True)
    (package / "documents" / "docs" / "index.md").write_text(INDEX, encoding="utf-8")
    (package / "documents" / "docs" / "tutorials" / "first.md").write_text("# First\n", encoding="utf-8")
    monkeypatch.setattr(documents, "package_folders", lambda: [package])
    return package / "documents"


def test_an_installed_package_has_its_own_pages(installed):
    first, _ = documents.documents()
    assert document_text(first) == "# First\n"
    assert site_page(first) is None
    page = installed / "site" / "docs" / "tutorials" / "first.html"
    page.parent.mkdir(parents=True)
    page.write_text("<html>", encoding="utf-8")
    assert site_page(first) == page
    assert site_page() is None  # no front page


def test_an_installation_without_documents_has_none(tmp_path, monkeypatch):
    monkeypatch.setattr(documents, "package_folders", lambda: [tmp_path / "site-packages" / "muster"])
    assert documents.documents() == ()
    assert site_page() is None
    with pytest.raises(FileNotFoundError):
        document_text(Entry("Tutorials", "begin", "first.md", "docs/tutorials/first.md"))
