"""The local journal of a run of real robots: what its runner has told the server, synced before robots get orders.

What the server and its database have not taken when machines fail is in this file. The runner that goes on takes the
entries from it, and tells them again. The file has the form of `muster.running.journal_file`; entries have their
number in the log, too, and `tick` ends those that the server takes all or none.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from muster.mission.errors import InputError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.port import Waypoint
from muster.running.journal import order_data
from muster.running.journal_file import Header, JournalFile, SparedFile, read_journal
from muster.state.recovery import ORDER
from muster.state.words import words_of
from muster_control.runs.runner.pipe import Outbox

_log = logging.getLogger("muster.runs")
_TICK = "tick"
_STATES = {"pause": True, "resume": False}


class LocalJournal:
    """An outbox of a runner, whose entries are in a local file, too.

    Parameters
    ----------
    out : Outbox
        Sends messages to the server.
    begin : mapping
        The first message to the runner, which names the file. That of a run that begins is made anew.
    mission, plan : Mission, Plan
        Of the run.

    Attributes
    ----------
    begin : mapping
        The first message, with the entries that only the file has.
    obeyed : set of int
        The actions of users that are among these: they are not to be executed again.
    """

    def __init__(self, out: Outbox, begin: Mapping[str, Any], mission: Mission, plan: Plan) -> None:
        self._out, path = out, Path(begin["journal"])
        header = Header.of(mission, plan, begin["world"], (f"run {begin['run']} of {begin['at']}",))
        self._again, whole_bytes = _later_entries(path, header, begin["seq"])
        file = JournalFile(path, None if whole_bytes else header, whole_bytes)
        told = "%s: %s; the journal is removed: what the server has not taken when machines fail is not known then"
        self._file = SparedFile(file, lambda why: _log.warning(told, path, why))
        self.begin = _with(begin, self._again)
        self.obeyed = {entry["data"]["action"] for entry in self._again if entry["kind"] == "command"}

    def send_again(self) -> None:
        """Tell the server what only the file has."""
        for entry in self._again:
            self._out.entry({"type": "entry", **entry, **words_of(entry["kind"], entry["data"])})
        if self._again:
            self._out.send({"type": "tick", "bodies": None})

    def entry(self, message: Mapping[str, Any]) -> None:
        """See `log_recorder.Out`."""
        self._file.append({key: message[key] for key in ("seq", "time_s", "kind", "data")})
        self._out.entry(message)

    def stretch(self, from_s: float, until_s: float, data: bytes) -> None:
        """See `log_recorder.Out`."""
        self._out.stretch(from_s, until_s, data)

    def send(self, message: Mapping[str, Any]) -> None:
        """See `Outbox`; the end of a tick is written."""
        if message["type"] == _TICK:
            self._file.append({"time_s": 0.0, "kind": _TICK, "data": {}})
            self._file.sync()
        self._out.send(message)

    def send_if_room(self, message: Mapping[str, Any]) -> None:
        """See `Outbox`."""
        self._out.send_if_room(message)

    @property
    def full(self) -> bool:
        """See `Outbox`."""
        return self._out.full

    def before_order(self, now: float, robot: str, waypoints: Sequence[Waypoint]) -> None:
        """Write an order and sync all, before it is sent."""
        self._file.append({"time_s": round(now, 9), "kind": ORDER, "data": order_data(robot, waypoints)})
        self._file.sync()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _later_entries(path: Path, header: Header, seq: int) -> tuple[list[Mapping[str, Any]], int]:
    """The entries of a file after a number, and how much of the file is whole; none where it is of another run."""
    try:
        found = read_journal(path)
    except InputError as error:
        if path.exists():
            _log.warning("%s; what the server has not taken is not known", error)
        return [], 0
    same = found.header.parts == header.parts and found.header.claims == header.claims
    if not same:
        return [], 0
    kinds = [entry["kind"] for entry in found.entries]
    ended = len(kinds) - kinds[::-1].index(_TICK) if _TICK in kinds else 0
    cut = next((k for k in range(ended, len(kinds)) if kinds[k] == "command"), len(kinds))
    later = [entry for entry in found.entries[:cut] if entry.get("seq", 0) > seq]
    whole = [entry for k, entry in enumerate(later, start=1) if entry["seq"] == seq + k]
    return whole, found.whole_bytes


def _with(begin: Mapping[str, Any], entries: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The first message with entries that only the file has, and what users had done by them."""
    done = [entry["data"] for entry in entries if entry["kind"] == "command" and entry["data"]["outcome"] == "done"]
    verbs = [data["verb"] for data in done]
    paused = [_STATES[verb] for verb in verbs if verb in _STATES]
    return {
        **begin,
        "log": [*begin["log"], *entries],
        "seq": entries[-1]["seq"] if entries else begin["seq"],
        "paused": paused[-1] if paused else begin["paused"],
        "cancelled": begin["cancelled"] or "cancel" in verbs,
    }
