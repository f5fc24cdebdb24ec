"""The form of events: one frozen class for each kind, which says what the event holds and what it changes.

An event is written as its time, its kind and plain data; `event_of` reads it again. Logs and records of format 1 have
the same kinds, with fewer data.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self, dataclass_transform

import msgspec

from muster.mission.errors import ParameterError
from muster.mission.yaml_writer import plain

if TYPE_CHECKING:
    from muster.state.mission_state import MissionState

KINDS: dict[str, type[ExecutionEvent]] = {}
"""The class of each kind of event."""


@dataclass(frozen=True, kw_only=True)
class ExecutionEvent:
    """Something that happened to a mission under way.

    Parameters
    ----------
    time_s
        when, seconds of the mission's clock; not a number for an event that has yet to happen.
    """

    kind: ClassVar[str]
    alarming: ClassVar[bool] = False
    written: ClassVar[tuple[str, ...]] = ()
    time_s: float = math.nan

    def at(self, time_s: float) -> Self:
        """Return the same event, which happens at a time."""
        return replace(self, time_s=time_s)

    @property
    def data(self) -> Mapping[str, Any]:
        """What happened, as plain data: texts, numbers, lists and mappings.

        What is as by default is left out, but for the fields that are `written`.
        """
        told = (f for f in fields(self)[1:] if f.name in self.written or not _is_default(self, f))
        return {f.name: _plain(getattr(self, f.name)) for f in told}

    def change(self, state: MissionState) -> None:
        """Change what is known of the mission; `MissionState.apply` alone calls this."""


@dataclass(frozen=True, kw_only=True)
class OtherEvent(ExecutionEvent):
    """An event of a kind that changes nothing of what is known, with data of any form."""

    kind: str  # type: ignore[misc]
    content: Mapping[str, Any] = field(default_factory=dict)

    @property
    def data(self) -> Mapping[str, Any]:
        """See `ExecutionEvent`."""
        return self.content


@dataclass_transform(frozen_default=True, kw_only_default=True)
def happens(kind: str, *, alarming: bool = False) -> Callable[[type[ExecutionEvent]], type[ExecutionEvent]]:
    """Make a class the one of a kind of event; `alarming`: somebody should look at it."""

    def made(cls: type[ExecutionEvent]) -> type[ExecutionEvent]:
        cls.kind, cls.alarming = kind, alarming
        KINDS[kind] = dataclass(frozen=True, kw_only=True)(cls)
        return KINDS[kind]

    return made


def event_of(time_s: float, kind: str, data: Mapping[str, Any]) -> ExecutionEvent:
    """Return the event of a log or a record.

    Raises
    ------
    ParameterError
        if its data are not those of its kind.
    """
    if kind not in KINDS:
        return OtherEvent(time_s=time_s, kind=kind, content=data)
    try:
        return msgspec.convert({**plain(data), "time_s": time_s}, KINDS[kind])
    except msgspec.ValidationError as error:
        raise ParameterError(f"event {kind} at {time_s:g} s: {error}") from None


def _is_default(event: ExecutionEvent, f: Any) -> bool:
    default = f.default if f.default_factory is MISSING else f.default_factory()
    return default is not MISSING and getattr(event, f.name) == default


def _plain(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value
