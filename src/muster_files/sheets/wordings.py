"""The words and columns that sheets have in common, whatever they are printed on."""

from __future__ import annotations

from collections.abc import Iterator

from muster.mission.goods import by_commodity, shown_amounts
from muster.mission.model import Mission
from muster.mission.stations import station_sign
from muster.mission.texts.counting import counted
from muster.report.fonts import Names
from muster_files.earth import Spot
from muster_files.sheets.content import Line, Sheet, Sheets
from muster_files.sheets.instructions import metres, plain


def degrees(spot: Spot) -> str:
    """A place on Earth to a tenth of a metre: `35.530225, 24.060441`, latitude first."""
    return f"{spot.lat:.6f}, {spot.lon:.6f}"


def stop_name(line: Line, names: Names) -> str:
    """The id of the task, or of the station in brackets, as fonts can write it."""
    return station_sign(names.station(line.visit.name)) if line.visit.is_station else names.task(line.visit.name)


def energy(line: Line, unit: str) -> str:
    """What the battery holds after a stop, and what was added there."""
    if line.visit.level_after is None:
        return ""
    charged = "" if not line.visit.charged else f"+{plain(line.visit.charged)}, "
    return f"{charged}{plain(line.visit.level_after)} {unit}"


def mission_facts(sheets: Sheets) -> Iterator[tuple[str, str]]:
    """The figures of the whole plan."""
    verdict, plan = sheets.verdict, sheets.plan
    unit = "s" if verdict.objective_name in ("makespan", "lateness") else verdict.usage_unit
    value = verdict.value()
    yield "mission", sheets.mission.name
    if plan is not None and plan.allocator:
        yield "planned by", plan.allocator + ("" if plan.seed is None else f", seed {plan.seed}")
    yield "tasks done", f"{verdict.tasks_completed} of {verdict.tasks_total}"
    yield "objective", f"{verdict.objective_name} {'none' if value is None else f'{plain(value)} {unit}'}"
    yield "total cost", f"{plain(verdict.total_cost)} {verdict.usage_unit}"
    if verdict.makespan_s is not None:
        yield "ends", f"{sheets.times.text(verdict.makespan_s)} (makespan {plain(verdict.makespan_s)} s)"
    if verdict.waiting_s:
        yield "waiting", f"{plain(verdict.waiting_s)} s in all"
    if verdict.lateness:
        yield "lateness", f"{plain(verdict.lateness)} s"
    if verdict.ignored:
        yield "ignored rules", ", ".join(verdict.ignored)


def robot_facts(sheets: Sheets, sheet: Sheet) -> Iterator[tuple[str, str]]:
    """What there is to know of a robot before it goes."""
    robot, figures, unit = sheet.robot, sheet.figures, sheets.verdict.usage_unit
    kind = "flies" if robot.kind == "air" else "drives"
    yield "robot", f"{robot.type or 'no type'}; {kind} {plain(robot.speed_mps)} m/s"
    yield "starts", _with_degrees(metres(robot.position), sheet.start)
    if sheet.lines:
        yield "leaves", sheets.times.text(figures.leaves_s)
    if sheet.altitude_m is not None:
        yield "height", f"at least {plain(sheet.altitude_m)} m above its start"
    yield "stops", stops_words(sheet)
    limit = "" if figures.capacity is None else f" of {plain(figures.capacity)}"
    yield "usage", f"{plain(figures.usage)}{limit} {unit}"
    if robot.battery is not None:
        reserve = f", never below {plain(robot.battery.least)}" if robot.battery.reserve else ""
        yield "battery", f"{plain(robot.battery.level_at_start)} of {plain(robot.battery.capacity)} {unit}{reserve}"
    if sheets.mission.has_goods:
        most = "" if robot.load_capacity is None else f"; at most {shown_amounts(by_commodity(robot.load_capacity))}"
        yield "on board", f"{shown_amounts(by_commodity(robot.load_at_start))} at first{most}"
    yield from _ending(sheets, sheet)


def _ending(sheets: Sheets, sheet: Sheet) -> Iterator[tuple[str, str]]:
    robot, figures = sheet.robot, sheet.figures
    if not sheet.lines:
        return
    end = robot.place_at_end(sheets.mission.rules)
    if end is None or figures.back_s is None:
        yield "ends", f"at its last stop, {sheets.times.text(figures.stops[-1].ends_s)}"
    else:
        where = "back at its start" if robot.end_position is None else f"at {metres(end)}"
        yield "ends", f"{where}, {sheets.times.text(figures.back_s)}"


def _with_degrees(place: str, spot: Spot | None) -> str:
    return place if spot is None else f"{place}; {degrees(spot)}"


def stops_words(sheet: Sheet) -> str:
    """`5 tasks, 1 call at a station`."""
    tasks = sum(not line.visit.is_station for line in sheet.lines)
    stations = len(sheet.lines) - tasks
    where = "a station" if stations == 1 else "stations"
    return counted(tasks, "task") + (f", {counted(stations, 'call')} at {where}" if stations else "")


def places_words(mission: Mission) -> str:
    """What the numbers of places are, for a line under a table."""
    earth = "" if mission.origin_wgs84 is None else " Degrees: latitude, longitude (WGS 84)."
    axes = "x, y, z" if mission.dimensions == 3 else "x, y"
    return f"Places: ({axes}) in metres, x to the east, y to the north.{earth}"
