"""A mission as text: an editor with what is wrong marked at its lines.

The text editor: CodeMirror, kept in step with the text on the server.

Merges concurrent edits: an editor in the browser changes a text while another text is sent to it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import chain, repeat
from typing import Any

from nicegui import background_tasks, ui
from nicegui.elements.codemirror import CodeMirror
from nicegui.events import GenericEventArguments

from muster_control.pages.editing.draft import Draft
from muster_control.pages.notices import warn

_UTF_16 = ("utf-16-le", "surrogatepass")  # in which the editor counts


def applied(text: str, sections: Sequence[int], inserted: Sequence[Sequence[str]]) -> str | None:
    """A text with a change set of CodeMirror, or None where that is of a text of another length.

    `sections` are pairs of an old and a new length, the latter -1 where nothing changes; `inserted` are new lines.
    """
    units = text.encode(*_UTF_16)
    if 2 * sum(sections[::2]) != len(units):
        return None
    pieces, at = [], 0
    for old, new, lines in zip(sections[::2], sections[1::2], chain(inserted, repeat(())), strict=False):
        pieces.append(units[2 * at : 2 * (at + old)] if new < 0 else "\n".join(lines).encode(*_UTF_16))
        at += old
    return b"".join(pieces).decode(*_UTF_16)


def merged(before: str, here: str, there: str) -> str | None:
    """The merge of two changes of a text; None if both changed the same place."""
    (start, end, new), (start_there, end_there, new_there) = _change(before, here), _change(before, there)
    if end <= start_there:
        return before[:start] + new + before[end:start_there] + new_there + before[end_there:]
    if end_there <= start:
        return before[:start_there] + new_there + before[end_there:start] + new + before[end:]
    return None


def _change(before: str, after: str) -> tuple[int, int, str]:
    """The smallest replaced piece of a text: its start, its end, and its replacement."""
    start = _alike(before, after)
    same = _alike(before[start:][::-1], after[start:][::-1])
    return start, len(before) - same, after[start : len(after) - same]


def _alike(one: str, other: str) -> int:
    """The length of the common prefix of two texts."""
    ends = min(len(one), len(other))
    return next((k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), ends)


_PATIENCE_S = 60.0  # with a browser that is busy


class Editor(CodeMirror):
    """An editor that accepts typing while another text is being sent to the browser.

    The sent text replaces the shown one. Changes typed before it arrived refer to the former text; they are kept and
    merged into the new one, unless both changed the same place: then `on_lost` is called.
    """

    on_lost: Callable[[], object]
    _shown = ""  # in the browser, as far as it is known
    _before: str | None = None  # what was shown when another text was sent, as long as that is on its way
    _sent = 0

    def begin(self) -> None:
        """Take the text as what the browser shows first: what was sent so far arrives there together."""
        self._shown, self._before = self.value, None
        self._sent += 1

    def update(self) -> None:
        """Send the element with its text."""
        super().update()
        self._sent += 1
        if self._before is None:
            self._before = self._shown
        background_tasks.create(self._arrive(self._sent), name=f"text on its way {self.id}")

    def mark_lines(self, decorations: Sequence[Mapping[str, Any]], tooltips: Mapping[int, str]) -> None:
        """Mark lines, without sending the text again."""
        with self._props.suspend_updates():
            self.decorations = [dict(one) for one in decorations]
            self.line_tooltips = dict(tooltips)
        self.run_method("setDecorations", decorations)
        self.run_method("setLineTooltips", tooltips)

    async def _arrive(self, number: int) -> None:
        """Wait until the sent text is shown, and merge what was typed meanwhile."""
        with suppress(TimeoutError):
            await self.client.run_javascript("return true", timeout=_PATIENCE_S)  # answered after what was sent before
        if number != self._sent or self.is_deleted or self._before is None:
            return
        before, there = self._before, self._shown
        self._before, self._shown = None, self.value
        if there != before:
            text = merged(before, self.value, there)
            if text is None:
                with self.client:
                    self.on_lost()
            else:
                self.value = text

    def _event_args_to_value(self, e: GenericEventArguments) -> str:
        text = applied(self._shown, e.args["sections"], e.args["inserted"])
        if text is None:  # of a text that is not known here
            self.on_lost()
            self.update()
        else:
            self._shown = text
        here: str = self.value
        return here if text is None or self._before is not None else text


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
