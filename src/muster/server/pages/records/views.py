"""The pages `/records` and `/records/{run}`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from nicegui import ui

from muster.exchange.mission_control import OVER, Action, Entry, Run
from muster.mission.errors import MusterError
from muster.server.pages.frame import frame
from muster.server.pages.notices import errors_shown, words_of
from muster.server.pages.records.figures import (
    ROBOT_HEADS,
    TASK_HEADS,
    cancelled_rows,
    lost_rows,
    objective,
    robot_rows,
    seconds,
    task_rows,
)
from muster.server.pages.tables import table
from muster.server.pages.visitor import PATIENCE_S, is_seen, the_services
from muster.state.words import DETAIL, deed_of, line_of, mark_of

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
_MOST_EVENTS = 2000

ui.add_css(Path(__file__).with_name("records.css"), shared=True)


@ui.page("/records", response_timeout=PATIENCE_S)
async def records_page() -> None:
    """Runs that are over, the newest first."""
    with frame("Records"), errors_shown():
        runs = await the_services().records.list()
        if runs:
            table(_HEADS, [_row(run) for run in runs], label="Records", numbers=(3, 4, 5, 6))
        else:
            ui.label("There are no records yet: a run is one when it is over.").classes("quiet")


def _row(run: Run) -> tuple[Any, ...]:
    report = run.report
    when = f"{run.at:%Y-%m-%d %H:%M} UTC"
    figures: tuple[str, ...] = ("", "", "", seconds(run.time_s), "")
    if report is not None:
        counts = (len(tasks) for tasks in (report["tasks_done"], lost_rows(report), cancelled_rows(report)))
        figures = (*map(str, counts), seconds(report["mission_time_s"]), objective(report))
    return (f"Run {run.id}", f"/records/{run.id}"), run.mission, run.state, *figures, when, run.author


@ui.page("/records/{run}", response_timeout=PATIENCE_S)
async def record_page(run: int) -> None:
    """One run that is over."""
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
        entries = await services.runs.entries(run)
        _head(found, _files_of(found, on_earth=await _is_on_earth(found)) if entries else ())
        if found.state not in OVER:
            with ui.element("p"):
                ui.link("It is still under way: watch it live.", f"/live/{run}")
            return
        if entries:  # a run that failed before it began has no record
            _replay(run)
        _compared(found)
        _events(entries)
        _commands(await services.actions.list(run=run))


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


def _events(entries: Sequence[Entry]) -> None:
    shown = [entry for entry in entries[:_MOST_EVENTS] if mark_of(entry.kind, entry.data) != DETAIL]
    lines = [(seconds(entry.time_s), line_of(entry.kind, entry.data)) for entry in shown]
    with _folded(f"Events ({len(entries)})"):
        table(("at", "what"), lines, label="Events", numbers=(0,))
        if len(entries) > _MOST_EVENTS:
            ui.label(f"The first {_MOST_EVENTS}; the record (MCAP) has all.").classes("quiet")


def _commands(actions: list[Action]) -> None:
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
    with _folded(f"What users did ({len(rows)})"):
        table(("when", "who", "what", "took effect", "outcome"), rows, label="What users did")


def _heading(words: str, level: int = 3) -> None:
    with ui.element(f"h{level}"):
        ui.label(words)


def _folded(words: str) -> ui.element:
    """A part that is expanded by its heading."""
    details = ui.element("details")
    with details, ui.element("summary"):
        ui.label(words)
    return details
