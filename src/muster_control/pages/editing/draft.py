"""The draft of a mission on one page: its text with undo, its base version, and its errors."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import monotonic
from typing import Any

from muster_control.contract import MissionVersion, User
from muster_control.pages.editing.history import History

_QUIET_S = 0.35  # without a change, before a text is checked


@dataclass(frozen=True)
class Checked:
    """The result of a check: errors, stations and tasks that nobody gets to or can do, and the mission as plain data.

    `mission` and `floor` are of the last text that could be read, or None. `text` is the checked text, or None.
    """

    errors: Sequence[Mapping[str, Any]] = ()
    cut_off: Sequence[Mapping[str, Any]] = ()
    impossible: Sequence[Mapping[str, Any]] = ()
    mission: Mapping[str, Any] | None = None
    floor: Mapping[str, Any] | None = None
    text: str | None = None


@dataclass
class Draft:
    """The text that a page shows, and its saved version.

    Parameters
    ----------
    missions
        the services' missions.
    base
        the version that the text came from.
    on_change, on_check, on_wait
        called when there is another text (with what made it: `typed`, `edit`, `undo`, `load`, `save`), when one was
        checked, and when an edit begins or ends, whatever becomes of it.
    """

    missions: Any
    base: MissionVersion
    on_change: list[Callable[[str], None]] = field(default_factory=list)
    on_check: list[Callable[[], None]] = field(default_factory=list)
    on_wait: list[Callable[[], None]] = field(default_factory=list)
    checked: Checked = field(default_factory=Checked)
    _history: History = field(init=False)
    _changed_at: float | None = None
    _checking: bool = False
    _editing: asyncio.Lock = field(default_factory=asyncio.Lock)
    _saving: asyncio.Lock = field(default_factory=asyncio.Lock)
    _edits: int = 0  # that were asked for and are not there yet

    def __post_init__(self) -> None:
        self._history = History(self.base.text)
        self._changed_at = -_QUIET_S

    @property
    def id(self) -> str:
        """The mission's id."""
        return self.base.mission

    @property
    def text(self) -> str:
        """The text as it is now."""
        return self._history.text

    @property
    def is_saved(self) -> bool:
        """Whether the text is that of the version."""
        return self.text == self.base.text

    @property
    def is_editing(self) -> bool:
        """Whether an edit is under way."""
        return self._edits > 0

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to undo, or will be one."""
        return self._history.can_undo or self.is_editing

    @property
    def can_redo(self) -> bool:
        """Whether there is an undone step."""
        return self._history.can_redo

    @property
    def is_checked(self) -> bool:
        """Whether what the check said is of the text as it is now, and no edit is under way."""
        return not self.is_editing and self.checked.text == self.text

    def typed(self, text: str) -> None:
        """Replace the text by what was typed."""
        self._take(text, "typed")

    async def edit(self, change: str, *arguments: object) -> None:
        """Apply a change to the text; raises what `Missions.edit` raises, and leaves the text then."""
        with self._waiting():
            async with self._editing:  # one after the other, as each begins with what the last one made
                before, made = None, ""
                while before != self.text:  # again, if somebody typed meanwhile
                    before = self.text
                    made = await self.missions.edit(before, change, *arguments)
                self._take(made, "edit")

    async def settled(self) -> None:
        """Wait for pending edits."""
        async with self._editing:
            pass

    async def read_keys(self, *keys: str) -> Mapping[str, Any]:
        """The values of some keys of the text; raises what `Missions.read_keys` raises."""
        found: Mapping[str, Any] = await self.missions.read_keys(self.text, *keys)
        return found

    async def undo(self) -> None:
        """Undo the last step, also an edit that is still under way."""
        async with self._editing:
            if self._history.can_undo:
                self._history.undo()
                self._tell("undo")

    async def redo(self) -> None:
        """Redo the step that was undone, unless an edit is under way."""
        async with self._editing:
            if self._history.can_redo:
                self._history.redo()
                self._tell("undo")

    def load(self, version: MissionVersion, text: str | None = None) -> None:
        """Load another version; a `text` becomes unsaved changes to it."""
        self.base = version
        self._history.change(version.text if text is None else text)
        self._tell("load")

    async def save(self, who: User, note: str = "") -> bool:
        """Save the text as a version; returns whether that was needed.

        Raises
        ------
        ConflictError
            if somebody else has saved another one since.
        """
        async with self._saving:  # a save that is on its way may be of this very text
            if self.is_saved:
                return False
            self.base = await self.missions.save(who, self.id, self.text, self.base.version, note=note)
            self._tell("save")
            return True

    async def tick(self) -> None:
        """Check the text when it has not changed for a moment; called periodically."""
        if self._changed_at is None or self._checking or monotonic() - self._changed_at < _QUIET_S:
            return
        self._changed_at = None
        self._checking = True
        text = self.text
        try:
            found = await self.missions.check(text, dict(self.base.files))
        except BaseException:
            self._changed_at = self._changed_at or monotonic()  # it is still not known: asked again
            raise
        finally:
            self._checking = False
        before = self.checked
        mission, floor = (found["mission"], found["floor"]) if found["mission"] else (before.mission, before.floor)
        self.checked = Checked(found["errors"], found["cut_off"], found["impossible"], mission, floor, text)
        for listener in self.on_check:
            listener()

    @contextmanager
    def _waiting(self) -> Iterator[None]:
        """Mark an edit as under way within the block."""
        self._edits += 1
        self.tell_waiting()
        try:
            yield
        finally:
            self._edits -= 1
            self.tell_waiting()

    def tell_waiting(self) -> None:
        """Report whether an edit is under way; also called if an edit is refused before it starts."""
        for listener in self.on_wait:
            listener()

    def _take(self, text: str, kind: str) -> None:
        if text != self.text:
            self._history.change(text, kind if kind == "typed" else "", monotonic())
            self._tell(kind)

    def _tell(self, kind: str) -> None:
        if kind != "save":
            self._changed_at = monotonic() if kind == "typed" else monotonic() - _QUIET_S
        for listener in self.on_change:
            listener(kind)
