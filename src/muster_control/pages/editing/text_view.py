"""A mission as text: an editor with what is wrong marked at its lines."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from nicegui import ui

from muster_control.pages.editing.draft import Draft
from muster_control.pages.editing.text_editor import Editor
from muster_control.pages.notices import warn


class TextView:
    """The text of a draft. Undo and redo are the draft's own, so that they go over edits of map and form as well."""

    def __init__(self, draft: Draft, *, editable: bool) -> None:
        self._draft = draft
        keys: dict[str, Callable[[], object]] = {
            "Mod-z": lambda: draft.undo(),
            "Mod-y": lambda: draft.redo(),
            "Mod-Shift-z": lambda: draft.redo(),
            "Mod-s": lambda: ui.run_javascript("document.getElementById('save')?.click()"),
        }
        self._editor = Editor(
            _lines(draft.text),
            language="YAML",
            indent="  ",
            keymap=dict(keys),
            on_change=lambda event: self._take(event.value),
        ).classes("script")
        self._editor.on_lost = lambda: warn("What you typed last is not in the text: it was changed there meanwhile.")
        self._words: dict[int, str] = {}
        self._editor.props["aria-label"] = "Text of the mission"
        if not editable:
            self._editor.disable()
        self._editor.begin()
        ui.timer(0, self._theme, once=True)

    async def _theme(self) -> None:
        with suppress(TimeoutError):  # a browser that is busy with a long text: then it is as it is
            if await ui.run_javascript("matchMedia('(prefers-color-scheme: dark)').matches"):
                self._editor.theme = "basicDark"

    def show(self, text: str) -> None:
        """Show another text."""
        if self._editor.value != _lines(text):
            self._editor.value = _lines(text)

    def _take(self, text: str) -> None:
        if text != _lines(self._draft.text):
            self._draft.typed(text)

    def mark(self, errors: Sequence[Mapping[str, Any]]) -> None:
        """Mark the lines of what is wrong, and say it where one points at them."""
        lines = self._draft.text.count("\n") + 1
        words: dict[int, str] = {}
        for error in errors:
            line = error.get("line")
            if line is not None and 1 <= line <= lines:
                told = f"{error['field']}: {error['value']}; expected {error['expected']}".removeprefix(": ")
                words[line] = f"{words[line]}\n{told}" if line in words else told
        if words or self._words:
            self._words = words
            self._editor.mark_lines([{"kind": "line", "line": line, "class": "wrong-line"} for line in words], words)

    def reveal(self, line: int) -> None:
        """Bring a line into sight."""
        self._editor.reveal_line(line)


def _lines(text: str) -> str:
    """A text with the line ends that the editor knows."""
    return text.replace("\r\n", "\n").replace("\r", "\n")
