"""What is wrong with a mission: errors with their lines, and tasks that can never be done."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from muster.mission.texts.counting import counted
from muster_control.pages.editing.draft import Checked

_MOST = 30


class Findings:
    """A strip with the findings, hidden if there are none; a click shows the line in the text."""

    def __init__(self, reveal: Callable[[int], None]) -> None:
        self._reveal = reveal
        self._strip = ui.element("details").classes("findings").props('hidden open aria-live="polite"')

    def show(self, checked: Checked) -> None:
        """Show what a check found."""
        self._strip.clear()
        if not checked.errors and not checked.impossible and not checked.cut_off:
            self._strip.props("hidden")
            return
        self._strip.props(remove="hidden")
        with self._strip:
            with ui.element("summary"):
                ui.label(self._title(checked))
            with ui.element("ul"):
                for error in checked.errors[:_MOST]:
                    with ui.element("li"):
                        self._error(error.get("line"), f"{error['field']}: " if error["field"] else "", error)
                for station in checked.cut_off[:_MOST]:
                    with ui.element("li"):
                        ui.label(f"no robot gets to station {station['station']}: {station['detail']}")
                for task in checked.impossible[:_MOST]:
                    with ui.element("li"):
                        ui.label(f"task {task['task']} can never be done: {_why(task['reasons'])}")

    def _error(self, line: int | None, field: str, error: object) -> None:
        assert isinstance(error, dict)
        words = f"{field}{error['value']}; expected {error['expected']}"
        if line is None:
            ui.label(words)
            return
        button = ui.element("button").props('type="button"').classes("line-link")
        with button:
            ui.label(f"line {line}")
        button.on("click", lambda: self._reveal(line))
        ui.label(words)

    def _title(self, checked: Checked) -> str:
        parts = [
            counted(len(found), one, several)
            for found, one, several in (
                (checked.errors, "error", "errors"),
                (checked.cut_off, "station out of reach", "stations out of reach"),
                (checked.impossible, "impossible task", "impossible tasks"),
            )
            if found
        ]
        return " and ".join(parts)


def _why(reasons: object) -> str:
    """The reasons of all robots, without repetition."""
    assert isinstance(reasons, (list, tuple))
    by_reason: dict[str, list[str]] = {}
    for reason in reasons:
        by_reason.setdefault(f"{reason['reason']} ({reason['detail']})", []).append(reason["robot"])
    return "; ".join(
        f"{', '.join(robots[:4])}{' …' if len(robots) > 4 else ''}: {why}" for why, robots in by_reason.items()
    )
