"""The text editor: CodeMirror, kept in step with the text on the server."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from nicegui import background_tasks
from nicegui.elements.codemirror import CodeMirror
from nicegui.events import GenericEventArguments

from muster_control.pages.editing.concurrent_edits import applied, merged

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
