"""The versions of a mission: what changed from one to another, and going back to one."""

from __future__ import annotations

import asyncio
import difflib
from collections.abc import Awaitable, Callable, Iterable, Sequence
from html import escape

from nicegui import ui

from muster_control.contract import PAGE_ROWS, VersionEntry
from muster_control.pages.editing.draft import Draft
from muster_control.pages.missions.view import ago
from muster_control.pages.notices import errors_shown
from muster_control.pages.visitor import the_services

_MOST_LINES = 20_000  # of two texts that are compared
Act = Callable[[int], Awaitable[None]]
_CLASSES = {"+": "added", "-": "removed", "@": "quiet"}


async def open_versions(draft: Draft, save: Callable[[str], Awaitable[bool]]) -> None:
    """List the newest versions; one can be compared with the text as it is, and restored as a new version."""
    with errors_shown():
        versions = await the_services().missions.versions(draft.id, PAGE_ROWS + 1)
        with ui.dialog() as dialog, ui.card().classes("making versions"):
            ui.label(f"Versions of {draft.id}").classes("dialog-title")

            async def restore(number: int) -> None:
                with errors_shown():
                    old = await the_services().missions.get(draft.id, number)
                    dialog.close()
                    draft.load(draft.base, old.text)
                    await save(f"version {number} again")

            async def compare(number: int) -> None:
                with errors_shown():
                    await open_differences((await the_services().missions.get(draft.id, number)).text, draft.text)

            def listed(found: Sequence[VersionEntry]) -> None:
                """Add a page of versions, and the way to older ones where there are more."""
                with rows:
                    for version in found[:PAGE_ROWS]:
                        _row(version, compare, restore)
                last.set_visibility(len(found) > PAGE_ROWS)
                shown.extend(found[:PAGE_ROWS])

            async def older() -> None:
                with errors_shown():
                    listed(await the_services().missions.versions(draft.id, PAGE_ROWS + 1, shown[-1].version))

            shown: list[VersionEntry] = []
            with ui.element("div").classes("scrolling full"):
                rows = ui.element("table").classes("plain")
                last = ui.button("Older versions", on_click=older).props("flat dense no-caps")
            listed(versions)
            with ui.element("div").classes("dialog-buttons"):
                ui.button("Close", on_click=dialog.close).props("flat")
        dialog.open()


def _row(version: VersionEntry, compare: Act, restore: Act) -> None:
    with ui.element("tr"):
        for text in (f"version {version.version}", version.author, version.note):
            with ui.element("td"):
                ui.label(text)
        with ui.element("td").classes("quiet"):
            ui.label(ago(version.at) if version.at else "")
        with ui.element("td").classes("acts"):
            ui.button("Compare", on_click=lambda: compare(version.version)).props("flat dense")
            ui.button("Restore", on_click=lambda: restore(version.version)).props("flat dense")


async def open_differences(old: str, new: str) -> None:
    """Show which lines a new text has that an old one has not, and the other way about."""
    lines = await asyncio.to_thread(differences, old, new)
    with ui.dialog() as dialog, ui.card().classes("making wide-dialog"):
        ui.label("Old (-) and new (+)").classes("dialog-title")
        ui.html(marked(lines or ["No line is different."]), tag="pre", sanitize=False).classes("differences full")
        with ui.element("div").classes("dialog-buttons"):
            ui.button("Close", on_click=dialog.close).props("flat")
    dialog.open()


def marked(lines: Iterable[str]) -> str:
    """Lines as one piece of HTML, as there may be 20,000: each marked by its sign."""
    return "".join(f'<div class="{_CLASSES.get(line[:1], "")}">{escape(line)}</div>' for line in lines)


def differences(old: str, new: str) -> list[str]:
    """Lines of the two texts that differ, with a few around them; of huge texts that they differ."""
    before, after = old.splitlines(), new.splitlines()
    if len(before) + len(after) > _MOST_LINES:
        return [] if old == new else ["The texts differ, and are too long to be compared here."]
    return list(difflib.unified_diff(before, after, "old", "new", lineterm="", n=2))[2:]
