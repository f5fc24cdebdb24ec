"""The builder of the site of documents: navigation, reference, notebooks. `make docs` builds the site itself."""

import re
from pathlib import Path

import pytest

import muster

pytest.importorskip("sphinx", reason="needs the dependency group `docs`")
from tools.docs_site.finish import elsewhere, loaded_from_elsewhere, shrink_pictures
from tools.docs_site.navigation import tables_of_contents, with_titles
from tools.docs_site.reference import find, listed_names, names_in, with_directives
from tools.docs_site.tutorials import FORMAT, tutorial_paths, with_download

ROOT = Path(__file__).parents[2]
INDEX = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
REFERENCE = (ROOT / "docs" / "python-reference.md").read_text(encoding="utf-8")
ROW = "| give it walls, shelves and no-fly zones | [maps.md](maps.md) |"


def test_each_section_of_the_index_is_a_table_of_contents():
    tables = tables_of_contents(INDEX)
    assert re.findall(r":caption: (.+)", tables) == [
        "Tutorials", "How-to guides", "Concepts", "Reference", "Measured", "The project",
    ]  # fmt: skip
    assert "\n/docs/tutorials/first-plan\n" in tables
    assert "\nPeers: waiting </docs/benchmarks-waiting>\n" in tables
    assert "\n/CONTRIBUTING\n" in tables


def test_a_page_that_is_listed_twice_ends_the_build():
    from sphinx.errors import ExtensionError

    with pytest.raises(ExtensionError, match=r"lists docs/maps\.md more than once"):
        tables_of_contents(INDEX.replace(ROW, f"{ROW}\n{ROW}"))


def test_links_of_the_index_say_titles_on_the_site():
    assert with_titles(ROW) == "| give it walls, shelves and no-fly zones | [](maps.md) |"
    assert with_titles("| a | [Scale](benchmarks-scale.md) |") == "| a | [Scale](benchmarks-scale.md) |"


def test_the_reference_has_all_that_muster_exports():
    names = listed_names(REFERENCE)
    assert {name.removeprefix("muster.") for name in names if name.count(".") == 1} == set(muster.__all__)
    assert len(names) == len(set(names))


def test_all_that_the_reference_lists_is_there_and_explained():
    assert [name for name in listed_names(REFERENCE) if not (find(name).__doc__ or "").strip()] == []


def test_names_are_known_by_where_they_are_defined():
    assert names_in(ROOT)["muster.mission.robots.Robot"] == "muster.Robot"
    assert "Stop" in names_in(ROOT)


def test_names_become_directives():
    made = with_directives("- `muster.load`\n- `muster.Robot`\n- `muster.PlanError`\n- `other.thing`\n")
    assert re.findall(r"\.\. (\w+):: (\S+)", made) == [
        ("autofunction", "muster.load"),
        ("autoclass", "muster.Robot"),
        ("autoexception", "muster.PlanError"),
    ]
    assert "- `other.thing`" in made


def test_there_are_five_tutorials_and_each_is_a_notebook():
    jupytext = pytest.importorskip("jupytext")
    paths = tutorial_paths(ROOT)
    assert len(paths) == 5
    for path in paths:
        notebook = jupytext.read(path, fmt=FORMAT)
        cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
        assert len(cells) >= 5, path.name
        for cell in cells:
            compile(cell.source, path.name, "exec")
            assert "outputs" not in cell or not cell.outputs


def test_tutorials_offer_their_notebook_under_the_title():
    text = with_download("docs/tutorials/first", "---\na: b\n---\n\n# Title\n\nWords.\n")
    assert text.index("# Title") < text.index('href="first.ipynb"') < text.index("Words.")


@pytest.mark.parametrize(
    "text",
    [
        '<script src="https://cdn.org/a.js"></script>',
        '<link rel="stylesheet" href="https://fonts.org/a.css">',
        '<img alt="" src="//a.org/b.png">',
        "<style>body { background: url(https://a.org/b.png) }</style>",
    ],
)
def test_what_a_page_would_load_from_elsewhere_is_found(text, tmp_path):
    (tmp_path / "a.html").write_text(f'<a href="https://a.org">a</a><script src="_static/a.js"></script>{text}')
    assert len(loaded_from_elsewhere(tmp_path)) == 1
    (tmp_path / "a.html").write_text('<a href="https://a.org">a</a><img src="a.png">')
    assert loaded_from_elsewhere(tmp_path) == []


def test_links_that_leave_the_site_are_listed_with_their_pages(tmp_path):
    for name in ("a.html", "b.html"):
        (tmp_path / name).write_text('<a class="x" href="https://a.org/b">a</a> <a href="c.html">c</a>')
    assert elsewhere(tmp_path) == {"https://a.org/b": ["a.html", "b.html"]}


def test_pictures_get_smaller_and_keep_their_size(tmp_path):
    import numpy as np
    from PIL import Image

    ramp = np.add.outer(np.arange(200), np.arange(300)) % 256
    Image.fromarray(np.stack([ramp, ramp // 2, 255 - ramp], axis=2).astype(np.uint8)).save(tmp_path / "a.png")
    before = (tmp_path / "a.png").stat().st_size
    assert shrink_pictures(tmp_path) == before - (tmp_path / "a.png").stat().st_size
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (300, 200)
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]
