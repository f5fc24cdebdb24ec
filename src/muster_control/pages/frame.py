"""The frame of every view: header with navigation and user, keyboard help, skip link, and style."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from nicegui import app, ui

from muster_control.pages.visitor import is_logged_in, on_the_wall, the_user

VIEWS = (("Missions", "/", "m"), ("Plan", "/plan", "p"), ("Live", "/live", "l"), ("Records", "/records", "r"))
_KEYS = {
    "?": "this help",
    "g, then m p l r": "go to Missions, Plan, Live, Records",
    "Tab": "from one thing to the next",
}
_ASSETS = Path(__file__).parent / "assets"

app.add_static_files("/assets", _ASSETS, max_cache_age=3600)
_VERSION = max(int(file.stat().st_mtime) for file in _ASSETS.iterdir())  # so that a browser takes new files at once
ui.add_head_html(
    f'<link rel="stylesheet" href="/assets/muster.css?{_VERSION}">'
    f'<script src="/assets/frame.js?{_VERSION}" defer></script>',
    shared=True,
)


@contextmanager
def frame(view: str, title: str = "", keys: Mapping[str, str] | None = None) -> Iterator[ui.element]:
    """The frame of a view (`Missions`, `Plan`, `Live`, `Records`); what is built within is its content.

    `title` names the page for the window and screen readers; `keys` are its own keys, for the keyboard help.
    """
    wall = on_the_wall()
    ui.page_title(f"{title or view} · Muster")
    if wall:
        ui.query("body").classes("wall")
    content = ui.element("div").classes("view").props(f'aria-label="{view}"')
    if not wall:
        _header(view)
    ui.skip_link("Skip to the content", target=content)  # after the header, for it moves to the front
    _keyboard_help({**_KEYS, **(keys or {})})
    with content:
        ui.element("h1").classes("sr-only").text = title or view  # type: ignore[attr-defined]
        yield content


def _header(view: str) -> None:
    with ui.header(elevated=False).classes("frame"):
        with ui.element("a").props('href="/"').classes("brand"):
            ui.html(f'<img src="/assets/icon.svg?{_VERSION}" alt="" width="22" height="22">', sanitize=False)
            ui.label("Muster")
        with ui.element("nav").props('aria-label="Views"'):
            for name, path, _ in VIEWS:
                link = ui.link(name, path).classes("view-link")
                if name == view:
                    link.classes("here").props('aria-current="page"')
        who = the_user()
        may = "may command" if who.role == "command" else "may only watch"
        with ui.element("div").classes("who").props(f'title="{may}"'):
            ui.label(who.name)
            ui.label(who.role).classes(f"role {who.role}")
        if is_logged_in():
            leaving = ui.element("form").props('method="post" action="/logout"').classes("logout")
            with leaving, ui.element("button").props('type="submit"').classes("plain"):
                ui.label("Log out")
        help_button = ui.element("button").props('type="button" aria-label="Keyboard help" title="Keyboard help (?)"')
        with help_button.classes("help"):
            ui.label("?")
        help_button.on("click", js_handler="() => document.getElementById('keys').showModal()")


def _keyboard_help(keys: Mapping[str, str]) -> None:
    with ui.element("dialog").props('id="keys" aria-labelledby="keys-title"').classes("keys"):
        with ui.element("h2").props('id="keys-title"'):
            ui.label("Keyboard")
        with ui.element("dl"):
            for key, meaning in keys.items():
                with ui.element("dt"), ui.element("kbd"):
                    ui.label(key)
                with ui.element("dd"):
                    ui.label(meaning)
        close = ui.element("button").props('type="button" autofocus').classes("plain")
        with close:
            ui.label("Close")
        close.on("click", js_handler="() => document.getElementById('keys').close()")
