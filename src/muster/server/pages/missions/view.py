"""The list of missions."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from datetime import UTC, datetime
from functools import cache

from nicegui import ui

from muster.exchange.mission_control import MissionEntry
from muster.library import mission_summary
from muster.server.pages.buttons import once
from muster.server.pages.frame import frame
from muster.server.pages.missions.new_mission import named, open_new_mission
from muster.server.pages.notices import errors_shown, offer, say
from muster.server.pages.visitor import PATIENCE_S, may_command, the_services, the_user

Refresh = Callable[[], Awaitable[None]]

_KEYS = {"/": "search", "n": "new mission"}
_FILTER = "event => window.musterFilter(event.target.value, 'missions')"


@ui.page("/", response_timeout=PATIENCE_S)
async def view() -> None:
    """All missions, own ones first."""
    with frame("Missions", keys=_KEYS):
        with ui.element("div").classes("bar"):
            search = (
                ui.element("input")
                .classes("search")
                .props('type="search" placeholder="Search by name" aria-label="Search missions by name" id="search"')
            )
            search.on("input", js_handler=_FILTER)
            if may_command():
                new = ui.button("New mission", icon="add", on_click=open_new_mission).props('unelevated id="new"')
                new.classes("control")

        one_at_a_time = asyncio.Lock()

        @ui.refreshable
        def listed(entries: Sequence[MissionEntry]) -> None:
            _table(entries, refresh)

        async def refresh() -> None:
            """Show the list as it is now. It is read first: two refreshes at a time would each add a table."""
            async with one_at_a_time:  # else an older list could come last
                listed.refresh(await the_services().missions.list())

        with errors_shown():
            listed(())
            await refresh()
        ui.label("No mission has such a name.").classes("quiet none-found").props("hidden")


def _table(entries: Sequence[MissionEntry], refresh: Refresh) -> None:
    own = sorted((e for e in entries if not e.shipped), key=lambda e: _when(e.changed_at), reverse=True)
    with (
        ui.element("div").classes("panel scrolling"),
        ui.element("table").classes("plain missions").props('id="missions"'),
    ):
        with ui.element("thead"), ui.element("tr"):
            for name, classes in (
                ("Mission", ""),
                ("Robots", "number"),
                ("Tasks", "number"),
                ("", ""),
                ("Changed", "wide"),
                ("", ""),
            ):
                with ui.element("th").classes(classes).props('scope="col"'):
                    ui.label(name)
        _group("Missions of this server", own, refresh)
        _group("Shipped with Muster", [e for e in entries if e.shipped], refresh)


def _group(title: str, entries: Sequence[MissionEntry], refresh: Refresh) -> None:
    if not entries:
        return
    with ui.element("tbody"):
        with ui.element("tr").classes("group"), ui.element("th").props('colspan="6" scope="rowgroup"'):
            ui.label(title)
        for entry in entries:
            _row(entry, refresh)


def _row(entry: MissionEntry, refresh: Refresh) -> None:
    with _named_row(entry):
        with ui.element("td"):
            ui.link(entry.name, f"/plan/{entry.id}").classes("mission-link")
            if entry.name != entry.id and not entry.shipped:
                ui.label(entry.id).classes("quiet small")
            if entry.shipped:
                ui.label(_about(entry.id)).classes("about")
        for count in (entry.robots, entry.tasks):
            with ui.element("td").classes("number"):
                ui.label(str(count))
        with ui.element("td").classes("dimensions"):
            ui.label("3-D" if entry.dimensions == 3 else "").classes("quiet")
        with ui.element("td").classes("wide quiet"):
            ui.label(f"version {entry.version}, {ago(entry.changed_at)}" if entry.version and entry.changed_at else "")
        with ui.element("td").classes("acts"):
            if may_command():
                _acts(entry, refresh)


@cache
def _about(shipped: str) -> str:
    """A shipped mission in one line."""
    return mission_summary(shipped).description


def _named_row(entry: MissionEntry) -> ui.element:
    row = ui.element("tr")
    row.props["data-name"] = f"{entry.name} {entry.id}".lower()
    return row


def _acts(entry: MissionEntry, refresh: Refresh) -> None:
    async def duplicate() -> None:
        missions = the_services().missions
        old = await missions.get(entry.id)
        name = f"{entry.name} copy"
        new = await missions.create(the_user(), await named(old.text, name), dict(old.files), name)
        say(f"{new.mission} is a copy of {entry.name}.")
        await refresh()

    async def delete() -> None:
        with errors_shown():
            await the_services().missions.delete(the_user(), entry.id)
            offer(f"{entry.name} is deleted.", "Undo", restore)  # before the row that this handler belongs to goes
            await refresh()

    async def restore() -> None:
        with errors_shown():
            await the_services().missions.restore(the_user(), entry.id)
            await refresh()

    _icon("content_copy", f"Duplicate {entry.name}", once(duplicate))
    if not entry.shipped:
        _icon("delete_outline", f"Delete {entry.name}", delete)


def _icon(icon: str, label: str, act: object) -> None:
    button = ui.button(icon=icon, on_click=act).props("flat round dense size=sm")  # type: ignore[arg-type]
    button.props["aria-label"] = label
    button.props["title"] = label


def _when(at: datetime | None) -> datetime:
    return at or datetime.fromtimestamp(0, UTC)


def ago(at: datetime, now: datetime | None = None) -> str:
    """How long ago a time is, in words; a date where that is more than a week."""
    seconds = ((now or datetime.now(UTC)) - at).total_seconds()
    if seconds < 60:
        return "just now"
    for unit, size, most in (("minute", 60, 60), ("hour", 3600, 24), ("day", 86400, 8)):
        count = int(seconds // size)
        if count < most:
            return f"{count} {unit}{'s' if count > 1 else ''} ago"
    return at.date().isoformat()
