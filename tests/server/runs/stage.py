"""A run without processes: what users ask for comes at moments of the mission's clock, what is told is collected."""

from contextlib import closing, suppress
from dataclasses import dataclass, field

import numpy as np

from muster.mission.clock import VirtualClock
from muster.server.runs.log_recorder import LogRecorder
from muster.server.runs.run_loop import RunLoop
from muster.server.runs.simulated_run import SimulatedRun
from muster.server.runs.tracks import unpacked


class Killed(Exception):  # noqa: N818  # no error
    """The process of a run is no more."""


@dataclass
class Kept:
    """What a run told until it was killed: entries as a log has them, tracks, and what is out of date soon.

    It is killed once `most` entries are kept; None: it is not.
    """

    log: list = field(default_factory=list)
    tracks: list = field(default_factory=list)
    others: list = field(default_factory=list)
    most: int | None = None
    full = False

    def entry(self, message):
        if len(self.log) == self.most:
            raise Killed
        self.log.append({key: message[key] for key in ("seq", "time_s", "kind", "data")})

    def stretch(self, from_s, until_s, data):
        self.tracks.append((from_s, until_s, unpacked(data)))

    def send(self, message):
        self.others.append(message)

    send_if_room = send


class Script:
    """An inbox: (moment, verb, data) of the mission's clock, each said once it has come, or while nothing goes on."""

    def __init__(self, world_run, asked):
        self._world_run = world_run
        self._asked = [
            (at_s, {"id": k, "verb": verb, "data": data, "who": "ada"})
            for k, (at_s, verb, data) in enumerate(asked, start=1)
        ]

    def take(self, wait_s=0.0):
        if self._asked and (wait_s is None or self._world_run.time_s >= self._asked[0][0]):
            return self._asked.pop(0)[1]
        assert wait_s is not None, "it waits for ever"
        return None


def performed(
    mission,
    plan,
    asked=(),
    *,
    world="kinematic",
    log=(),
    tracked_s=0.0,
    settings=None,
    ended=lambda: False,
    until_s=None,
    killed_after=None,
):
    """Carry a plan out to its end, or until it is killed; returns what was told, behind the log that there was."""
    kept = Kept(most=killed_after)
    recorder = LogRecorder(mission, kept, log=log, tracked_s=tracked_s)
    with suppress(Killed), closing(SimulatedRun(mission, plan, world, settings or {}, recorder)) as world_run:
        script = Script(world_run, asked)
        how = {"speed": None, "starts_at": mission.starts_at, "ended": ended, "clock": VirtualClock(step_s=1.0)}
        run_loop = RunLoop(world_run, recorder, script, kept, **how)
        run_loop.catch_up(log, max([until_s or 0.0, *(entry["time_s"] for entry in log)]) if log else 0.0)
        run_loop.run()
    return kept


def performed_with_crashes(mission, plan, asked, crashes, **how):
    """The log and the tracks of a run that is killed each time when so many entries are kept, and resumed."""
    log, tracks = [], []
    for crash in [*crashes, None]:
        more = None if crash is None else max(crash - len(log), 0)
        tracked_s = tracks[-1][1] if tracks else 0.0
        kept = performed(mission, plan, asked, log=log, tracked_s=tracked_s, killed_after=more, **how)
        log, tracks = [*log, *kept.log], [*tracks, *kept.tracks]
    return log, tracks


def require_same(log, tracks, whole):
    """What is killed and resumed leaves the log and the tracks of what never was."""
    assert story(log) == story(whole.log)
    assert [entry["seq"] for entry in log] == list(range(1, len(log) + 1))
    assert [(a, b) for a, b, _ in tracks] == [(a, b) for a, b, _ in whole.tracks]
    for one, other in zip(tracks, whole.tracks, strict=True):
        np.testing.assert_array_equal(one[2].states, other[2].states)


def story(log):
    """A log without what tells of crashes, and without numbers."""
    return [(entry["time_s"], entry["kind"], entry["data"]) for entry in log if entry["kind"] != "resumed"]
