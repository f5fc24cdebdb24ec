"""Actions that could not be written when they were requested: they take effect, and are written later.

Each has the time of its request as its number: microseconds since 1970, negative. If the database has written it after
all, it is found by that time and not executed twice.
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


def unsaved_action(who: User, verb: str, data: Mapping[str, Any], run: int, at: datetime) -> Action:
    """An action that is not in the database."""
    return Action(
        id=number_at(at),
        at=at,
        who=who.name,
        role=who.role,
        address=who.address,
        verb=verb,
        data=data,
        run=run,
        kept=False,
    )
