"""Events from users."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from muster.mission.errors import ParameterError
from muster.mission.model import Event
from muster.mission.records import Record
from muster.mission.value_types import Fault
from muster.mission.values.clock_times import clock_times_to_seconds


def event_given(data: Mapping[str, Any], now: float, starts_at: str | None) -> Event:
    """An event as in a mission file, without its time; clock times are counted from the start of the mission.

    Raises
    ------
    ParameterError
        if it is no event, or has clock times and the mission no `starts_at`.
    """
    faults: list[Fault] = []
    given = {**deepcopy(dict(data)), "at_s": now}
    clock_times_to_seconds({"starts_at": starts_at, "events": [given]}, faults)
    event: Event = Record(Event, "an event").read(given, ("events", 0), faults)
    if faults:
        where = ".".join(map(str, faults[0].path[2:]))
        raise ParameterError(f"{where + ': ' if where else ''}{faults[0].value}; expected {faults[0].expected}")
    return event
