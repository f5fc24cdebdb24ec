"""The dialog that makes a mission: empty, from a shipped one, or from files."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import PurePath
from typing import Any

from nicegui import events, ui

from muster.mission.yaml_writer import YAML_SUFFIXES, flow_text
from muster.planning.mission_readers import converted_suffixes
from muster_control.contract import MissionVersion
from muster_control.pages.buttons import once
from muster_control.pages.notices import end_warning, errors_shown, warn
from muster_control.pages.visitor import the_services, the_user
from muster_control.services.shipped import shipped_entries
from muster_control.services.uploads import answers_of
from muster_control.work import WorkError
from muster_files.sites.readers import READERS

_UNNAMED = "my mission"
EMPTY = """\
schema: muster/1
name: {name}
rules: {{objective: total+max}}
robots:
  - {{id: r_0, position: [0, 0], speed_mps: 1}}
  - {{id: r_1, position: [3, 0], speed_mps: 1}}
tasks:
  - {{id: 1, position: [5, 8]}}
"""
EMPTY_IN_SPACE = """\
schema: muster/1
name: {name}
rules: {{objective: total+max}}
robots:
  - {{id: r_0, kind: air, position: [0, 0, 0], speed_mps: 2}}
  - {{id: r_1, kind: air, position: [3, 0, 0], speed_mps: 2}}
tasks:
  - {{id: 1, position: [5, 8, 4]}}
"""
_STARTS = {
    "": (EMPTY, "A small start: two robots, one task"),
    "/3-D": (EMPTY_IN_SPACE, "A small start in 3-D: two drones, one task"),
}
_SITES = tuple(f".{name}" for name in READERS.shipped)
_CONVERTED = converted_suffixes()
_ACCEPT = ",".join((*YAML_SUFFIXES, *_SITES, *_CONVERTED, ".png,.pgm,.jpg"))
_MOST_BYTES = 16 * 2**20
_REJECTED = "entries => emit(entries.map(entry => [entry.failedPropValidation, entry.file.name, entry.file.size]))"
_CSV = (  # as `mission.reading.thesis_csv` reads them
    "Tasks: index, x, y, type, actuation_cost, prerequisites; also z, duration_s, window_s, deadline_s, due_s, "
    "robots_needed.",
    "Robots, in a file with the word robots in its name: id, type, x, y, work_capacity; also z.",
    "Suitability, if types matter, in a file with that word in its name: robot types in the first column, "
    "task types in the first line.",
)


async def open_new_mission() -> None:
    """Open the dialog; the mission that is made is opened in Plan."""
    with errors_shown():
        shipped = await asyncio.to_thread(shipped_entries)
        with ui.dialog() as dialog, ui.card().classes("making"):
            ui.label("New mission").classes("dialog-title")
            name = ui.input("Name", placeholder=_UNNAMED).classes("full")
            name.props("outlined dense autofocus stack-label hint='Left empty, a file gives its own name'")
            start = ui.select(
                {name: words for name, (_, words) in _STARTS.items()} | dict(zip(shipped, shipped, strict=True)),
                value="",
                label="Begin with",
                with_input=True,
            )
            start.props("outlined dense").classes("full")
            work = _Work()

            async def make() -> None:
                with work.seen(f"Making {start.value or 'the mission'} …"):
                    await _make(name.value or "", start.value or "")

            with ui.element("div").classes("dialog-buttons"):
                ui.button("Cancel", on_click=dialog.close).props("flat")
                ui.button("Make it", on_click=once(make)).props("unelevated")
            ui.separator()
            _uploading(lambda: (name.value or "").strip(), work)
            work.place()
        dialog.open()


class _Work:
    """What is being done, with a sign that it goes on; at the end of the dialog."""

    def __init__(self) -> None:
        with ui.row().classes("small").props('role="status"') as self._row:
            ui.spinner(size="1.2em")
            self._words = ui.label()
        self._row.visible = False

    def place(self) -> None:
        """Move it to the end of what is shown."""
        self._row.move()

    def begin(self, words: str) -> None:
        """Show it, and end the error of what was tried before."""
        end_warning()
        self._words.text = words
        self._row.visible = True

    @contextmanager
    def seen(self, words: str) -> Iterator[None]:
        """Show it as long as the block lasts."""
        self.begin(words)
        try:
            yield
        finally:
            if not self._row.is_deleted:
                self._row.visible = False


def _uploading(name_of: Callable[[], str], work: _Work) -> None:
    ui.label("Or from a file").classes("dialog-title")
    ui.label(
        "A mission (YAML, with the files that it names), the files of a site (CSV, XLSX, GeoJSON, KML, GPX, "
        "GeoPackage; chosen together), an instance file (TSPLIB, VRPLIB, Solomon, ...), or a plan of QGroundControl."
    ).classes("quiet small")
    with ui.element("details").classes("more small"):
        with ui.element("summary"):
            ui.label("What CSV files need")
        for words in _CSV:
            ui.label(words)
    salesmen = ui.number("Robots, for a problem of TSPLIB", value=3, min=1, precision=0)
    salesmen.props("outlined dense").classes("full")
    answers = _Answers()
    files: dict[str, bytes] = {}

    async def read() -> None:
        with work.seen(f"Reading {', '.join(files)} …"):
            await _upload(files, int(salesmen.value or 3), name_of(), answers)

    async def take(event: events.MultiUploadEventArguments) -> None:
        files.clear()
        files.update({file.name: await file.read() for file in event.files})
        again.visible = True
        upload.reset()  # else a file that is chosen once more, with others, is left out as already there
        await read()

    upload = ui.upload(
        label="Choose or drop files",
        multiple=True,
        auto_upload=True,
        max_file_size=_MOST_BYTES,
        on_begin_upload=lambda: work.begin("Fetching files …"),
        on_multi_upload=take,
    )
    upload.on("rejected", lambda event: warn(refused(event.args)), js_handler=_REJECTED)
    upload.props(f'accept="{_ACCEPT}" flat bordered').classes("full")
    again = ui.button("Read them again", on_click=once(read)).props("outline dense")
    again.visible = False


class _Answers:
    """What a user says of a site where its files do not: fields that are shown on demand."""

    def __init__(self) -> None:
        with ui.element("details").classes("more small"):
            with ui.element("summary"):
                ui.label("What a site's files do not say")
            self._kinds = ui.input("What features are", placeholder="Search areas=survey; drones=air")
            self._kinds.props("outlined dense stack-label hint='As messages say it after --as'").classes("full")
            self._height = _metric("Height of surveys, m")
            self._fov = _metric("Width of the picture of their cameras, degrees")
            self._width = _metric("Width of their tool, m, without a camera")

    def given(self) -> dict[str, Any]:
        """The answers, as arguments for reading; raises ParameterError for what is none."""
        numbers = {"height_m": self._height.value, "fov_deg": self._fov.value, "width_m": self._width.value}
        return answers_of(self._kinds.value or "", **numbers)


def _metric(label: str) -> ui.number:
    return ui.number(label, min=0).props("outlined dense").classes("full")


def refused(files: Sequence[tuple[str, str, int]]) -> str:
    """Why files were refused, one line each: the reason, the name, and the size in bytes."""
    lines = []
    for wrong, name, size in files:
        if wrong == "max-file-size":
            lines.append(f"{name}: {size / 2**20:.1f} MiB is too large; expected at most {_MOST_BYTES // 2**20} MiB")
        else:
            lines.append(f"{name}: not a kind of file that can be read; expected {_ACCEPT.replace(',', ', ')}")
    return "\n".join(lines)


async def _make(name: str, start: str) -> None:
    missions = the_services().missions
    title = name.strip() or _UNNAMED
    if start not in _STARTS:
        old = await missions.get(start)
        made = await missions.create(the_user(), await named(old.text, title), dict(old.files), title)
    else:
        made = await missions.create(the_user(), _STARTS[start][0].format(name=flow_text(title)), {}, title)
    ui.navigate.to(f"/plan/{made.mission}")


async def named(text: str, name: str) -> str:
    """A mission's text with another name; one that cannot be edited keeps its own."""
    try:
        return str(await the_services().missions.edit(text, "rename", name))
    except WorkError:
        return text


async def _upload(files: dict[str, bytes], salesmen: int, title: str, answers: _Answers) -> None:
    with errors_shown():
        name, beside = sorted_out(list(files))
        options = options_of(name, beside, salesmen)
        options |= answers.given() if PurePath(name).suffix.lower() in (*YAML_SUFFIXES, *_SITES) else {}
        rest = {other: data for other, data in files.items() if other != name}
        upload = the_services().missions.upload
        made = await upload(the_user(), name, files[name], rest, name=title or None, **options)
        end_warning()
        if made.note:
            _tell(made)
        else:
            ui.navigate.to(f"/plan/{made.mission}")


def _tell(made: MissionVersion) -> None:
    """Show what was read from files, and what was chosen, before the mission is opened."""
    with ui.dialog().props("persistent") as dialog, ui.card().classes("making"):
        ui.label(f"{made.mission}: made").classes("dialog-title")
        with ui.element("ul").classes("notes small"):
            for line in made.note.splitlines():
                with ui.element("li"):
                    ui.label(line)
        with ui.element("div").classes("dialog-buttons"):
            ui.button("Open it", on_click=lambda: ui.navigate.to(f"/plan/{made.mission}")).props("unelevated")
    dialog.open()


def options_of(name: str, beside: Mapping[str, str], salesmen: int) -> dict[str, Any]:
    """The options for converting a mission's file, by its kind."""
    kind = PurePath(name).suffix.lower()
    if kind in (".tsp", ".atsp"):
        return {"salesmen": salesmen, "depot": "1"}
    return dict(beside) if kind in (*YAML_SUFFIXES, *_SITES) else {}


def sorted_out(names: list[str]) -> tuple[str, dict[str, str]]:
    """Which of the chosen files are the mission, YAML before files of a site, its robots, and its suitability."""
    beside = {}
    for kind, word in (("robots", "robot"), ("suitability", "suitab")):
        ends = _SITES if kind == "robots" else (".csv",)
        named_so = [name for name in names if name.lower().endswith(ends) and word in name.lower()]
        if named_so and len(names) > 1:
            beside[kind] = named_so[0]
    rest = [name for name in names if name not in beside.values()]
    kinds = (YAML_SUFFIXES, (*_CONVERTED, *_SITES))
    rest.sort(key=lambda name: next((k for k, ends in enumerate(kinds) if name.lower().endswith(ends)), len(kinds)))
    return rest[0], beside
