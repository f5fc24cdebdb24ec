"""Recovers what was known in a run after a crash, from its last checkpoint and the entries of its log after it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.state.checkpoint import restored
from muster.state.event import event_of
from muster.state.mission_state import MissionState

ORDER = "order"
"""The kind of entries that say where a robot is sent: written before it is sent there."""
WANTED = "wanted"
"""The kind of entries that say what robots are to do at the end: written before they are told."""
_OF_THE_RUN = ("report", "command", ORDER, WANTED)
"""Kinds of log entries that are no events of the mission."""


def recovered_from(
    mission: Mission, plan: Plan, log: Iterable[Mapping[str, Any]], checkpoint: Mapping[str, Any] | None = None
) -> MissionState:
    """Recover what was known of a mission.

    Parameters
    ----------
    mission : Mission
        The mission at the beginning.
    plan : Plan
        The plan at the beginning, with the rules that do not hold.
    log : iterable of mappings
        The entries of the log, with `time_s`, `kind` and `data`; those after the checkpoint, if there is one.
    checkpoint : mapping or None
        What `checkpoint_of` returned.

    Returns
    -------
    MissionState
        What was known after the last entry.
    """
    state = MissionState(mission, plan.ignored) if checkpoint is None else restored(mission, checkpoint)
    for entry in log:
        if entry["kind"] not in _OF_THE_RUN:
            state.apply(event_of(float(entry["time_s"]), entry["kind"], entry["data"]))
    return state
