"""The controls of planning: its options, its progress, and ending it early with or without a plan."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from nicegui import ui

from muster.mission.errors import ParameterError
from muster.mission.ignorable_rules import IGNORABLE
from muster.mission.model import OBJECTIVES
from muster_control.contract import Job, JobState
from muster_control.pages.buttons import once
from muster_control.pages.charts import Curve
from muster_control.pages.editing.draft import Draft
from muster_control.pages.notices import errors_shown, say
from muster_control.pages.visitor import the_services, the_user

_WAITING: tuple[JobState, ...] = ("queued", "running")
_BOUNDS = {"": "none", "quick": "quick", "exact": "exact (may take long)"}


class PlanningControls:
    """The controls of planning, and the job that is under way.

    `before` saves the mission and returns whether it is saved; `on_done` receives a new plan's id.
    """

    def __init__(self, draft: Draft) -> None:
        self._draft = draft
        self.before: Callable[[str], Awaitable[bool]]
        self.on_done: Callable[[int], Awaitable[None]]
        self._job: Job | None = None
        self._stopped = False
        with ui.element("div").classes("panel ordering"):
            self._build()

    def _build(self) -> None:
        with ui.element("div").classes("fields"):
            self._allocator = ui.select([], label="Allocator").props("outlined dense options-dense")
            rules = ui.select(
                {"": "as the mission says", **{one: one for one in OBJECTIVES}}, value="", label="Objective"
            )
            self._objective = rules.props("outlined dense options-dense")
            self._limit = ui.number("Time limit, s", value=5, min=0.1, max=3600).props("outlined dense")
        with ui.element("details").classes("more"):
            with ui.element("summary"):
                ui.label("More")
            with ui.element("div").classes("fields"):
                self._seed = ui.number("Seed", value=0, precision=0, min=0).props("outlined dense")
                self._iterations = ui.number("Iterations", precision=0, min=1).props("outlined dense clearable")
                self._bound = ui.select(_BOUNDS, value="quick", label="Lower bound").props(
                    "outlined dense options-dense"
                )
                self._ignore = ui.select(list(IGNORABLE), multiple=True, value=[], label="Ignore rules")
                self._ignore.props("outlined dense options-dense")
        with ui.element("div").classes("bar"):
            self._go = ui.button("Plan", icon="route", on_click=once(self._ask)).props('unelevated id="plan"')
            self._stop = ui.button("Stop", on_click=self._ask_to_stop).props('outline id="stop"')
            self._stop.props('title="End the search; keep the best plan so far"')
            self._discard = ui.button("Discard", on_click=self._cancel)
            self._discard.props('flat dense size=sm no-caps color=negative id="discard"')
            self._discard.props('title="End the search; keep nothing"')
            self._state = ui.label("").classes("quiet").props('role="status"')
        self._bar = ui.linear_progress(value=0, show_value=False).props("instant-feedback")
        self._curve = Curve()
        self._show(None)

    async def go_on(self) -> None:
        """Show the allocators, and a job of this mission that is under way."""
        with errors_shown():
            found = await the_services().plans.allocators()
            names = {a["name"]: a["name"] for a in found}
            self._allocator.set_options(names, value=next((a["name"] for a in found if a["default"]), None))
            jobs = [job for state in _WAITING for job in await the_services().jobs.list(state, self._draft.id, limit=1)]
            if jobs:
                await self._follow(max(jobs, key=lambda job: job.id))

    async def _ask(self) -> bool:
        """Request a plan, and follow the job to its end; returns False, so that the button works again."""
        if self._draft.checked.errors:
            raise ParameterError("the mission has errors; mend them first")
        if await self.before("to be planned"):
            base, user, arguments = self._draft.base, the_user(), self._arguments()
            await self._follow(
                await the_services().jobs.ask_plan(user, base.mission, base.version or None, **arguments)
            )
        return False

    def _arguments(self) -> dict[str, Any]:
        given: dict[str, Any] = {
            "allocator": self._allocator.value,
            "objective": self._objective.value or None,
            "time_limit": self._limit.value,
            "seed": None if self._seed.value is None else int(self._seed.value),
            "iterations": None if self._iterations.value is None else int(self._iterations.value),
            "bound": self._bound.value or None,
            "ignore": list(self._ignore.value) or None,
        }
        if given["iterations"] is not None:
            given["time_limit"] = None
        return {name: value for name, value in given.items() if value is not None}

    async def _ask_to_stop(self) -> None:
        with errors_shown():
            if self._job is not None:
                self._stopped = True
                await the_services().jobs.stop(the_user(), self._job.id)

    async def _cancel(self) -> None:
        with errors_shown():
            if self._job is not None:
                await the_services().jobs.cancel(the_user(), self._job.id)

    async def _follow(self, asked: Job) -> None:
        """Show a job until it is over, or the page is closed."""
        client, job = ui.context.client, asked
        self._stopped = False
        async for job in the_services().jobs.follow(asked.id):
            if client.is_deleted:
                return
            if client.has_socket_connection:
                self._show(job)
        self._show(job)
        if job.state == "done" and job.result:
            if self._stopped:
                say("Planning was stopped. The best plan so far is kept.")
            await self._forget_shipped()
            await self.on_done(int(job.result["plan"]))
        elif job.state == "failed":
            raise ParameterError(job.error)
        elif job.state == "cancelled":
            say("Planning was called off. No plan is kept of it.")

    async def _forget_shipped(self) -> None:
        """A shipped mission has a version once it was planned."""
        if self._draft.base.version == 0:
            newest = await the_services().missions.get(self._draft.id)
            if newest.text == self._draft.base.text:
                self._draft.load(newest, self._draft.text)

    def _show(self, job: Job | None) -> None:
        self._job = job
        under_way = job is not None and job.state in _WAITING
        self._go.set_enabled(not under_way)
        self._stop.set_visibility(under_way)
        self._discard.set_visibility(under_way)
        self._bar.set_visibility(under_way)
        progress: Mapping[str, Any] = (job.progress if job else None) or {}
        history = progress.get("history") or []
        self._curve.set_visibility(bool(history) and under_way)
        if job is None:
            return
        share = progress.get("share")
        self._bar.props(remove="indeterminate") if share is not None else self._bar.props("indeterminate")
        self._bar.value = share or 0.0
        words = _words(job, progress, has_map=bool((self._draft.checked.mission or {}).get("map")))
        self._state.text = "stops with its best plan" if self._stopped and under_way else words
        self._curve.show(history, progress.get("bound"), progress.get("elapsed_s") or 0.0)


def _words(job: Job, progress: Mapping[str, Any], *, has_map: bool) -> str:
    if job.state == "queued":
        return "waits for its turn"
    if job.state != "running":
        return ""
    value = progress.get("objective")
    if value is None:
        return "finds ways on the map" if has_map else "begins"
    return f"{progress.get('elapsed_s', 0):.1f} s: objective {value:.2f}"
