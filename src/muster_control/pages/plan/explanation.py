"""The explanation of a task: why its robot does it, or why it is unassigned."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from nicegui import ui

from muster_control.pages.notices import errors_shown
from muster_control.pages.plan.shown_plan import ShownPlan
from muster_control.pages.visitor import the_services


class Explanation:
    """A button for the chosen task, and the answer."""

    def __init__(self, answer: ShownPlan) -> None:
        self._answer = answer
        self._task: str | None = None
        self._button = ui.button("Explanation?", icon="help_outline", on_click=self._pressed).props(
            'outline dense id="why"'
        )
        self._button.set_visibility(False)
        self._box = ui.element("div").classes("why").props('aria-live="polite"')

    def offer(self, task: str | None) -> None:
        """Offer to explain a task, or nothing."""
        self._task, entry = task, self._answer.entry
        self._button.set_visibility(task is not None and entry is not None)
        if task is not None and entry is not None:
            self._button.text = question(task, entry.plan)

    def clear(self) -> None:
        """Remove the answer, as there is another plan."""
        self._box.clear()

    async def _pressed(self) -> None:
        if self._task is not None:
            await self.ask(self._task)

    async def ask(self, task: str) -> None:
        """Explain a task of the plan that is shown."""
        entry = self._answer.entry
        if entry is None:
            return
        self._box.clear()
        with self._box:
            waiting = ui.spinner(size="1.4em")
        with errors_shown():
            found = await the_services().plans.explain(entry.id, task)
            if waiting.is_deleted:  # another plan is shown meanwhile, or something else was asked
                return
            self._box.clear()
            with self._box:
                _explained(task, found)
            return
        if not waiting.is_deleted:
            self._box.clear()


def question(task: str, plan: Mapping[str, Any]) -> str:
    """The question about a task, which may be unassigned."""
    left_out = any(str(item["task"]) == task for item in plan.get("unassigned") or ())
    return f"Why is task {task} left out?" if left_out else f"Why is task {task} done as it is?"


def _explained(task: str, found: Mapping[str, Any]) -> None:
    with ui.element("h3"):
        ui.label(f"Task {task}")
    for sentence in found.get("words") or ():
        with ui.element("p"):
            ui.label(sentence)
    alternatives = found.get("alternatives") or ()
    if not alternatives:
        return
    now, objective = found.get("robot"), found.get("objective")
    with ui.element("details"):
        with ui.element("summary"):
            ui.label("Every robot, the rest of the plan as it is")
        with ui.element("table").classes("plain"):
            for other in alternatives:
                with ui.element("tr").classes("now" if other["robot"] == now else ""):
                    for text in (other["robot"], _then(other, now, objective)):
                        with ui.element("td"):
                            ui.label(text)


def _then(other: Mapping[str, Any], now: str | None, objective: float | None) -> str:
    reason, value = other.get("reason"), other.get("objective")
    if reason:
        return f"could not: {reason['reason']}, {reason['detail']}"
    if other["robot"] == now:
        return "does it"
    if value is None:
        return f"could, as number {other['number']}; another route has no way"
    change = f" ({value - objective:+.2f})" if objective is not None and now is not None else ""
    return f"could, as number {other['number']}: objective {value:.2f}{change}"
