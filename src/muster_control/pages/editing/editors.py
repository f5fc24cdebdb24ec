"""Map, form and text: three editors of the same draft, on the left of the view *Plan*."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from nicegui import events, ui

from muster.mission.errors import MusterError
from muster_control.pages.editing.draft import Draft
from muster_control.pages.editing.findings import Findings
from muster_control.pages.editing.form import Form
from muster_control.pages.editing.text_view import TextView
from muster_control.pages.editing.zone_form import open_zone
from muster_control.pages.map import MissionMap
from muster_control.pages.map.ground import ground_of
from muster_control.pages.notices import errors_shown, warn, words_of
from muster_control.pages.visitor import may_command, on_the_wall

_MODES = {
    "select": "Move and choose",
    "task": "Add tasks",
    "robot": "Add robots",
    "station": "Add stations",
    "zone": "Draw zones",
}


class Editors:
    """Builds the three editors, and keeps them equal to the draft.

    Parameters
    ----------
    draft
        the mission.
    on_choose
        called with what is chosen on the map: `{what, id}` or None.
    on_ask
        called with a task that is to be explained.
    """

    def __init__(
        self,
        draft: Draft,
        on_choose: Callable[[Mapping[str, Any] | None], None],
        on_ask: Callable[[Mapping[str, Any]], object],
    ) -> None:
        self._draft = draft
        self.map: MissionMap
        self._on_choose = on_choose
        self._on_ask = on_ask
        self._moves = 0  # on the map that came here
        self._form: Form | None = None
        self._script: TextView | None = None
        self._editable = may_command() and not on_the_wall()
        self._build()
        draft.on_check.append(self._show_checked)
        draft.on_change.append(self._show_changed)

    def _build(self) -> None:
        with ui.element("div").classes("workshop-bar control"):
            self._tabs = ui.toggle({"map": "Map", "form": "Form", "text": "Text"}, value="map", on_change=self._turn)
            self._tabs.props('no-caps unelevated dense padding="4px 14px" toggle-color=primary').classes("views")
            self._tabs.props["aria-label"] = "How the mission is shown"
            self._tabs.props["role"] = "group"
            if self._editable:
                self._mode = ui.select(_MODES, value="select", on_change=lambda e: self.map.set_mode(e.value))
                self._mode.props('outlined dense options-dense aria-label="What a click on the map does"')
                self._mode.classes("mode")
        self.findings = Findings(self._reveal)
        self._sides: dict[str, ui.element] = {}
        with ui.element("div").classes("side") as self._sides["map"]:
            self.map = MissionMap(editable=self._editable, label=f"Map of {self._draft.id}")
            self._listen()
        for name in ("form", "text"):
            self._sides[name] = ui.element("div").classes("side").props("hidden")

    def _listen(self) -> None:
        self.map.on("choose", lambda event: self._on_choose(event.args))
        self.map.on("ask", lambda event: self._on_ask(event.args))
        if self._editable:
            self.map.on("move", lambda event: self._moved(event.args))
            self.map.on("add", lambda event: self.edit("add", event.args["what"], *_place(event.args)))
            self.map.on("zone", lambda event: self._drawn(event.args["corners"]))
            self.map.on("leave", lambda _: self._mode.set_value("select"))
            self.map.on("remove", lambda event: self._removed(event.args))

    async def edit(self, change: str, *arguments: object) -> bool:
        """Change the text; if that fails show why, and the present state again."""
        try:
            await self._draft.edit(change, *arguments)
        except MusterError as error:
            warn(words_of(error))
            self._show_checked()
            return False
        return True

    async def _moved(self, one: Mapping[str, Any]) -> None:
        self._moves = int(one["moves"])
        await self.edit("move", one, *_place(one))

    async def _removed(self, one: Mapping[str, Any]) -> None:
        await self.edit("drop", one["what"], one["id"], one.get("corners"))

    async def _drawn(self, corners: Sequence[Sequence[float]]) -> None:
        try:
            ground = (await self._draft.read_keys("map")).get("map")
        except MusterError as error:
            warn(words_of(error))
            self._draft.tell_waiting()
            return
        with self._sides["map"]:
            dialog = open_zone(corners, ground, self.edit)
        dialog.on("hide", self._draft.tell_waiting)  # with the zone, or without

    def _turn(self, event: events.ValueChangeEventArguments[str]) -> None:
        for name, side in self._sides.items():
            side.props(remove="hidden") if name == event.value else side.props("hidden")
        if self._editable:
            self._mode.set_visibility(event.value == "map")
        with self._sides[event.value], errors_shown():
            if event.value == "form" and self._form is None:
                self._form = Form(self._draft, self.edit, editable=self._editable)
            if event.value == "text" and self._script is None:
                self._script = TextView(self._draft, editable=self._editable)
                self._script.mark(self._draft.checked.errors)
        if event.value == "form" and self._form is not None:
            self._form.show()

    def _reveal(self, line: int) -> None:
        self._tabs.set_value("text")
        if self._script is not None:
            self._script.reveal(line)

    def _show_changed(self, kind: str) -> None:
        if self._script is not None and kind != "typed":
            self._script.show(self._draft.text)
        if self._form is not None and self._tabs.value == "form":
            self._form.show()

    def _show_checked(self) -> None:
        checked = self._draft.checked
        self.findings.show(checked)
        if self._script is not None:
            self._script.mark(checked.errors)
        if not self._draft.is_checked:  # the scene of an older text would put back what was moved since
            return
        if checked.mission is not None:
            self.map.show(_scene_of(self._draft), self._moves)
        else:
            self.map.wait("The text has errors; the map is drawn when they are mended.")


def _place(data: Mapping[str, Any]) -> tuple[float, float]:
    """To centimetres, whatever the browser sends."""
    return round(float(data["x"]), 2), round(float(data["y"]), 2)


def _scene_of(draft: Draft) -> dict[str, Any]:
    """Return the scene of a draft that has been read at least once."""
    assert draft.checked.mission is not None
    impossible = [task["task"] for task in draft.checked.impossible]
    return ground_of(draft.checked.mission, draft.checked.floor, draft.base, impossible)
