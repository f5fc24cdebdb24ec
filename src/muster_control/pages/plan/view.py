"""The page of one mission."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from typing import Any

from nicegui import ui

from muster_control.pages.editing.draft import Draft
from muster_control.pages.editing.editors import Editors
from muster_control.pages.frame import frame
from muster_control.pages.notices import errors_shown
from muster_control.pages.plan.plan_panel import PlanPanel
from muster_control.pages.plan.planning_controls import PlanningControls
from muster_control.pages.plan.title_bar import TitleBar
from muster_control.pages.visitor import PATIENCE_S, may_command, on_the_wall, the_services

_TICK_S = 0.2
_UNSAVED_S = 3600.0
"""Seconds without a connection for which a page with unsaved work is kept."""
_KEYS = {
    "Ctrl+Z, Ctrl+Y": "undo, redo",
    "Ctrl+S": "save a version",
    "arrows, + - 0": "on the map: move, zoom, see all of it",
    "n, p": "next and previous robot or task",
    "Alt+arrows": "move what is chosen (Shift: farther)",
    "Delete": "take out what is chosen",
    "r": "what comes before what",
    "Enter": "why is this task done by this robot; where a click adds: add one in the middle of the map",
}


@ui.page("/plan", response_timeout=PATIENCE_S)
async def choose() -> None:
    """Without a mission: those that were planned last, or the way to the list."""
    with frame("Plan"), errors_shown():
        recent = (await the_services().plans.missions())[:8]
        with ui.element("div").classes("panel narrow"):
            ui.label("Which mission?").classes("dialog-title")
            ui.label(
                "A plan says which robot does which tasks, in which order. Open a mission to edit it on the map, "
                "have it planned, and carry the plan out."
            ).classes("quiet")
            if recent:
                ui.label("Planned last").classes("small quiet")
            for mission in recent:
                with ui.element("p"):
                    ui.link(mission, f"/plan/{mission}").classes("mission-link")
            with ui.element("p"):
                ui.link("All missions, and new ones", "/")


@ui.page("/plan/{mission}", response_timeout=PATIENCE_S)
async def view(mission: str, plan: int | None = None) -> None:
    """A mission and its plans; `?plan=` chooses one."""
    with frame("Plan", mission, _KEYS) as content:
        with errors_shown():
            await _build(mission, plan)
            return
        with content:
            ui.link("All missions", "/")


async def _build(mission: str, plan: int | None) -> None:
    draft = Draft(the_services().missions, await the_services().missions.get(mission))
    _keep_unsaved(draft)
    answer: PlanPanel

    def choose(one: Mapping[str, Any] | None) -> None:
        answer.choose(one)

    async def ask(one: Mapping[str, Any]) -> None:
        if one["what"] == "task":
            await answer.why.ask(one["id"])

    title = TitleBar(draft)
    with ui.element("div").classes("plan-page"):
        with ui.element("section").classes("left").props('aria-label="Mission"'):
            workshop = Editors(draft, choose, ask)
        with ui.element("section").classes("right").props('aria-label="Plans"'):
            ordering = PlanningControls(draft) if may_command() and not on_the_wall() else None
            answer = PlanPanel(draft, workshop.map)
        with ui.element("section").classes("below").props('aria-label="Schedule"'):
            answer.build_gantt()
    if ordering is not None:
        ordering.on_done = answer.show_newest
        ordering.before = title.save
    await answer.begin(plan)

    client = ui.context.client

    async def tick() -> None:
        if client.has_socket_connection:  # nobody is told of errors before
            with errors_shown():
                await draft.tick()

    ui.timer(_TICK_S, tick)
    if ordering is not None:
        ui.timer(0, ordering.go_on, once=True)


def _keep_unsaved(draft: Draft) -> None:
    """Wait longer for a browser whose connection is gone while there is something that only this page has.

    Not for every page: NiceGUI cannot tell a connection that is lost from a page that is left, and each page that is
    left would hold a megabyte for an hour, and a large mission's scene beside it. A page that waits does next to
    nothing: its draft is not checked, a job is not shown, and what is to be sent is kept once an element.
    """
    client = ui.context.client
    page = client.page = copy(client.page)  # this client's own: what is set on the page counts for all who open it

    def note(_: str) -> None:
        page.reconnect_timeout = None if draft.is_saved else _UNSAVED_S

    draft.on_change.append(note)
