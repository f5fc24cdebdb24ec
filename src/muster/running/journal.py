"""The journal of a run with real robots: what happens and what is ordered, on disk before the next order is sent.

After `kill -9`, Ctrl-C or a power cut the run goes on by it: `Live` takes the state that the journal tells, and plans
the rest from where robots are then.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

from muster.execution.final_state import FinalState
from muster.execution.record import NoObserver, Recorder, Recorders
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.motion.port import Waypoint
from muster.running.journal_file import Header, JournalFile, ReadJournal, SparedFile, read_journal
from muster.state import MissionState, event_of
from muster.state.recovery import ORDER, WANTED
from muster.state.robot_events import FinalStates
from muster.state.run_events import PlanAdopted

AWAY_M: Mapping[str, float] = {"ground": 0.5, "air": 3.0}
"""By kind of robot: metres from its start from which it is away from there."""
Say = Callable[[str], None]
"""Receives a line for people."""


class Journal(NoObserver):
    """Keeps the journal of a run; a `Recorder`, which receives orders, too.

    Parameters
    ----------
    mission : Mission
        The mission as its file has it.
    file : JournalFile
        Where lines are written.
    before : ReadJournal, optional
        What the journal holds of a run that goes on.
    say : callable, optional
        Receives why the journal breaks off: robots do not wait for a disk.

    Attributes
    ----------
    plan : Plan or None
        The plan with which the run began, of one that goes on.
    state : MissionState or None
        What is known of a mission that goes on; it is for the run, which changes it.
    """

    def __init__(
        self, mission: Mission, file: JournalFile, before: ReadJournal | None, ignored: Collection[str], say: Say | None
    ) -> None:
        self._file = SparedFile(file, self._give_up)
        self._say = (lambda line: None) if say is None else say
        self.path = file.path
        self.plan = None if before is None else before.plan
        self._told = () if before is None else before.entries
        known = None if before is None else before.state(mission)
        self.state = None if known is None or known.zero_s is None else known  # else nothing was ordered
        self._known = MissionState(mission, ignored) if before is None else before.state(mission)

    @classmethod
    def begun(
        cls, path: str | Path, mission: Mission, header: Header, ignored: Collection[str], say: Say | None = None
    ) -> Self:
        """Begin the journal of a run; one that is there is replaced.

        Raises
        ------
        InputError
            if the file cannot be written.
        """
        return cls(mission, JournalFile(Path(path), header), None, ignored, say)

    @classmethod
    def resumed(cls, before: ReadJournal, mission: Mission, say: Say | None = None) -> Self:
        """Go on with a journal that was read.

        Raises
        ------
        InputError
            if the file cannot be written.
        """
        return cls(mission, JournalFile(before.path, None, before.whole_bytes), before, (), say)

    def with_others(self, others: Recorder | None) -> Recorder:
        """Return the journal together with other recorders, which are told what happened before the run goes on."""
        if others is None:
            return self
        if self.plan is not None and self.state is not None:
            others.on_plan(0.0, self.plan)
            for entry in self._told:
                if entry["kind"] not in (PlanAdopted.kind, ORDER, WANTED):
                    others.on_event(entry["time_s"], entry["kind"], entry["data"])
        return Recorders(self, others)

    def on_event(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        """See `Recorder`."""
        self._known.apply(event_of(now, kind, data))
        self._write(now, kind, data)

    def on_plan(self, now: float, plan: Plan) -> None:
        """See `Recorder`; what the plan changes is written."""
        adopted = PlanAdopted.of(plan, self._known).at(now)
        self._known.apply(adopted)
        self._write(now, adopted.kind, adopted.data)

    def on_step(self, now: float, *states: object) -> None:
        """See `Recorder`: robots say where they are when the run goes on. What was written is synced."""
        self._file.sync()

    def on_report(self, report: Mapping[str, Any]) -> None:
        """See `Recorder`: it follows from what was written."""

    def on_order(self, now: float, robot: str, waypoints: Sequence[Waypoint]) -> None:
        """Write an order and sync all, before it is sent; without way points the robot stays where it is."""
        self._write(now, ORDER, order_data(robot, waypoints))
        self._file.sync()

    def on_last_order(self, at_end: str) -> None:
        """Write what robots do when all is done, and sync it, before they are told: such as `return`, or `land`."""
        self._write(self._known.now_s, WANTED, {"at_end": at_end})
        self._file.sync()

    def end(self, states: Sequence[FinalState]) -> None:
        """Write where robots are when all is done, or the run is interrupted."""
        self._write(self._known.now_s, FinalStates.kind, final_states_event(states).data)
        self._file.sync()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _write(self, now: float, kind: str, data: Mapping[str, Any]) -> None:
        self._file.append({"time_s": round(now, 9), "kind": kind, "data": data})

    def _give_up(self, why: str) -> None:
        self._say(f"warning: {self.path}: {why}; the journal is removed: the run goes on, and cannot be resumed")


def order_data(robot: str, waypoints: Sequence[Waypoint]) -> dict[str, Any]:
    """Return an order as journals have it: whose, where it leads (None: the robot stays), for which tasks."""
    labels = list(dict.fromkeys(waypoint.label for waypoint in waypoints if waypoint.label))
    to = [round(c, 4) for c in waypoints[-1].position] if waypoints else None
    return {"robot": robot, "to": to, "for": labels}


def final_states_event(states: Sequence[FinalState]) -> FinalStates:
    """Return the event that says where robots are at the end."""
    robots = ({"robot": one.robot, "moving": one.moving, "words": str(one)} for one in states)
    return FinalStates(robots=tuple(robots))


def interrupted_run(path: Path) -> ReadJournal | None:
    """Return the journal at a place, if it says that a run did not end; None without one.

    Raises
    ------
    InputError
        if there is a file that is no journal.
    """
    if not path.exists():
        return None
    found = read_journal(path)
    return None if found.ended else found


def left_behind(before: ReadJournal, mission: Mission, states: Sequence[FinalState]) -> list[str]:
    """Return a text for each robot that a run has left armed, moving, or away from its start.

    Parameters
    ----------
    before : ReadJournal
        The journal of a run that did not end. Of another mission it is not known where robots began: then only those
        count that are armed, or move.
    mission : Mission
        The mission now.
    states : sequence of FinalState
        Where robots are now.
    """
    known = before.state(mission).robots if before.is_of(mission) else {}
    starts = {name: one.robot for name, one in known.items()}
    found = []
    for one in states:
        robot, away_m = starts.get(one.robot), 0.0
        if robot is not None and one.position is not None:
            away_m = math.dist(one.position[:2], robot.position[:2])
        far = robot is not None and away_m > AWAY_M.get(robot.kind, AWAY_M["ground"])
        if one.moving or far:
            found.append(f"{one}, {away_m:.1f} m from its start" if far else str(one))
    return found
