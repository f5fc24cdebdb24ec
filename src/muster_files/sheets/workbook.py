"""A plan as a workbook of spreadsheets (XLSX): an overview, and a worksheet for each robot.

Cells have types: times are dates where the mission says when it starts, else durations; numbers are numbers, and an id
is a text whatever it begins with. Dates are those of the mission's own clock, as workbooks have no zones. The file
holds no time of writing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from io import BytesIO
from typing import Any

from muster.mission.errors import MissingExtraError
from muster.mission.goods import ONLY, shown_amounts
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.export_formats import HEIGHTS, ExportOptions, Files, declares
from muster.verification import Verdict
from muster_files.sheets.content import Line, Sheet, Sheets, sheets_of
from muster_files.sheets.wordings import mission_facts, robot_facts

_EPOCH = datetime(2000, 1, 1)
_YEARS = range(1900, 10000)  # that workbooks know
_LONGEST_NAME = 31  # of a worksheet
_FORBIDDEN = frozenset("[]:*?/\\")
_WIDEST_PX = 380
_A4 = 9
_MOST_CHARACTERS = 32_767  # in a cell


@declares(options=HEIGHTS)
def workbook_file(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Files:
    """The workbook.

    Raises
    ------
    MissingExtraError
        without the extra `sheets`.
    ParameterError
        if an altitude is for no drone.
    """
    try:
        from xlsxwriter import Workbook
    except ImportError:
        raise MissingExtraError("sheets", "a workbook") from None
    sheets = sheets_of(mission, verdict, options, plan)
    written = BytesIO()
    book = Workbook(written, {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False})
    book.set_properties({"title": mission.name, "author": "Muster", "created": _EPOCH})
    pages = _Pages(sheets, book)
    names = worksheet_names([sheet.robot.id for sheet in sheets.robots])
    pages.write_overview()
    for name, sheet in zip(names, sheets.robots, strict=True):
        pages.write_robot(name, sheet)
    book.close()
    return Files({"plan.xlsx": written.getvalue()}, sheets.notes)


Cells = Iterable[tuple[Any, str]]
"""The values of a row, each with its kind."""


@dataclass(frozen=True)
class _Field:
    """A column: its heading, its values, and their kind: a format of `_Pages`."""

    heading: str
    value: Callable[[Line], Any]
    kind: str = "text"


class _Pages:
    """The worksheets of a workbook, and the formats of their cells."""

    def __init__(self, sheets: Sheets, book: Any) -> None:
        self._sheets, self._book = sheets, book
        top = {"valign": "top"}
        self._formats = {
            "text": book.add_format({**top, "text_wrap": True}),
            "whole": book.add_format({**top, "num_format": "0"}),
            "number": book.add_format({**top, "num_format": "0.00"}),
            "degrees": book.add_format({**top, "num_format": "0.0000000"}),
            "date": book.add_format({**top, "num_format": "yyyy-mm-dd hh:mm:ss"}),
            "duration": book.add_format({**top, "num_format": "[h]:mm:ss"}),
        }
        self._head = book.add_format({"bold": True, "bg_color": "#EEEEEE", "bottom": 1, "text_wrap": True, **top})
        self._bold = book.add_format({"bold": True, **top})

    def write_overview(self) -> None:
        """The figures of the plan, a line for each robot, and the tasks left out."""
        page, row = self._book.add_worksheet("Overview"), 0
        for name, what in (*mission_facts(self._sheets), ("times", self._sheets.times.words)):
            page.write_string(row, 0, name, self._bold)
            page.write_string(row, 1, _cut(what))
            row += 1
        unit = self._sheets.verdict.usage_unit
        headings = ("robot", "type", "height above start [m]", "tasks", "stops at stations", "leaves", "ends")
        more = ("waits [s]", f"usage [{unit}]", f"capacity [{unit}]")
        row = self._write_table(page, row + 1, (*headings, *more), map(self._robot, self._sheets.robots))
        if self._sheets.left_out:
            left_out = ([(item.task.id, "text"), (item.why or None, "text")] for item in self._sheets.left_out)
            self._write_table(page, row + 1, ("task left out", "why"), left_out)
        _set_up(page, self._sheets.mission.name)

    def write_robot(self, name: str, sheet: Sheet) -> None:
        """A worksheet of one robot: a line for each stop under a frozen heading, and then its figures."""
        page, lines = self._book.add_worksheet(name), sheet.lines
        fields = [f for f in self._fields() if not lines or any(f.value(line) is not None for line in lines)]
        rows = ([(field.value(line), field.kind) for field in fields] for line in lines)
        row = self._write_table(page, 0, [field.heading for field in fields], rows)
        page.freeze_panes(1, 2)
        page.repeat_rows(0)
        for fact, what in robot_facts(self._sheets, sheet):
            row += 1
            page.write_string(row, 1, fact, self._bold)
            page.write_string(row, 2, _cut(what))
        _set_up(page, f"{self._sheets.mission.name}: {sheet.robot.id}")

    def _robot(self, sheet: Sheet) -> Cells:
        figures, robot = sheet.figures, sheet.robot
        tasks = sum(not line.visit.is_station for line in sheet.lines)
        yield from ((robot.id, "text"), (robot.type, "text"), (sheet.altitude_m, "number"))
        yield from ((tasks, "whole"), (len(sheet.lines) - tasks, "whole"))
        if sheet.lines:
            ends_s = figures.stops[-1].ends_s if figures.back_s is None else figures.back_s
            yield from (self._time(figures.leaves_s), self._time(ends_s))
        else:
            yield from ((None, "text"), (None, "text"))
        waits_s = sum(stop.waits_s for stop in figures.stops)
        yield from ((waits_s, "number"), (figures.usage, "number"), (figures.capacity, "number"))

    def _time(self, seconds: float) -> tuple[Any, str]:
        """A time as a date or a duration, and its kind; as text where workbooks cannot hold it."""
        times = self._sheets.times
        if times.starts_at is None:
            return timedelta(seconds=seconds), "duration"
        moment = times.moment(seconds)
        if moment is None or moment.year not in _YEARS:
            return times.text(seconds), "text"
        return moment.replace(tzinfo=None), "date"

    def _fields(self) -> Iterator[_Field]:
        """The columns of a robot's worksheet."""
        unit, mission = self._sheets.verdict.usage_unit, self._sheets.mission
        yield _Field("#", lambda line: line.order, "whole")
        yield _Field("task", lambda line: None if line.visit.is_station else line.visit.name)
        yield _Field("station", lambda line: line.visit.name if line.visit.is_station else None)
        for k, axis in enumerate("xyz"):
            yield _Field(f"{axis} [m]", lambda line, k=k: (*line.place, None)[k], "number")  # type: ignore[misc]
        yield _Field("latitude [deg]", lambda line: None if line.spot is None else line.spot.lat, "degrees")
        yield _Field("longitude [deg]", lambda line: None if line.spot is None else line.spot.lon, "degrees")
        kind = "duration" if mission.starts_at is None else "date"
        for heading, name in (("arrive", "arrives_s"), ("begin", "starts_s"), ("end", "ends_s")):
            yield _Field(heading, lambda line, name=name: self._time(getattr(line.visit, name))[0], kind)  # type: ignore[misc]
        yield _Field("what to do", lambda line: line.doing)
        yield _Field("with", lambda line: ", ".join(line.others) or None)
        yield _Field("wait [s]", lambda line: line.visit.waits_s if line.waits_for else None, "number")
        yield _Field("wait for", lambda line: ", ".join(line.waits_for) or None)
        yield _Field("window, deadline, due", lambda line: "; ".join(line.limits) or None)
        yield _Field("late [s]", lambda line: line.late_s, "number")
        yield _Field(f"charged [{unit}]", lambda line: line.visit.charged, "number")
        yield _Field(f"battery after [{unit}]", lambda line: line.visit.level_after, "number")
        if mission.has_goods:
            yield _Field("on board after", lambda line: _load(line.visit.load_after))

    def _write_table(self, page: Any, row: int, headings: Sequence[str], rows: Iterable[Cells]) -> int:
        """A heading and rows of values with their kinds; returns the next free row."""
        for column, heading in enumerate(headings):
            page.write_string(row, column, heading, self._head)
        for cells in rows:
            row += 1
            for column, (value, kind) in enumerate(cells):
                self._write(page, row, column, value, kind)
        return row + 1

    def _write(self, page: Any, row: int, column: int, value: Any, kind: str) -> None:
        look = self._formats["text" if isinstance(value, str) else kind]
        if isinstance(value, str):
            page.write_string(row, column, _cut(value), look)
        elif isinstance(value, datetime | timedelta):
            page.write_datetime(row, column, value, look)
        elif value is not None:
            page.write_number(row, column, value, look)


def _set_up(page: Any, heading: str) -> None:
    """Widths of columns as their contents need them; printed on A4, landscape, as wide as the page."""
    page.autofit(max_width=_WIDEST_PX)
    page.set_landscape()
    page.set_paper(_A4)
    page.fit_to_pages(1, 0)
    page.set_margins(left=0.4, right=0.4, top=0.7, bottom=0.6)
    page.set_header(f"&L{_header_text(heading)}")
    page.set_footer("&R&P / &N")


def _header_text(text: str) -> str:
    """A text in the header of a page, where & begins a code; the header has 255 characters at most."""
    return text[:100].replace("&", "&&")


def _load(amounts: Mapping[str, float]) -> Any:
    """What is on board: a number where it has no name, else the amounts with their names."""
    return amounts.get(ONLY, 0.0) if amounts.keys() <= {ONLY} else shown_amounts(amounts)


def _cut(text: str) -> str:
    return text if len(text) <= _MOST_CHARACTERS else f"{text[: _MOST_CHARACTERS - 1]}…"


def worksheet_names(ids: Iterable[str]) -> list[str]:
    """A name for the worksheet of each robot: its id as far as names of worksheets allow; no two are the same.

    Such a name has at most 31 characters, none of those in _FORBIDDEN, no apostrophe at its ends, and is not History.
    """
    taken, names = {"overview", "history"}, list[str]()
    for robot in ids:
        stem = "".join("_" if c in _FORBIDDEN or not c.isprintable() else c for c in robot).strip("' ") or "robot"
        name, k = _short(stem, ""), 2
        while name.casefold() in taken:
            name, k = _short(stem, f"-{k}"), k + 1
        taken.add(name.casefold())
        names.append(name)
    return names


def _short(stem: str, ending: str) -> str:
    """The stem, shortened so that its ending fits; lengths are those of UTF-16, in which workbooks count."""
    while len(f"{stem}{ending}".encode("utf-16-le")) > 2 * _LONGEST_NAME:
        stem = stem[:-1]
    return f"{stem}{ending}".strip("'")
