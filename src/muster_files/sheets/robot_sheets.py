"""The sheets of robots, to print: for each robot a page or more with its figures, a map of its route, and its stops."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from muster.mission.goods import shown_amounts
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.grid import Grid
from muster.planning.export_formats import HEIGHTS, ExportOptions, Files, declares
from muster.report.figures.fonts import Names
from muster.report.maps.floor import map_image
from muster.report.route_lines import RobotLines, robot_lines
from muster.verification import Verdict
from muster_files.file_names import file_names
from muster_files.sheets.content import Line, Sheet, Sheets, sheets_of
from muster_files.sheets.instructions import metres, plain
from muster_files.sheets.wordings import (
    degrees,
    energy,
    mission_facts,
    places_words,
    robot_facts,
    stop_name,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from muster_files.sheets.paper import Paper

_MAP_MM = (105.0, 76.0)


@declares(options=(*HEIGHTS, "per_robot"))
def sheets_files(mission: Mission, verdict: Verdict, options: ExportOptions, plan: Plan | None) -> Files:
    """The sheets of all robots in one PDF, or a PDF for each robot that has stops.

    Raises
    ------
    MissingExtraError
        without the extra `sheets`.
    ParameterError
        if an altitude is for no drone.
    """
    sheets = sheets_of(mission, verdict, options, plan)
    lines = {one.robot.id: one for one in robot_lines(mission, verdict, 2)}
    printer = _Printer(sheets, lines, map_image(mission), Names(mission))
    if not options.per_robot:
        return Files({"sheets.pdf": printer.pages(sheets.robots)}, sheets.notes)
    names = file_names((sheet.robot.id for sheet in sheets.busy), ".pdf")
    idle = tuple(f"{sheet.robot.id}: no stops, no file" for sheet in sheets.robots if not sheet.lines)
    made = {name: printer.pages([sheet]) for name, sheet in zip(names, sheets.busy, strict=True)}
    return Files(made, (*idle, *sheets.notes))


@dataclass(frozen=True)
class _Field:
    """A column of the table of stops: its heading, and what stands in a line."""

    heading: str
    cell: Callable[[Line], str]
    right: bool = False


@dataclass(frozen=True)
class _Printer:
    sheets: Sheets
    lines: dict[str, RobotLines]
    image: Grid | None
    names: Names

    def pages(self, chosen: Sequence[Sheet]) -> bytes:
        """The pages of these sheets."""
        from muster_files.sheets.paper import Paper

        title = self.names.title(self.sheets.mission.name)
        paper = Paper(title, self.names, self._texts(chosen))
        for sheet in chosen:
            paper.begin(f"{self.names.robot(sheet.robot.id)} · {title}")
            self._write_head(paper, sheet)
            self._write_stops(paper, sheet)
        return paper.written()

    def _texts(self, chosen: Iterable[Sheet]) -> Iterator[str]:
        """All that is written on these sheets, to find fonts for it."""
        for _, what in mission_facts(self.sheets):
            yield what
        for sheet in chosen:
            yield sheet.robot.id
            yield from (what for _, what in robot_facts(self.sheets, sheet))
            yield from (field.cell(line) for field in self._fields(sheet) for line in sheet.lines)

    def _write_head(self, paper: Paper, sheet: Sheet) -> None:
        """Title and figures, and on the right the map."""
        top = paper.get_y()
        width = paper.epw - _MAP_MM[0] - 6
        paper.put_picture(self._map(sheet), paper.w - paper.r_margin - _MAP_MM[0], top, _MAP_MM[0])
        paper.write_title(self.names.robot(sheet.robot.id), self.names.title(self.sheets.mission.name), width)
        paper.ln(1)
        paper.write_facts([*robot_facts(self.sheets, sheet), *_of_plan(self.sheets)], width)
        paper.set_y(max(paper.get_y(), top + _MAP_MM[1]) + 2)

    def _write_stops(self, paper: Paper, sheet: Sheet) -> None:
        from muster_files.sheets.paper import Column

        if not sheet.lines:
            paper.write_line("No stops: this robot stays where it is.", bold=True)
            return
        fields = self._fields(sheet)
        columns = [Column(field.heading, field.right) for field in fields]
        paper.write_table(columns, ([field.cell(line) for field in fields] for line in sheet.lines))
        paper.ln(1.5)
        ending = dict(robot_facts(self.sheets, sheet))["ends"]
        paper.write_line(f"End of the sheet of {self.names.robot(sheet.robot.id)}: ends {ending}.", bold=True)
        paper.write_line(f"{self.sheets.times.words} {places_words(self.sheets.mission)}")

    def _fields(self, sheet: Sheet) -> list[_Field]:
        """The columns that have something in them."""
        told, unit, names = self.sheets.times.text, self.sheets.verdict.usage_unit, self.names
        fields = [
            _Field("#", lambda line: str(line.order), right=True),
            _Field("stop", lambda line: stop_name(line, names)),
            _Field("place [m]", lambda line: metres(line.place)),
            _Field("latitude, longitude", lambda line: "" if line.spot is None else degrees(line.spot)),
            _Field("arrive", lambda line: told(line.visit.arrives_s), right=True),
            _Field("begin", lambda line: told(line.visit.starts_s), right=True),
            _Field("end", lambda line: told(line.visit.ends_s), right=True),
            _Field("what to do", lambda line: line.doing),
            _Field("with", lambda line: ", ".join(map(names.robot, line.others))),
            _Field("wait", lambda line: _wait(line), right=True),
            _Field("wait for", lambda line: ", ".join(line.waits_for)),
            _Field("window, deadline, due", lambda line: "; ".join(line.limits)),
            _Field("battery after", lambda line: energy(line, unit), right=True),
            _Field("on board after", self._load),
        ]
        return [field for field in fields if any(field.cell(line) for line in sheet.lines)]

    def _load(self, line: Line) -> str:
        return shown_amounts(line.visit.load_after) if self.sheets.mission.has_goods else ""

    def _map(self, sheet: Sheet) -> Figure:
        from muster.report.figures.canvas import new_axes
        from muster_files.sheets.robot_map import draw_robot_map

        ax = new_axes(_MAP_MM[0] / 25.4, _MAP_MM[1] / 25.4)
        with self.names.fonts():
            draw_robot_map(ax, self.sheets.mission, self.lines[sheet.robot.id], self.image)
        figure: Figure = ax.figure.figure
        return figure


def _of_plan(sheets: Sheets) -> Iterator[tuple[str, str]]:
    """The plan's figures in one line."""
    told = [f"{name} {what}" for name, what in mission_facts(sheets) if name != "mission"]
    yield "plan", "; ".join(told)


def _wait(line: Line) -> str:
    return f"{plain(line.visit.waits_s, 0)} s" if line.waits_for else ""
