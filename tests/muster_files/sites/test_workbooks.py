"""Workbooks of sites: sheets, types of cells, cells without values; and what is said of what is wrong."""

import datetime

import pytest
from tests.muster_files.sites import writers

from muster import MissionError, read_site


def test_a_workbook_with_robots_on_a_second_sheet(tmp_path):
    book = tmp_path / "site.xlsx"
    writers.write_workbook(
        book,
        {
            "Panels": [
                ["Panel ID", "GPS", "Duration", "Opens", "Deadline", "Flag"],
                [
                    1,
                    "47.3775, 8.5417",
                    datetime.time(0, 15),
                    datetime.time(10, 0),
                    datetime.datetime(2027, 3, 1, 17),
                    True,
                ],
                [],
                [2, "47.3770, 8.5425", "00:05", None, None, None],
            ],
            "Robots": [
                ["Robot", "Latitude", "Longitude", "Skills", "Shift"],
                ["r1", 47.3768, 8.5416, "a, b", "08:00-18:00"],
            ],
            "Read me": [["of this workbook"], ["remarks"]],
        },
    )
    found = read_site(book, starts_at="2027-03-01T08:00")
    (robot,), (first, second) = found.mission.robots, found.mission.tasks
    assert (robot.id, robot.skills, robot.available_until_s) == ("r1", ("a", "b"), 36000)
    assert (first.id, first.duration_s, first.window_s, first.deadline_s) == ("1", 900, ((7200, None),), 32400)
    assert (second.id, second.duration_s) == ("2", 300)
    assert f"{book}, Read me: passed over, it has no places" in found.notes


def test_a_cell_of_a_workbook_is_named_by_sheet_and_row(tmp_path):
    book = tmp_path / "site.xlsx"
    writers.write_workbook(book, {"Robots": [["id", "x", "y", "speed"], ["r", 0, 0, "fast"]]})
    with pytest.raises(MissionError, match=r"site.xlsx:2: sheet Robots, speed: fast; expected a number in m/s, km/h"):
        read_site(book)


def test_cells_of_workbooks_without_values_are_named(tmp_path):
    book = tmp_path / "site.xlsx"
    rows = [
        ["name", "x", "y", "duration", "remark"],
        ["a", '=1+1&"<"', "#DIV/0!", None, "=A2"],
        ["b", 1, 2, "=NOW()", None],
    ]
    writers.write_workbook(
        book, {"Robots": [["id", "x", "y"], ["r", 0, 0]], "Tasks": [[], *[[None, *r] for r in rows]]}
    )
    with pytest.raises(MissionError) as caught:
        read_site(book)
    stored, error = "open the workbook in the spreadsheet program and save it", "a value in place of this error"
    told = [(f.line, f.field, f.value) for f in caught.value.findings]
    assert told == [
        (3, "sheet Tasks, x", '=1+1&"<"'), (3, "sheet Tasks, y", "#DIV/0!"), (4, "sheet Tasks, duration", "=NOW()"),
    ]  # fmt: skip
    assert [stored in f.expected for f in caught.value.findings] == [True, False, True]
    assert error in caught.value.findings[1].expected


@pytest.mark.parametrize(
    ("sheet", "rows", "message"),
    [
        ("Stations", [["name", "x", "y", "services"], ["s", 1, 2, "charge"]], "sheet Stations, charge_per_s: missing"),
        ("Stations", [["name", "x", "y"], ["s", 1, 2]], "sheet Stations, services: missing"),
        (
            "Tasks",
            [["name", "x", "y", "duration"], ["a", 1, 2, datetime.datetime(2027, 3, 1, 8, 30)]],
            "sheet Tasks, duration: 2027-03-01 08:30:00; expected a duration",
        ),
    ],
)
def test_what_is_missing_or_wrong_in_a_sheet_is_named(tmp_path, sheet, rows, message):
    book = tmp_path / "site.xlsx"
    writers.write_workbook(book, {"Robots": [["id", "x", "y"], ["r", 0, 0]], sheet: rows})
    with pytest.raises(MissionError, match=f"site.xlsx:2: {message}"):
        read_site(book)


def test_merged_cells_over_rows_of_data_are_told(tmp_path):
    book = tmp_path / "site.xlsx"
    tasks = [["Plan of the year"], ["name", "x", "y", "type"], ["a", 1, 2, "dig"], ["b", 2, 2], ["c", 3, 2]]
    merged = {"Tasks": ["A1:D1", "D3:D5"]}
    writers.write_workbook(book, {"Robots": [["id", "x", "y"], ["r", 0, 0]], "Tasks": tasks}, merged)
    found = read_site(book)
    assert [task.type for task in found.mission.tasks] == ["dig", None, None]
    assert f"{book}, Tasks: merged cells D3:D5: only the first cell of each has its value" in found.notes
