"""The title bar of a mission: name, version, undo, redo, save, history, and the resolution of conflicts."""

from __future__ import annotations

import json

from nicegui import ui

from muster_control.contract import ConflictError
from muster_control.pages.editing.draft import Draft
from muster_control.pages.notices import errors_shown, say
from muster_control.pages.plan.versions import open_differences, open_versions
from muster_control.pages.visitor import may_command, on_the_wall, the_services, the_user


class TitleBar:
    """Shows the state of a draft, and saves it."""

    def __init__(self, draft: Draft) -> None:
        self._draft = draft
        self._editable = may_command() and not on_the_wall()
        self._resolving = False
        with ui.element("div").classes("bar title-bar"):
            self._name = ui.label(draft.id).classes("mission-name")
            self._id = ui.label(draft.id).classes("quiet small")
            self._state = ui.label("").classes("quiet").props('role="status"')
            if self._editable:
                with ui.element("div").classes("bar edits"):
                    self._buttons()
        draft.on_change.append(lambda _: self._show())
        draft.on_wait.append(self._show)
        draft.on_check.append(self._show_name)
        self._show_name()
        self._show()

    def _buttons(self) -> None:
        self._undo = ui.button(icon="undo", on_click=self._draft.undo).props('flat dense id="undo" aria-label="Undo"')
        self._redo = ui.button(icon="redo", on_click=self._draft.redo).props('flat dense id="redo" aria-label="Redo"')
        self._undo.props('title="Undo (Ctrl+Z)"')
        self._redo.props('title="Redo (Ctrl+Y)"')
        save = ui.button("Save", on_click=self._pressed)
        save.props('outline dense id="save" title="Save (Ctrl+S)"')
        ui.button("History", on_click=lambda: open_versions(self._draft, self.save)).props("flat dense")

    def _show_name(self) -> None:
        """The name that the text gives the mission, and the one that it is kept under where that is another."""
        self._name.text = str((self._draft.checked.mission or {}).get("name") or self._draft.id)
        self._id.set_visibility(self._name.text != self._draft.id)

    def _show(self) -> None:
        version = self._draft.base.version
        known = f"version {version}" if version else "shipped with Muster"
        self._state.text = known if self._draft.is_saved else f"{known}, changed"
        if not self._editable:
            return
        _show_idle(self._undo, not self._draft.can_undo)
        _show_idle(self._redo, not self._draft.can_redo)
        unsaved = self._draft.is_editing or not self._draft.is_saved
        ui.run_javascript(f"window.musterUnsaved = {json.dumps(unsaved)}")

    async def _pressed(self) -> None:
        await self._draft.settled()
        if self._draft.is_saved:
            say("Nothing has changed since the last version.")
        await self.save()

    async def save(self, note: str = "") -> bool:
        """Save the text, and say whether it is saved; asks what to do where somebody else has saved since."""
        await self._draft.settled()
        if self._draft.is_saved:
            return True
        with errors_shown():
            try:
                if await self._draft.save(the_user(), note):
                    say(f"Saved as version {self._draft.base.version}.")
            except ConflictError as conflict:
                if not self._resolving:  # it may be asked already: of a save that was on its way before
                    await self._resolve(str(conflict))
        return self._draft.is_saved

    async def _resolve(self, conflict: str) -> None:
        """Ask which text is to be the newest version."""
        client = ui.context.client
        self._resolving = True
        try:
            newest = await the_services().missions.get(self._draft.id)
            mine = self._draft.text
            answer = await self._asked(conflict, newest.text, mine)
        finally:
            self._resolving = False
        if client.is_deleted:  # somebody left the page and not the dialog
            return
        if answer == "theirs":
            self._draft.load(newest)
        elif answer == "mine":
            self._draft.load(newest, mine)
            await self.save("on top of another's version")
        elif answer == "copy":
            made = await the_services().missions.create(the_user(), mine, dict(newest.files), f"{self._draft.id} copy")
            self._draft.load(newest)
            ui.run_javascript("window.musterUnsaved = false")
            ui.navigate.to(f"/plan/{made.mission}")

    async def _asked(self, conflict: str, theirs: str, mine: str) -> str:
        """The user's choice: `theirs`, `mine`, a `copy`, or nothing."""
        client = ui.context.client
        with ui.dialog().props("persistent") as dialog, ui.card().classes("making"):
            ui.label("Somebody else has saved this mission").classes("dialog-title")
            ui.label(f"{conflict}.".replace("..", "."))
            ui.button("See what is different", on_click=lambda: open_differences(theirs, mine)).props("flat")
            with ui.element("div").classes("dialog-buttons"):
                ui.button("Go on editing", on_click=lambda: dialog.submit("")).props("flat")
                ui.button("Take theirs", on_click=lambda: dialog.submit("theirs")).props("outline")
                ui.button("Save mine as a copy", on_click=lambda: dialog.submit("copy")).props("outline")
                ui.button("Save mine on top", on_click=lambda: dialog.submit("mine")).props("unelevated")
        answer = await dialog
        if not client.is_deleted:
            dialog.delete()
        return str(answer or "")


def _show_idle(button: ui.button, idle: bool) -> None:
    """Show whether a button has anything to do; it may be pressed all the same, as an edit may be on its way here."""
    button.props["aria-disabled"] = "true" if idle else "false"
    button.classes(add="idle") if idle else button.classes(remove="idle")
