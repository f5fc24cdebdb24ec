"""Events from users."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.model import Event
from muster.mission.records import Record
from muster.mission.value_types import Fault


def event_given(data: Mapping[str, Any], now: float) -> Event:
    """An event as in a mission file, without its time.

    Raises
    ------
    ParameterError
        if it is no event.
    """
    faults: list[Fault] = []
    event: Event = Record(Event, "an event").read({**data, "at_s": now}, (), faults)
    if faults:
        where = ".".join(map(str, faults[0].path))
        raise ParameterError(f"{where + ': ' if where else ''}{faults[0].value}; expected {faults[0].expected}")
    return event
