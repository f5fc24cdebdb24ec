"""Undo and redo: the texts that a mission has had."""

from __future__ import annotations

_MOST = 200  # texts
_MOST_LETTERS = 20_000_000  # of all of them together


class History:
    """The texts before and after the present one.

    Changes of the same `kind` within `together_s` are one step, so that letters typed in sequence are.
    """

    def __init__(self, text: str, together_s: float = 1.0) -> None:
        self._texts = [text]
        self._at = 0
        self._together_s = together_s
        self._last: tuple[str, float] | None = None

    @property
    def text(self) -> str:
        """The text that is shown."""
        return self._texts[self._at]

    @property
    def can_undo(self) -> bool:
        """Whether there is a text before."""
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        """Whether a step was undone."""
        return self._at < len(self._texts) - 1

    def change(self, text: str, kind: str = "", now: float = 0.0) -> None:
        """Show another text; what was undone is gone. `now` is any clock in seconds."""
        if text == self.text:
            return
        follows = kind and self._last and self._last[0] == kind and now - self._last[1] <= self._together_s
        if follows and self._at == len(self._texts) - 1 and self._at > 0:
            self._texts[self._at] = text
        else:
            self._texts[self._at + 1 :] = [text]
            self._at += 1
            self._forget()
        self._last = (kind, now) if kind else None

    def undo(self) -> str:
        """Show the text before, if there is one."""
        self._at = max(self._at - 1, 0)
        self._last = None
        return self.text

    def redo(self) -> str:
        """Show the text that was undone last, if there is one."""
        self._at = min(self._at + 1, len(self._texts) - 1)
        self._last = None
        return self.text

    def _forget(self) -> None:
        while len(self._texts) > _MOST or (sum(map(len, self._texts)) > _MOST_LETTERS and self._at > 1):
            del self._texts[0]
            self._at -= 1
