"""The pages `/records` and `/records/{run}`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from nicegui import ui

from muster.mission.errors import MusterError
from muster.state.words import DETAIL, deed_of, line_of, mark_of
from muster_control.contract import MOST_ROWS, OVER, PAGE_ROWS, Action, Entry, Run
from muster_control.pages.frame import frame
from muster_control.pages.notices import errors_shown, words_of
from muster_control.pages.records.figures import (
    ROBOT_HEADS,
    TASK_HEADS,
    cancelled_rows,
    lost_rows,
    objective,
    robot_rows,
    seconds,
    task_rows,
)
from muster_control.pages.tables import address, pager_text, search_text, table
from muster_control.pages.visitor import PATIENCE_S, is_seen, the_services

KEYS = {
    "space, arrows, home, end": "in the replay: play or pause, go through time (after a click or Tab into it)",
}
_HEADS = (
    "run",
    "mission",
    "state",
    "tasks done",
    "lost",
    "cancelled",
    "mission time",
    "objective",
    "when",
    "started by",
)
_FILES = (
    ("Record (MCAP)", "record.mcap"),
    ("Replay (HTML)", "page.html"),
    ("Spreadsheets (CSV, zipped)", "export?to=csv"),
    ("Log (JSON)", "export?to=json"),
)
_ON_EARTH = (("GeoJSON", "export?to=geojson"), ("KML", "export?to=kml"), ("GPX", "export?to=gpx"))
"""Formats that need to know where on the earth the mission is."""

ui.add_css(Path(__file__).with_name("records.css"), shared=True)


@ui.page("/records", response_timeout=PATIENCE_S)
async def records_page(mission: str = "", before: int | None = None) -> None:
    """Runs that are over, of one mission or all, the newest first; ids below `before`, if given."""
    with frame("Records"), errors_shown():
        runs = await the_services().runs.over(PAGE_ROWS + 1, before, mission or None)
        shown = runs[:PAGE_ROWS]
        _filter(mission)
        if shown:
            table(_HEADS, [_row(run) for run in shown], label="Records", numbers=(3, 4, 5, 6))
        else:
            what = f"of {mission} " if mission else ""
            ui.label(f"There are no records {what}yet: a run is one when it is over.").classes("quiet")
        following = address("/records", mission=mission, before=shown[-1].id) if len(runs) > len(shown) else ""
        _pager(address("/records", mission=mission) if before is not None else "", following)


def _filter(mission: str) -> None:
    """The field for the mission whose records alone are listed."""
    with ui.element("form").props('method="get" action="/records" role="search"').classes("bar"):
        field = search_text("Id of a mission, then Enter", mission, name="mission")
        ui.html(field, sanitize=False).style("display: contents")


def _pager(first: str, following: str) -> None:
    ui.html(pager_text(first, following), sanitize=False)


def _row(run: Run) -> tuple[Any, ...]:
    report = run.report
    when = f"{run.at:%Y-%m-%d %H:%M} UTC"
    figures: tuple[str, ...] = ("", "", "", seconds(run.time_s), "")
    if report is not None:
        counts = (len(tasks) for tasks in (report["tasks_done"], lost_rows(report), cancelled_rows(report)))
        figures = (*map(str, counts), seconds(report["mission_time_s"]), objective(report))
    return (f"Run {run.id}", f"/records/{run.id}"), run.mission, run.state, *figures, when, run.author


@ui.page("/records/{run}", response_timeout=PATIENCE_S)
async def record_page(run: int, after: int = 0, before: int | None = None) -> None:
    """One run that is over; events behind the number `after`, actions with ids below `before`."""
    services = the_services()
    try:
        found = await services.runs.get(run)
    except MusterError as error:
        with frame("Records"):
            ui.label(words_of(error))
        return
    with frame("Records", title=f"{found.mission}, run {run}", keys=KEYS), errors_shown():
        if not await is_seen():
            return
        entries = await services.runs.entries(run, after, MOST_ROWS + 1)
        _head(found, _files_of(found, on_earth=await _is_on_earth(found)) if entries else ())
        if found.state not in OVER:
            with ui.element("p"):
                ui.link("It is still under way: watch it live.", f"/live/{run}")
            return
        if entries:  # a run that failed before it began has no record
            _replay(run)
        _compared(found)
        _events(run, entries, after)
        _commands(run, await services.actions.list(run, MOST_ROWS + 1, before))


async def _is_on_earth(run: Run) -> bool:
    """Whether the run's mission says where on the earth it is."""
    version = await the_services().missions.get(run.mission, run.mission_version)
    return bool((await the_services().missions.read_keys(version.text, "origin_wgs84")).get("origin_wgs84"))


def _files_of(run: Run, *, on_earth: bool) -> Sequence[tuple[str, str]]:
    """The downloads, each with its path."""
    return (*_FILES, *(_ON_EARTH if on_earth else ())) if run.state in OVER else ()


def _head(run: Run, files: Sequence[tuple[str, str]]) -> None:
    with ui.element("header").classes("record-head"):
        with ui.element("div"):
            _heading(f"{run.mission}, run {run.id}", level=2)
            ui.label(_facts(run)).classes("quiet")
            if run.remark:
                ui.label(run.remark).classes("alarm")
        if files:
            with ui.element("nav").classes("downloads").props('aria-label="Downloads"'):
                for name, path in files:
                    ui.link(f"↓ {name}", f"/api/v1/records/{run.id}/{path}").props(f'download="{_file(run.id, path)}"')


def _facts(run: Run) -> str:
    facts = f"{run.state}; plan {run.plan} in the world {run.world}"
    again = f"; went on {run.resumed} times after a stop" if run.resumed else ""
    return f"{facts}, started by {run.author} at {run.at:%Y-%m-%d %H:%M} UTC{again}"


def _file(run: int, path: str) -> str:
    """The name of a download; empty for the server's own, as an export may be one or several files."""
    return f"run-{run}-{path}" if "?" not in path else ""


def _replay(run: int) -> None:
    with ui.element("div").classes("replay"):
        waiting = ui.label("The replay is being made …").classes("quiet")
        page = ui.element("iframe").props(f'src="/api/v1/records/{run}/page.html" title="Replay of run {run}"')
        page.on("load", js_handler=f"() => getHtmlElement({waiting.id})?.remove()")


def _compared(run: Run) -> None:
    report: Mapping[str, Any] | None = run.report
    if report is None:
        return
    for words, head, rows in (("lost", "why", lost_rows(report)), ("cancelled", "when", cancelled_rows(report))):
        if rows:
            _heading(f"Tasks that were {words}")
            table(("task", head), rows, label=f"Tasks that were {words}")
    _heading("Robots, planned against flown")
    table(ROBOT_HEADS, robot_rows(report), label="Robots, planned against flown", numbers=(1, 2, 3))
    with _folded("Tasks, planned against flown"):
        table(TASK_HEADS, task_rows(report), label="Tasks, planned against flown", numbers=range(2, 8))


def _events(run: int, entries: Sequence[Entry], after: int) -> None:
    shown = entries[:MOST_ROWS]
    told = [entry for entry in shown if mark_of(entry.kind, entry.data) != DETAIL]
    lines = [(seconds(entry.time_s), line_of(entry.kind, entry.data)) for entry in told]
    whole = not after and len(entries) == len(shown)
    words = f"Events ({len(shown)})" if whole or not shown else f"Events {shown[0].seq} to {shown[-1].seq}"
    with _folded(words, is_open=after > 0):
        table(("at", "what"), lines, label="Events", numbers=(0,))
        following = address(f"/records/{run}", after=shown[-1].seq) if len(entries) > len(shown) else ""
        _pager(f"/records/{run}" if after else "", following)


def _commands(run: int, found: Sequence[Action]) -> None:
    actions = found[:MOST_ROWS]
    if not actions:
        return
    rows = [
        (
            f"{action.at:%Y-%m-%d %H:%M:%S} UTC",
            action.who,
            deed_of(action.verb.removeprefix("run."), action.data),
            "" if action.applied_s is None else seconds(action.applied_s),
            action.outcome or "not known",
        )
        for action in sorted(actions, key=lambda action: action.id)
    ]
    with _folded(f"What users did ({len(rows)}{'' if len(found) == len(actions) else ', the newest'})"):
        table(("when", "who", "what", "took effect", "outcome"), rows, label="What users did")
        if len(found) > len(actions):
            _pager("", address(f"/records/{run}", before=actions[-1].id))


def _heading(words: str, level: int = 3) -> None:
    with ui.element(f"h{level}"):
        ui.label(words)


def _folded(words: str, *, is_open: bool = False) -> ui.element:
    """A part that is expanded by its heading."""
    details = ui.element("details").props("open" if is_open else "")
    with details, ui.element("summary"):
        ui.label(words)
    return details
