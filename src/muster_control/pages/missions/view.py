"""The list of missions, page by page."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from datetime import UTC, datetime
from functools import cache
from html import escape

from nicegui import ui
from nicegui.events import GenericEventArguments

from muster.library import mission_summary
from muster_control.contract import PAGE_ROWS, MissionEntry
from muster_control.pages.frame import frame
from muster_control.pages.missions.new_mission import named, open_new_mission
from muster_control.pages.notices import errors_shown, offer, say
from muster_control.pages.tables import address, pager_text, search_text
from muster_control.pages.visitor import PATIENCE_S, may_command, the_services, the_user
from muster_control.services.missions import place_of
from muster_control.store.missions import words_of

_KEYS = {"/": "search", "n": "new mission"}
_SEARCH = """event => {
  const words = event.target.value;
  clearTimeout(window.musterSearch);
  window.musterSearch = setTimeout(() => {
    history.replaceState(null, "", words ? `/?search=${encodeURIComponent(words)}` : "/");
    emit(words);
  }, 200);
}"""
_HEAD = (
    '<thead><tr><th scope="col">Mission</th><th scope="col" class="number">Robots</th>'
    '<th scope="col" class="number">Tasks</th><th scope="col"></th><th scope="col" class="wide">Changed</th>'
    '<th scope="col"></th></tr></thead>'
)
_CLICK = """event => {
  const button = event.target.closest("button[data-act]");
  if (!button) return;
  button.disabled = true; // the list is drawn anew when it is done
  emit({ ...button.dataset });
}"""


@ui.page("/", response_timeout=PATIENCE_S)
async def view(search: str = "", after: str = "") -> None:
    """A page of the missions, own ones first, of which `search` is in the name; behind the place `after`."""
    with frame("Missions", keys=_KEYS):
        with ui.element("div").classes("bar"):
            words = ui.html(search_text("Search missions by name", search), sanitize=False).style("display: contents")
            if may_command():
                new = ui.button("New mission", icon="add", on_click=open_new_mission).props('unelevated id="new"')
                new.classes("control")
        listed = _MissionList(search, after)
        words.on("input", lambda event: listed.search(str(event.args)), js_handler=_SEARCH)
        with errors_shown():
            await listed.show()


class _MissionList:
    """A page of the list as one piece of HTML, which is made in a thread; its buttons say what is to be done."""

    def __init__(self, search: str, after: str) -> None:
        self._search, self._after = search, after
        self._one_at_a_time = asyncio.Lock()  # else an older list could come last
        self._html = ui.html("", sanitize=False)
        if may_command():
            self._html.on("click", self._act, js_handler=_CLICK)

    async def search(self, words: str) -> None:
        """Show the first page of the missions that have these words in their names."""
        self._search, self._after = words, ""
        with errors_shown():
            await self.show()

    async def show(self) -> None:
        """Show the page as it is now."""
        missions, may = the_services().missions, may_command()
        async with self._one_at_a_time:
            found = await missions.list(PAGE_ROWS + 1, self._after, self._search)
            count = await missions.count(self._search)
            text = await asyncio.to_thread(page_text, found, count, self._search, self._after, may=may)
            self._html.set_content(text)

    async def _act(self, event: GenericEventArguments) -> None:
        acts = {"duplicate": self._duplicate, "delete": self._delete}
        try:
            with errors_shown():
                await acts[event.args["act"]](*(str(event.args[key]) for key in ("mission", "name")))
        finally:
            with errors_shown():
                await self.show()

    async def _duplicate(self, mission: str, name: str) -> None:
        missions, copy = the_services().missions, f"{name} copy"
        old = await missions.get(mission)
        new = await missions.create(the_user(), await named(old.text, copy), dict(old.files), copy)
        say(f"{new.mission} is a copy of {name}.")

    async def _delete(self, mission: str, name: str) -> None:
        async def restore() -> None:
            with errors_shown():
                await the_services().missions.restore(the_user(), mission)
                await self.show()

        await the_services().missions.delete(the_user(), mission)
        offer(f"{name} is deleted.", "Undo", restore)


def page_text(found: Sequence[MissionEntry], count: int, search: str, after: str, *, may: bool) -> str:
    """A page of the list as HTML, with all texts escaped.

    Parameters
    ----------
    found
        the missions of the page, and one more where there is a next page.
    count
        how many missions of this server there are in all.
    search, after
        the words that are looked for, and the place behind which the page begins.
    may
        whether the user may change missions.
    """
    shown = found[:PAGE_ROWS]
    if not shown:
        return '<p class="quiet none-found">No mission has such a name.</p>'
    following = address("/", search=search, after=place_of(shown[-1])) if len(found) > len(shown) else ""
    first = address("/", search=search) if after else ""
    groups = (
        _group(f"Missions of this server ({count:,})", [entry for entry in shown if not entry.shipped], may),
        _group("Shipped with Muster", [entry for entry in shown if entry.shipped], may),
    )
    table = f'<table class="plain missions" id="missions">{_HEAD}{"".join(groups)}</table>'
    return f'<div class="panel scrolling">{table}</div>{pager_text(first, following)}'


def _group(title: str, entries: Sequence[MissionEntry], may: bool) -> str:
    if not entries:
        return ""
    head = f'<tr class="group"><th colspan="6" scope="rowgroup">{title}</th></tr>'
    return f"<tbody>{head}{''.join(_row(entry, may) for entry in entries)}</tbody>"


def _row(entry: MissionEntry, may: bool) -> str:
    mission, name = escape(entry.id), escape(entry.name)
    more = f'<span class="about">{escape(_about(entry.id))}</span>' if entry.shipped else ""
    if entry.name != entry.id and not entry.shipped:
        more = f' <span class="quiet small">{mission}</span>'
    changed = f"version {entry.version}, {ago(entry.changed_at)}" if entry.version and entry.changed_at else ""
    acts = _button("duplicate", "content_copy", "Duplicate", entry) if may else ""
    if may and not entry.shipped:
        acts += _button("delete", "delete_outline", "Delete", entry)
    return (
        f'<tr data-name="{escape(words_of(entry.id, entry.name))}">'
        f'<td><a class="mission-link" href="/plan/{mission}">{name}</a>{more}</td>'
        f'<td class="number">{entry.robots}</td><td class="number">{entry.tasks}</td>'
        f'<td class="dimensions quiet">{"3-D" if entry.dimensions == 3 else ""}</td>'
        f'<td class="wide quiet">{changed}</td><td class="acts">{acts}</td></tr>'
    )


def _button(act: str, icon: str, words: str, entry: MissionEntry) -> str:
    label = escape(f"{words} {entry.name}")
    data = f'data-act="{act}" data-mission="{escape(entry.id)}" data-name="{escape(entry.name)}"'
    image = f'<i class="q-icon material-icons" aria-hidden="true">{icon}</i>'
    return f'<button type="button" class="icon-button" {data} aria-label="{label}" title="{label}">{image}</button>'


@cache
def _about(shipped: str) -> str:
    """A shipped mission in one line."""
    return mission_summary(shipped).description


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
