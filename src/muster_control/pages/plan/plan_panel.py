"""The right side of the view *Plan*, below the controls: the shown plan, its figures, routes and explanations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from nicegui import ui

from muster_control.contract import PAGE_ROWS, PlanEntry
from muster_control.pages.charts import Curve, Gantt
from muster_control.pages.editing.draft import Draft
from muster_control.pages.map import MissionMap
from muster_control.pages.missions.view import ago
from muster_control.pages.notices import errors_shown
from muster_control.pages.plan.explanation import Explanation
from muster_control.pages.plan.figures import figures_list, figures_of, left_out, lines_of, objective_unit, robots_table
from muster_control.pages.plan.plan_actions import PlanActions
from muster_control.pages.visitor import the_services


class PlanPanel:
    """Shows one plan of a mission: on the map, as figures and tables, in time."""

    def __init__(self, draft: Draft, ground: MissionMap) -> None:
        self._draft = draft
        self._map = ground
        self._entries: Sequence[PlanEntry] = ()
        self._last: int | None = None
        self._entry: PlanEntry | None = None
        self._chosen: Mapping[str, Any] | None = None
        self._gantt: Gantt
        with ui.element("div").classes("panel answer"):
            with ui.element("div").classes("bar"):
                self._choice = ui.select({}, label="Plan", on_change=self._chosen_plan)
                self._choice.props('outlined dense options-dense id="plans"').classes("plan-choice")
                self._older = ui.button("Older plans", on_click=self._list_older).props("flat dense no-caps")
                self._outdated = ui.label("made for another text of the mission").classes("outdated").props("hidden")
            self._none = ui.label("No plan yet.").classes("quiet")
            self.why = Explanation(self)
            self._body = ui.element("div").classes("answer-body")
            self.taking = PlanActions(self)
        draft.on_change.append(lambda _: self._show_outdated())

    def build_gantt(self) -> None:
        """Build the time chart where the page wants it."""
        self._chart = ui.element("div").classes("panel scrolling").props("hidden")
        with self._chart:
            self._gantt = Gantt()
            self._gantt.on("choose", lambda event: self._choose_named(event.args["what"], event.args["id"]))

    @property
    def entry(self) -> PlanEntry | None:
        """The plan that is shown."""
        return self._entry

    @property
    def entries(self) -> Sequence[PlanEntry]:
        """The newest plans of the mission, and the one that was asked for; the newest first."""
        return self._entries

    @property
    def mission(self) -> str:
        """The mission's id."""
        return self._draft.id

    async def begin(self, plan: int | None) -> None:
        """Show a plan, or the newest if there is one."""
        await self._list(plan)
        known = [entry.id for entry in self._entries]
        if known:
            self._choice.set_value(plan if plan in known else known[0])

    async def show_newest(self, plan: int) -> None:
        """Show a plan that has just been made."""
        await self._list(plan)
        self._choice.set_value(plan)

    async def _list(self, plan: int | None) -> None:
        """List the newest plans, and one that may be older."""
        entries = await self._page(None)
        if plan is not None and entries and plan < entries[-1].id:
            entries += await the_services().plans.list(self._draft.id, 1, before=plan + 1)
        self._show_entries(entries)

    async def _list_older(self) -> None:
        """List the next page of plans, too; one that was asked for may be listed already."""
        with errors_shown():
            known = {entry.id: entry for entry in (*self._entries, *await self._page(self._last))}
            self._show_entries([known[plan] for plan in sorted(known, reverse=True)])

    async def _page(self, before: int | None) -> list[PlanEntry]:
        """The next page of plans; the button for older ones shows whether another follows."""
        found = await the_services().plans.list(self._draft.id, PAGE_ROWS + 1, before)
        page = found[:PAGE_ROWS]
        self._last = page[-1].id if page else before
        self._older.set_visibility(len(found) > PAGE_ROWS)
        return page

    def _show_entries(self, entries: Sequence[PlanEntry]) -> None:
        self._entries = entries
        self._choice.set_options({entry.id: title_of(entry) for entry in self._entries}, value=self._choice.value)
        self._choice.set_visibility(bool(self._entries))
        self._none.set_visibility(not self._entries)

    async def _chosen_plan(self) -> None:
        chosen = self._choice.value
        if chosen is None:
            return
        self._show_no_plan()
        with errors_shown():
            entry = await the_services().plans.get(chosen)
            if self._choice.value != chosen:  # another one meanwhile
                return
            self._entry = entry
            self._show_judging(entry)
            verdict = await the_services().plans.verdict(entry.id)
            version = await the_services().missions.get(entry.mission, entry.mission_version)
            known = await the_services().missions.read_keys(version.text, "origin_wgs84", "starts_at")
            if self._entry is entry:
                self._show(entry, verdict, known)

    def _show_no_plan(self) -> None:
        """Disable all actions until the chosen plan is loaded."""
        self._entry = None
        self._show_outdated()
        self._body.clear()
        self.taking.show()
        self.why.clear()
        self.choose(self._chosen)

    def _show_judging(self, entry: PlanEntry) -> None:
        self._show_outdated()
        self._body.clear()
        with self._body:
            figures_list(figures_of(entry.plan))
            with ui.element("div").classes("bar").props('role="status"'):
                ui.spinner(size="1.2em")
                ui.label("The judge goes through the plan: ways, times, rules.").classes("quiet")

    def _show(self, entry: PlanEntry, verdict: Mapping[str, Any], known: Mapping[str, Any]) -> None:
        """Show a plan; `known` is what its mission says of where and when it is."""
        self._map.show_plan(lines_of(entry.plan, verdict))
        self._gantt.show(verdict)
        self._chart.props(remove="hidden")
        self._body.clear()
        with self._body:
            figures_list(figures_of(entry.plan, verdict))
            left_out(entry.plan, self._choose_named)
            _how_found(entry.plan)
            robots_table(verdict["routes"], str(entry.plan.get("usage_unit", "")), self._choose_named)
        self.taking.show(on_earth=bool(known.get("origin_wgs84")), has_start=bool(known.get("starts_at")))
        self.why.clear()
        self.choose(self._chosen)

    def _show_outdated(self) -> None:
        entry = self._entry
        old = entry is not None and (not self._draft.is_saved or entry.mission_version != self._draft.base.version)
        self._outdated.props(remove="hidden") if old else self._outdated.props("hidden")

    def choose(self, one: Mapping[str, Any] | None) -> None:
        """Show what was chosen on the map."""
        self._chosen = one
        self.why.offer(one["id"] if one and one["what"] == "task" else None)

    def _choose_named(self, what: str, name: str) -> None:
        self._map.choose(what, name)
        self.choose({"what": what, "id": name})


def _how_found(plan: Mapping[str, Any]) -> None:
    """The improvements that led to a plan, collapsed."""
    history = plan.get("history") or []
    if len(history) < 2:
        return
    with ui.element("details").classes("more"):
        with ui.element("summary"):
            ui.label("How it was found")
        Curve().show(history, plan.get("lower_bound"), plan.get("elapsed_s") or 0.0)


def title_of(entry: PlanEntry) -> str:
    """How a plan is named in a list."""
    plan = entry.plan
    objective = plan.get("objective") or {}
    value = objective.get("value")
    parts = [str(plan.get("allocator") or entry.origin)]
    if value is not None:
        parts.append(f"{objective.get('name', '')} {value:.2f} {objective_unit(plan)}".rstrip())
    if plan.get("tasks_total") is not None:
        parts.append(f"{plan.get('tasks_completed')} of {plan['tasks_total']} tasks")
    return f"{entry.version}: {', '.join(parts)}, {ago(entry.at)}"
