"""Folds the journal of a server into the database, before the runs go on: each item once, in order."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from muster_control.contract import OVER, Action, ConflictError, Entry, NotFoundError, Tick
from muster_control.runs.log.journal import Item, Journal

if TYPE_CHECKING:
    from muster_control.store.store import Store

TOO_LATE = "the run was over before"
"""The outcome of an action that came too late."""

_log = logging.getLogger("muster.runs")


def replay(journal: Journal, store: Store) -> None:
    """Write what the journal has into the database, and empty the journal.

    What the database has already is passed over. What it cannot take, because the run is gone or another server has
    gone on with its log, is reported, and stays in a copy of the file.

    Raises
    ------
    StoreError
        if the database cannot be written; the journal is as before then.
    """
    items = journal.read()
    left_out = [why for run in sorted({item.run or 0 for item in items}) for why in _replay_run(store, run, items)]
    if left_out:
        copy = journal.set_aside()
        for why in left_out:
            _log.error("%s: left out, %s is a copy: %s", journal.path, copy, why)
    if items:
        _log.warning("%s: %d items that only the journal had are in the database", journal.path, len(items))
    journal.empty()


def _replay_run(store: Store, run: int, items: Sequence[Item]) -> list[str]:
    """Write the items of a run; returns why some were left out."""
    tick = next((item for item in reversed(items) if isinstance(item, Tick) and item.run == run), None)
    entries = [item for item in items if isinstance(item, Entry) and item.run == run]
    if tick is not None:  # a power cut may have kept a part of the tick after it
        entries = [entry for entry in entries if entry.seq <= tick.seq]
    actions = [item for item in items if isinstance(item, Action) and item.run == run]
    left_out: list[str] = []
    try:
        if entries:
            known = store.log.bodies(run)
            newer = tick is not None and (known is None or known["seq"] <= tick.seq)
            store.log.append(run, entries[-1].time_s, entries, bodies=tick.bodies if newer and tick else None)
    except (ConflictError, NotFoundError) as error:
        left_out.append(str(error))
    try:
        over = store.runs.get(run).state in OVER
    except NotFoundError as error:
        return [*left_out, f"{len(actions)} actions: {error}"] if actions else left_out
    store.actions.keep(_settled(actions, store.log.entries(run)) if over else actions)
    return left_out


def _settled(actions: Sequence[Action], log: Sequence[Entry]) -> list[Action]:
    """The actions of a run that is over, with the outcomes that its log has."""
    applied = {entry.data["action"]: entry for entry in log if entry.kind == "command"}
    return [
        replace(action, outcome=applied[action.id].data["outcome"], applied_s=applied[action.id].time_s)
        if action.id in applied
        else replace(action, outcome=action.outcome or TOO_LATE)
        for action in actions
    ]
