"""A plan on a page to print: its picture, its chart over time, its figures, and the tasks left out with the reasons.

Where there are many robots or tasks left out the tables go on on further pages, and the chart over time has a page of
its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.planning.export_formats import HEIGHTS, ExportOptions, Files, declares
from muster.report.figures.fonts import Names
from muster.report.maps.routes import plot_routes
from muster.report.time_charts.gantt import plot_gantt
from muster.verification import Verdict
from muster_files.sheets.content import Sheet, Sheets, sheets_of
from muster_files.sheets.instructions import metres, plain
from muster_files.sheets.wordings import mission_facts, places_words, stops_words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from muster_files.sheets.paper import Column, Paper

_MAP_WIDTH_MM, _CHART_WIDTH_MM = 126.0, 142.0
_LEAST_HEIGHT_MM, _MOST_HEIGHT_MM = 84.0, 120.0
_LARGE_MM = (270.0, 160.0)
_ROW_MM = 4.8  # of a table
_OTHERS_MM = 62.0  # title, headings, last line and margins
_SHRUNK = 1.2  # pictures are drawn so much larger than they are printed: more names find room
_MOST_ROWS = 12  # robots whose chart is beside the map


@declares(options=HEIGHTS)
def overview_file(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Files:
    """The overview as PDF.

    Raises
    ------
    MissingExtraError
        without the extra `sheets`.
    ParameterError
        if an altitude is for no drone.
    """
    sheets = sheets_of(mission, verdict, options, plan)
    return Files({"overview.pdf": _Printer(sheets, Names(mission)).page()}, sheets.notes)


@dataclass(frozen=True)
class _Printer:
    sheets: Sheets
    names: Names

    def page(self) -> bytes:
        from muster_files.sheets.paper import Paper

        title = self.names.title(self.sheets.mission.name)
        facts = " · ".join(f"{name} {what}" for name, what in mission_facts(self.sheets) if name != "mission")
        robots, left_out = list(self._robots()), list(self._left_out())
        paper = Paper(title, self.names, [facts, *(cell for row in (*robots, *left_out) for cell in row)])
        paper.begin(title)
        paper.write_title(title, facts)
        self._draw(paper)
        paper.write_table(*_used(self._robot_columns(), robots))
        paper.ln(1.5)
        if left_out:
            paper.write_line(f"Left out: {len(left_out)} of {len(self.sheets.mission.tasks)} tasks", bold=True)
            paper.write_table(*_used(self._left_out_columns(), left_out))
            paper.ln(1.5)
        paper.write_line(f"{self.sheets.times.words} {places_words(self.sheets.mission)}")
        return paper.written()

    def _draw(self, paper: Paper) -> None:
        """The map, and beside it the chart over time; that of many robots on the next page."""
        top, left = paper.get_y() + 1, paper.l_margin
        if len(self.sheets.robots) <= _MOST_ROWS:
            height = self._height()
            paper.put_picture(self._map((_MAP_WIDTH_MM, height)), left, top, _MAP_WIDTH_MM)
            chart = self._chart((_CHART_WIDTH_MM, height))
            paper.put_picture(chart, left + _MAP_WIDTH_MM + 4, top, _CHART_WIDTH_MM)
            paper.set_y(top + height + 2)
            return
        paper.put_picture(self._map(_LARGE_MM), left, top, _LARGE_MM[0])
        paper.add_page()
        paper.put_picture(self._chart(_LARGE_MM), left, paper.get_y(), _LARGE_MM[0])
        paper.add_page()

    def _height(self) -> float:
        """How high map and chart are, millimetres, so that the tables have room beneath, as far as that goes."""
        rows = len(self.sheets.robots) + (len(self.sheets.left_out) + 3 if self.sheets.left_out else 0)
        return min(max(210 - _OTHERS_MM - rows * _ROW_MM, _LEAST_HEIGHT_MM), _MOST_HEIGHT_MM)

    def _map(self, size_mm: tuple[float, float]) -> Figure:
        from muster.report.figures.canvas import new_axes

        ax = new_axes(*_inches(size_mm))
        plan = self.sheets.plan or Plan(routes=())
        plot_routes(self.sheets.mission, plan, self.sheets.verdict, ax=ax)
        return _without_title(ax)

    def _chart(self, size_mm: tuple[float, float]) -> Figure:
        from muster.report.figures.canvas import new_axes

        ax = new_axes(*_inches(size_mm))
        plot_gantt(self.sheets.mission, self.sheets.verdict, ax=ax)
        return _without_title(ax)

    def _robot_columns(self) -> list[Column]:
        from muster_files.sheets.paper import Column

        unit = self.sheets.verdict.usage_unit
        titles = ("robot", "type", "moves", "starts [m]", "stops")
        figures = ("leaves", "ends", "waits", f"usage [{unit}]", f"capacity [{unit}]")
        return [Column(title) for title in titles] + [Column(title, right=True) for title in figures]

    def _robots(self) -> Iterator[Sequence[str]]:
        for sheet in self.sheets.robots:
            figures, robot = sheet.figures, sheet.robot
            capacity = "" if figures.capacity is None else plain(figures.capacity)
            place = metres(robot.position)
            shown = (self.names.robot(robot.id), robot.type or "", _moves(sheet), place, stops_words(sheet))
            yield (*shown, *self._span(sheet), plain(figures.usage), capacity)

    def _span(self, sheet: Sheet) -> tuple[str, str, str]:
        """When the robot leaves and ends, and how long it waits; empty for one that stays."""
        if not sheet.lines:
            return "", "", ""
        told, figures = self.sheets.times.text, sheet.figures
        ends = figures.stops[-1].ends_s if figures.back_s is None else figures.back_s
        waits = sum(stop.waits_s for stop in figures.stops)
        return told(figures.leaves_s), told(ends), f"{waits:.0f} s" if waits else ""

    def _left_out_columns(self) -> list[Column]:
        from muster_files.sheets.paper import Column

        return [Column(title) for title in ("task", "type", "place [m]", "why")]

    def _left_out(self) -> Iterator[Sequence[str]]:
        for item in self.sheets.left_out:
            task = item.task
            why = item.why or "the plan does not say"
            yield self.names.task(task.id), task.type or "", metres(task.position), why


def _used(columns: Sequence[Column], rows: Sequence[Sequence[str]]) -> tuple[list[Column], list[list[str]]]:
    """The columns that have something in them, and their cells."""
    used = [k for k in range(len(columns)) if any(row[k] for row in rows)]
    return [columns[k] for k in used], [[row[k] for k in used] for row in rows]


def _moves(sheet: Sheet) -> str:
    robot = sheet.robot
    if robot.kind != "air":
        return "on the ground"
    return "in the air" if sheet.altitude_m is None else f"in the air, {plain(sheet.altitude_m)} m up"


def _inches(size_mm: tuple[float, float]) -> tuple[float, float]:
    """The size of a figure that is printed in so many millimetres."""
    width, height = size_mm
    return _SHRUNK * width / 25.4, _SHRUNK * height / 25.4


def _without_title(ax: Any) -> Figure:
    """The figure without title and facts, which stand on the page."""
    ax.set_title("", loc="left")
    for text in [text for text in ax.texts if text.get_gid() == "facts"]:
        text.remove()
    figure: Figure = ax.figure.figure
    return figure
