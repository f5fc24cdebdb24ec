"""The workbook: an overview, a worksheet for each robot, cells with types."""

from datetime import datetime, timedelta
from io import BytesIO

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.muster_files.sheets.crew import CREW, crew

from muster.planning.export_formats import ExportOptions
from muster.planning.exporting import exported
from muster_files.sheets.workbook import worksheet_names


def book_of(folder, text=CREW, **options):
    import openpyxl

    mission, verdict, plan = crew(folder, text)
    files = exported(mission, verdict, "xlsx", ExportOptions(**options), plan)
    return openpyxl.load_workbook(BytesIO(files.contents["plan.xlsx"]))


def columns(page):
    """The values below each heading, as far as the stops go."""
    head, *rows = page.iter_rows(values_only=True)
    stops = [row for row in rows if isinstance(row[0], int)]
    return {name: [row[k] for row in stops] for k, name in enumerate(head) if name}


def test_a_worksheet_for_each_robot_after_the_overview(tmp_path):
    assert book_of(tmp_path).sheetnames == ["Overview", "r", "s", "t", "u", "idle"]


def test_cells_have_types(tmp_path):
    book = book_of(tmp_path)
    r = columns(book["r"])
    assert r["#"] == [1, 2, 3]
    assert (r["task"], r["station"]) == (["pier", None, "buoy"], [None, "pad", None])
    assert (r["x [m]"], r["y [m]"]) == ([40, 60, 90], [0, 0, 0])
    assert r["begin"] == [
        datetime(2027, 3, 1, 23, 59, 40),
        datetime(2027, 3, 2, 0, 0, 15),
        datetime(2027, 3, 2, 0, 1, 15),
    ]
    assert (r["wait [s]"], r["wait for"]) == ([None, 15, None], [None, "a free slot", None])
    assert (r["charged [m]"], r["battery after [m]"]) == ([None, 60, None], [60, 100, 70])
    assert r["on board after"] == [2, 2, 0]
    assert r["longitude [deg]"][0] == pytest.approx(24.06044, abs=1e-5)
    assert "with" not in r
    assert columns(book["t"])["with"] == ["u", None]
    assert columns(book["t"])["late [s]"] == [None, 3]


def test_times_without_a_start_are_durations(tmp_path):
    text = CREW.replace("starts_at: 2027-03-01T23:59:00+01:00\n", "")
    assert columns(book_of(tmp_path, text)["s"])["end"] == [timedelta(seconds=75)]


@pytest.mark.parametrize("year", ["0001", "1899", "9999"])
def test_dates_that_workbooks_do_not_know_are_texts(year, tmp_path):
    begin = columns(book_of(tmp_path, CREW.replace("2027-03-01", f"{year}-12-31"))["r"])["begin"]
    assert begin[-1] == "+1 00:01:15" if year != "1899" else datetime(1900, 1, 1, 0, 1, 15)


def test_pages_are_set_up_for_printing(tmp_path):
    page = book_of(tmp_path)["r"]
    assert page.freeze_panes == "C2"
    assert (page.page_setup.orientation, page.page_setup.paperSize) == ("landscape", 9)
    assert (page.sheet_properties.pageSetUpPr.fitToPage, page.page_setup.fitToHeight) == (True, 0)  # width 1: default
    assert page.print_title_rows == "$1:$1"
    assert page.column_dimensions["G"].width > 12


def test_the_overview_has_robots_and_what_is_left_out(tmp_path):
    rows = list(book_of(tmp_path, altitude=9.0)["Overview"].iter_rows(values_only=True))
    by_name = {row[0]: row for row in rows if row[0]}
    assert by_name["tasks done"][1] == "5 of 6"
    assert by_name["u"][2:5] == (9, 2, 0)
    assert by_name["left"][1] == "skill, for every robot"


def test_ids_are_no_formulas(tmp_path):
    import openpyxl

    text = CREW.replace("id: idle", 'id: "=1+1"').replace("task: scan", 'task: "@x"').replace("id: scan", 'id: "@x"')
    (tmp_path / "crew.yaml").write_text(text, encoding="utf-8")
    from muster import load, verify
    from muster.mission.reading.plan_reader import plan_of

    mission = load(tmp_path / "crew.yaml")
    verdict = verify(mission, plan_of({"t": ["@x"], "=1+1": []}))
    files = exported(mission, verdict, "xlsx", ExportOptions())
    book = openpyxl.load_workbook(BytesIO(files.contents["plan.xlsx"]))
    assert "=1+1" in book.sheetnames
    assert book["t"]["B2"].value == "@x"
    assert all(cell.data_type != "f" for page in book for row in page.iter_rows() for cell in row)


@settings(max_examples=200)
@given(st.lists(st.text(min_size=1, max_size=50), unique=True, max_size=8))
def test_names_of_worksheets_are_allowed_and_unique(ids):
    names = worksheet_names(ids)
    assert len({name.casefold() for name in (*names, "overview")}) == len(ids) + 1
    for name in names:
        assert 1 <= len(name.encode("utf-16-le")) / 2 <= 31
        assert not set(name) & set("[]:*?/\\")
        assert name[0] != "'" != name[-1]
