"""`muster docs`."""

import json
import re
import sys
import webbrowser

import pytest
from tests.cli.yard import table_rows

from muster.cli.verbs import docs
from muster.library import documents

pytestmark = pytest.mark.usefixtures("folder")
ESCAPE = re.compile(r"\x1b\[[0-9;]*m")


def test_the_pages_are_listed_by_kind(muster):
    code, out, err = muster("docs")
    assert (code, err) == (0, "")
    names = [entry.name for entry in documents.documents()]
    assert [row[0] for row in table_rows(out) if row[0] in names] == names
    assert all(f"\n{kind}" in f"\n{out}" for kind in ("Tutorials", "How-to guides", "Concepts", "Reference"))


def test_the_list_in_json(muster):
    code, out, _ = muster("docs", "--format", "json")
    assert code == 0
    listed = json.loads(out)
    assert {"name", "kind", "purpose", "words", "path", "site"} == set(listed[0])
    assert listed[0]["path"] == "docs/tutorials/first-plan.md"


@pytest.mark.parametrize("name", ["maps", "maps.md", "docs/maps.md", "MAPS"])
def test_a_page_is_written_as_markdown_where_there_is_no_terminal(name, muster):
    code, out, err = muster("docs", name)
    assert (code, err) == (0, "")
    assert out.startswith("# Maps\n")
    assert "docs-check" not in out
    assert "```yaml" in out


def test_a_page_in_json(muster):
    data = json.loads(muster("docs", "maps", "--format", "json")[1])
    assert (data["name"], data["kind"]) == ("maps", "How-to guides")
    assert data["text"].startswith("# Maps\n")


def test_a_terminal_gets_the_page_laid_out_by_the_pager(muster, monkeypatch):
    shown = []
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setattr("click.echo_via_pager", shown.append)
    assert muster("docs", "maps") == (0, "", "")
    assert "Maps" in ESCAPE.sub("", shown[0]).splitlines()[0]


@pytest.mark.parametrize("width", [40, 80, 120])
def test_every_page_is_laid_out_within_the_terminal(width):
    for entry in documents.documents():
        if entry.name in ("limits", "maps", "first-plan", "algorithms"):
            text = documents.readable_text(documents.document_text(entry))
            lines = ESCAPE.sub("", docs.laid_out(text, width)).splitlines()
            assert max(map(len, lines)) <= width


def test_links_and_pictures_become_words():
    text = "See [Actions](actions.md), [maps.md](maps.md#x), [here](#x) and ![a floor](images/floor.png)."
    shown = " ".join(ESCAPE.sub("", docs.laid_out(text, 120)).split())
    assert shown == "See Actions (actions), maps.md, here and [picture: a floor]."


def test_words_are_found(muster):
    code, out, _ = muster("docs", "--find", "MIN_suitability least", "--format", "json")
    assert code == 0
    assert {(at["name"], at["section"]) for at in json.loads(out)} >= {("mission-file", "Keys"), ("design", "Words")}
    assert "mission-file" in muster("docs", "--find", "min_suitability")[1]
    code, out, err = muster("docs", "--find", "xyzzy plugh")
    assert (code, out, err) == (0, "", "no page has xyzzy plugh\n")


def test_a_page_that_is_not_there(muster):
    code, out, err = muster("docs", "mission-fiel")
    assert (code, out) == (2, "")
    assert err == "PAGE: no page mission-fiel; expected one of `muster docs`; did you mean 'mission-file'?\n"


def test_find_goes_alone(muster):
    assert muster("docs", "maps", "--find", "walls")[::2] == (2, "--find: with a PAGE or --open; expected it alone\n")


def test_the_site_is_opened_where_there_is_one(muster, monkeypatch, tmp_path):
    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr(documents, "site_page", lambda entry=None: None)
    code, out, err = muster("docs", "maps", "--open")
    assert (code, out, opened) == (2, "", [])
    assert err == "--open: no site in this installation (`make docs` builds it in a clone); read `muster docs maps`\n"
    page = tmp_path / "maps.html"
    monkeypatch.setattr(documents, "site_page", lambda entry=None: page)
    assert muster("docs", "maps", "--open") == (0, f"{page.as_uri()}\n", "")
    assert opened == [page.as_uri()]


def test_an_installation_without_documents(muster, monkeypatch):
    monkeypatch.setattr(documents, "documents_root", lambda: None)
    code, out, err = muster("docs")
    assert (code, out) == (2, "")
    assert err.startswith("documents: not in this installation; expected")


def test_nothing_to_find_is_refused(muster):
    assert muster("docs", "--find", " ") == (2, "", "--find: no words; expected some to look for\n")
