"""What robots that hold an auction have agreed on, for the command."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from muster.negotiation.robot_view import View


@dataclass(frozen=True)
class Agreement:
    """What robots have agreed on: how each sees it (by robot), and how long it took, seconds."""

    views: dict[str, View]
    took_s: float


def by_kind(sent: Mapping[str, int]) -> str:
    """How many messages were sent, by kind."""
    return ", ".join(f"{sent[kind]} {kind}" for kind in ("news", "repairs", "heartbeats", "greetings"))
