"""Sheets and overview as PDF: what stands on which page, in all scripts, always in the same bytes."""

import sys

import pypdfium2
import pytest
from tests.muster_files.sheets.crew import CREW, crew

from muster import load, verify
from muster.mission.errors import MissingExtraError
from muster.mission.reading.plan_reader import plan_of
from muster.planning.export_formats import ExportOptions
from muster.planning.exporting import exported


def pages(pdf: bytes) -> list[str]:
    """The text of each page."""
    with pypdfium2.PdfDocument(pdf) as document:
        return [page.get_textpage().get_text_range() for page in document]


def printed(given, form, **options):
    mission, verdict, plan = given
    return exported(mission, verdict, form, ExportOptions(**options), plan)


def written(folder, text, routes):
    (folder / "m.yaml").write_text(text, encoding="utf-8")
    mission = load(folder / "m.yaml")
    return mission, verify(mission, plan_of(routes)), None


@pytest.mark.long
def test_a_page_for_each_robot(tmp_path):
    files = printed(crew(tmp_path), "sheets")
    assert (list(files.contents), files.messages) == (["sheets.pdf"], ())
    r, s, t, u, idle = pages(files.contents["sheets.pdf"])
    for word in ("take on board 2", "[pad]", "23:59:40", "a free slot", "charge 60 m", "35.530000, 24.060441"):
        assert word in r
    assert "100 of 100 m, never below 10" in r
    assert "planned by by hand" in s
    assert "due +1 00:00:02, 3 s late" in t.replace("\r\n", " ")
    assert "back at its start" in u
    assert "No stops: this robot stays where it is." in idle


@pytest.mark.long
@pytest.mark.parametrize("form", ["sheets", pytest.param("overview", marks=pytest.mark.long), "xlsx", "ics"])
def test_the_same_plan_gives_the_same_bytes(tmp_path, form):
    given = crew(tmp_path)
    assert printed(given, form) == printed(given, form)


@pytest.mark.long
def test_a_file_for_each_robot_that_has_stops(tmp_path):
    files = printed(crew(tmp_path), "sheets", per_robot=True)
    assert list(files.contents) == ["r.pdf", "s.pdf", "t.pdf", "u.pdf"]
    assert files.messages == ("idle: no stops, no file",)
    assert [len(pages(content)) for content in files.contents.values()] == [1, 1, 1, 1]


@pytest.mark.long
def test_a_long_table_goes_on_under_its_headings(tmp_path):
    tasks = "".join(f"  - {{id: task{k}, position: [{k}, 1]}}\n" for k in range(60))
    text = f"schema: muster/1\nname: long\nrobots: [{{id: r, position: [0, 0]}}]\ntasks:\n{tasks}"
    files = printed(written(tmp_path, text, {"r": [f"task{k}" for k in range(60)]}), "sheets")
    first, *others = pages(files.contents["sheets.pdf"])
    assert len(others) == 2
    assert all(page.startswith(f"r · long, page {k}") for k, page in enumerate(others, 2))
    assert all("what to do" in page for page in (first, *others))
    assert sum(page.count("task") for page in (first, *others)) >= 60
    assert "End of the sheet of r" in others[-1]


@pytest.mark.long
def test_names_of_all_scripts_and_lengths(tmp_path):
    text = """\
schema: muster/1
name: "Αποστολή"
robots: [{id: "Ρομπότ", position: [0, 0]}, {id: "مهمة", position: [3, 0]}, {id: "\U00013000", position: [3, 3]}]
tasks:
  - {id: "σκάψιμο", position: [5, 5], type: "\U00013001 x"}
  - {id: "\U00013002", position: [5, 6], duration_s: 3, robots_needed: 2}
  - {id: "%s", position: [5, 7], prerequisites: ["\U00013002"]}
""" % ("L" * 5000)
    routes = {"Ρομπότ": ["σκάψιμο", "L" * 5000], "مهمة": ["\U00013002"], "\U00013000": ["\U00013002"]}
    given = written(tmp_path, text, routes)
    first, second, third = pages(printed(given, "sheets").contents["sheets.pdf"])
    assert "Ρομπότ" in first
    assert "Αποστολή" in first
    assert "type ? x" in first
    assert "the end of task #2" in first.replace("\r\n", " ")
    assert "robot #3" in second
    assert third.startswith("robot #3")
    assert "…" in first
    assert pages(printed(given, "overview").contents["overview.pdf"])


@pytest.mark.long
def test_the_overview_has_figures_robots_and_what_is_left_out(tmp_path):
    (page,) = pages(printed(crew(tmp_path), "overview").contents["overview.pdf"])
    for word in (
        "tasks done 5 of 6",
        "Left out: 1 of 6 tasks",
        "skill, for every robot",
        "2 tasks, 1 call at a station",
    ):
        assert word in page


@pytest.mark.long
def test_the_overview_of_many_robots_and_tasks_left_out_goes_on(tmp_path):
    robots = "".join(f"  - {{id: r{k}, position: [{k}, 0, 1]}}\n" for k in range(40))
    tasks = "".join(f"  - {{id: task{k}, position: [{k}, 5, 2]}}\n" for k in range(30))
    text = f"schema: muster/1\nname: large\nrobots:\n{robots}tasks:\n{tasks}"
    found = pages(printed(written(tmp_path, text, {"r0": ["task0"]}), "overview").contents["overview.pdf"])
    assert len(found) > 3
    assert "large, page 2" in found[1]
    assert "r39" in "".join(found)
    assert "the plan does not say" in "".join(found)


@pytest.mark.long
def test_heights_of_drones_stand_on_sheets_and_overview(tmp_path):
    given = crew(tmp_path, CREW.replace("{id: t, ", "{id: t, kind: air, "))
    files = printed(given, "sheets", altitude_step=12.0)
    found = pages(files.contents["sheets.pdf"])
    assert "at least 12 m above its start" in found[2]
    assert "at least 24 m above its start" in found[3]
    assert "(10, 120, 24)" in found[3]
    assert "in the air, 24 m up" in pages(printed(given, "overview", altitude_step=12.0).contents["overview.pdf"])[0]


@pytest.mark.parametrize("form", ["sheets", "overview", "xlsx"])
def test_a_mission_in_space_without_a_type_or_start(form, tmp_path):
    text = (
        "schema: muster/1\nrobots: [{id: d, position: [0, 0, 0], kind: air}]\ntasks: [{id: a, position: [3, 4, 5]}]\n"
    )
    files = printed(written(tmp_path, text, {"d": ["a"]}), form)
    (content,) = files.contents.values()
    assert form == "xlsx" or "(3, 4, 5)" in "".join(pages(content)) or "1 task" in "".join(pages(content))


@pytest.mark.parametrize(("form", "library"), [("sheets", "fpdf"), ("overview", "fpdf"), ("xlsx", "xlsxwriter")])
def test_without_the_extra_it_is_named(form, library, tmp_path, monkeypatch):
    given = crew(tmp_path)
    monkeypatch.setitem(sys.modules, library, None)
    monkeypatch.delitem(sys.modules, "muster_files.sheets.paper", raising=False)
    with pytest.raises(MissingExtraError, match=r"needs an optional part: pip install 'muster-robotics\[sheets\]'"):
        printed(given, form)


@pytest.mark.parametrize(
    ("needed", "widths"),
    [([10, 30], [20, 60]), ([10, 60, 30], [10, 40, 30]), ([10, 200, 100], [10, 35, 35]), ([50, 50], [40, 40])],
)
def test_columns_are_as_wide_as_they_need_as_far_as_there_is_room(needed, widths):
    from muster_files.sheets.paper import fitted  # needs the extra

    assert fitted(needed, 80) == widths
