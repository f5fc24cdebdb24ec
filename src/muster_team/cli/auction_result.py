"""The result of an auction among robots, for the command."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from muster_team.negotiators.robot_view import View


@dataclass(frozen=True)
class Agreement:
    """The result of an auction: the view of each robot, by robot, and the seconds that it took."""

    views: dict[str, View]
    took_s: float


def by_kind(sent: Mapping[str, int]) -> str:
    """How many messages were sent, by kind."""
    return ", ".join(f"{sent[kind]} {kind}" for kind in ("news", "repairs", "heartbeats", "greetings"))
