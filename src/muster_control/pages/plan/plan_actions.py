"""The actions on a plan: carry it out, download it, upload one, compare it with another.

The dialog that asks at which heights the drones of a mission in the plane fly, for an export.
"""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable, Mapping

from nicegui import events, ui

from muster.mission.errors import ParameterError
from muster.mission.plan import json_text
from muster.planning.export_formats import ALTITUDE_MISSING, FORMATS, RANGES
from muster_control.pages.buttons import once
from muster_control.pages.notices import errors_shown, say, warn
from muster_control.pages.plan.shown_plan import ShownPlan
from muster_control.pages.plan.start_run import open_start
from muster_control.pages.visitor import may_command, on_the_wall, the_services, the_user
from muster_control.services.archives import archive_of
from muster_control.work import WorkError

_ALTITUDE_M = 20.0
_WORDS = (
    "The mission is in the plane and has drones: say how high they fly. Each drone flies higher than the one before it "
    "by the step; with 0 all fly at one height."
)


def open_heights(export: Callable[[Mapping[str, float]], Awaitable[None]]) -> None:
    """Ask for `altitude` and `altitude_step`, in metres, and export with them."""
    with ui.dialog() as dialog, ui.card().classes("making"):
        ui.label("Heights of drones").classes("dialog-title")
        ui.label(_WORDS).classes("quiet")
        fields = {
            "altitude": _metres("Height above the start, m", "altitude", _ALTITUDE_M),
            "altitude_step": _metres("Step between drones, m", "altitude_step", 0.0),
        }

        async def take() -> bool:
            heights = {name: float(field.value or 0.0) for name, field in fields.items()}
            if heights["altitude"] <= 0:
                warn("Height above the start: expected more than 0 m")
                return False
            await export(heights)
            dialog.close()
            return True

        with ui.element("div").classes("dialog-buttons"):
            ui.button("Cancel", on_click=dialog.close).props("flat")
            ui.button("Export", icon="download", on_click=once(take)).props("unelevated")
    dialog.open()


def _metres(label: str, option: str, value: float) -> ui.number:
    low, high = RANGES[option]
    field = ui.number(label, value=value, min=low, max=high)
    return field.props("outlined dense").classes("full")


_FORMATS = {
    "": "Plan file (JSON)",
    "sheets": "Sheets of the robots, to print (PDF)",
    "overview": "The plan on a page, to print (PDF)",
    "xlsx": "Workbook (XLSX)",
    "ics": "Calendar (ICS)",
    "csv": "Table of visits (CSV)",
    "sol": "Solution of vehicle routing (SOL)",
    "geojson": "GeoJSON",
    "kml": "KML",
    "gpx": "GPX",
    "qgc": "QGroundControl",
}
_ON_EARTH = ("geojson", "kml", "gpx", "qgc")
_NOT_ON_EARTH = "needs origin_wgs84 in the mission: where on Earth it is"
_WITHOUT_START = "needs starts_at in the mission: when it begins"
_PICTURES = {"routes": "Picture of the routes (SVG)", "gantt": "Picture of the schedule (SVG)"}
_MOST_BYTES = 16 * 2**20


async def _download(plan: int, form: str, options: Mapping[str, float]) -> None:
    files = await the_services().plans.export(plan, form, options)
    ui.download.content(*await archive_of(files, f"plan-{plan}-{form}"))


class PlanActions:
    """Buttons below a plan."""

    def __init__(self, answer: ShownPlan) -> None:
        self._answer = answer
        self._commands = may_command() and not on_the_wall()
        self._bar = ui.element("div").classes("bar control")
        self.show()

    def show(self, *, on_earth: bool = True, has_start: bool = True) -> None:
        """Show the actions on the present plan.

        Parameters
        ----------
        on_earth, has_start
            whether its mission has a place on the earth, and a time at which it begins.
        """
        self._bar.clear()
        entry = self._answer.entry
        with self._bar:
            if entry is not None and self._commands:
                ui.button("Carry out", icon="play_arrow", on_click=self._start).props('unelevated id="carry-out"')
            if entry is not None:
                self._exports(entry.id, on_earth=on_earth, has_start=has_start)
            others = [other for other in self._answer.entries if entry is not None and other.id != entry.id]
            if others and entry is not None:
                target = f"/plan/{self._answer.mission}/compare?a={others[0].id}&b={entry.id}"
                ui.button("Compare", icon="compare", on_click=lambda: ui.navigate.to(target)).props("outline")
            if self._commands:
                ui.button("Upload a plan", on_click=self._open_upload).props("flat")

    def _exports(self, plan: int, *, on_earth: bool, has_start: bool) -> None:
        lacking = {} if on_earth else dict.fromkeys(_ON_EARTH, _NOT_ON_EARTH)
        lacking |= {} if has_start else {"ics": _WITHOUT_START}
        with ui.dropdown_button("Export", icon="download", auto_close=True).props('outline id="export"'), ui.list():
            for name, words in (_FORMATS | {name: name for name in FORMATS if name not in _FORMATS}).items():
                if name in lacking:
                    with ui.item().props("disable"), ui.item_section():
                        ui.item_label(words)
                        ui.item_label(lacking[name]).props("caption")
                else:
                    ui.item(words, on_click=lambda name=name: self._export(plan, name))
            for what, words in _PICTURES.items():
                ui.item(words, on_click=lambda what=what: self._picture(plan, what))

    async def _export(self, plan: int, form: str) -> None:
        with errors_shown():
            if not form:
                content = json_text((await the_services().plans.get(plan)).plan).encode()
                ui.download.content(content, f"plan-{plan}.json")
                return
            try:
                await _download(plan, form, {})
            except WorkError as error:
                if not str(error).startswith(ALTITUDE_MISSING):
                    raise
                open_heights(lambda heights: _download(plan, form, heights))

    async def _picture(self, plan: int, what: str) -> None:
        with errors_shown():
            ui.download.content(await the_services().plans.picture(plan, what, "svg"), f"{what}-{plan}.svg")

    async def _start(self) -> None:
        entry = self._answer.entry
        if entry is None:
            return
        with errors_shown():
            dimensions = await the_services().missions.dimensions(entry.mission)
            if entry is not self._answer.entry:  # another plan is chosen meanwhile
                return
            open_start(entry, dimensions)

    def _open_upload(self) -> None:
        with ui.dialog() as dialog, ui.card().classes("making"):
            ui.label("Upload a plan of this mission").classes("dialog-title")
            ui.label("A plan file (JSON), also of another program: it needs `schema` and `routes`.").classes("quiet")

            async def take(event: events.UploadEventArguments) -> None:
                with errors_shown():
                    try:
                        plan = json.loads(await event.file.read())
                    except ValueError as error:
                        raise ParameterError(f"{event.file.name}: {error}; expected a plan file (JSON)") from None
                    entry = await the_services().plans.upload(the_user(), self._answer.mission, plan)
                    dialog.close()
                    say("The plan is uploaded.")
                    await self._answer.show_newest(entry.id)

            ui.upload(auto_upload=True, max_file_size=_MOST_BYTES, on_upload=take).props('accept=".json" flat bordered')
            with ui.element("div").classes("dialog-buttons"):
                ui.button("Close", on_click=dialog.close).props("flat")
        dialog.open()
