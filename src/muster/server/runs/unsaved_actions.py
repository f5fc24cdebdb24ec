"""Actions that the database has not taken when they were asked for: they are obeyed, and written down later.

Each is known by when it was asked for, to the microsecond: its number is that of microseconds since 1970, below 0.
The database may have taken it all the same, and said so too late; by that time it is found there, and not done twice.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime, timedelta
from typing import Any

from muster.exchange.mission_control import Action, User

_1970 = datetime(1970, 1, 1, tzinfo=UTC)


def number_at(at: datetime) -> int:
    """The number of an action of that time."""
    return -((at - _1970) // timedelta(microseconds=1))


def unkept(who: User, verb: str, data: Mapping[str, Any], run: int, at: datetime) -> Action:
    """An action without a number of the database."""
    return Action(
        id=number_at(at), at=at, who=who.name, role=who.role, address=who.address, verb=verb, data=data, run=run
    )
