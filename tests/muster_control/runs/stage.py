"""A run without processes: what users ask for comes at moments of the mission's clock, what is told is collected."""

from collections import Counter
from collections.abc import Callable
from contextlib import closing, suppress
from dataclasses import dataclass, field
from itertools import pairwise

from muster.mission.system.clock import VirtualClock
from muster_control.runs.log.tracks import unpacked
from muster_control.runs.runner.log_recorder import LogRecorder
from muster_control.runs.runner.main import _known, _world_run
from muster_control.runs.runner.run_loop import RunLoop


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
    bodies: dict | None = None
    checkpoint: dict | None = None
    tick: list = field(default_factory=list)
    full = False
    on_tick: Callable = lambda: None

    def entry(self, message):
        if len(self.log) + len(self.tick) == self.most:
            raise Killed
        self.tick.append({key: message[key] for key in ("seq", "time_s", "kind", "data")})

    def stretch(self, from_s, until_s, data):
        self.tracks.append((from_s, until_s, unpacked(data)))

    def send(self, message):
        if message["type"] == "tick":  # entries of one that is not ended never were
            self.log += self.tick
            self.tick = []
            self.bodies = message["bodies"]
            self.on_tick()
        elif message["type"] == "checkpoint":
            self.checkpoint = message
        else:
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
    before=None,
    settings=None,
    ended=lambda: False,
    killed_after=None,
    paused=False,
    cancelled=False,
    on_tick=lambda state: None,
):
    """Carry a plan out to its end, or until it is killed, after what is `Kept` of `before`; returns what was told."""
    kept, before = Kept(most=killed_after), before or Kept()
    kept.on_tick = lambda: on_tick(recorder.state)
    begin = {
        "world": world,
        "settings": settings or {},
        "seq": len(before.log),
        "checkpoint": before.checkpoint and before.checkpoint["data"],
        "log": before.log[before.checkpoint["seq"] if before.checkpoint else 0 :],
        "bodies": before.bodies,
        "until_s": max((one["time_s"] for one in (*before.log, *before.others) if "time_s" in one), default=0.0),
    }
    state = _known(begin, mission, plan)
    tracked_s = before.tracks[-1][1] if before.tracks else 0.0
    recorder = LogRecorder(mission, kept, state, seq=begin["seq"], tracked_s=tracked_s)
    with suppress(Killed), closing(_world_run(begin, mission, plan, recorder, None)) as world_run:
        script = Script(world_run, asked)
        how = {"speed": None, "starts_at": mission.starts_at, "ended": ended, "clock": VirtualClock(step_s=1.0)}
        how |= {"paused": paused, "cancelled": cancelled, "checkpoint": len(before.log) - len(begin["log"])}
        RunLoop(world_run, recorder, script, kept, **how).run()
    return kept


def performed_with_crashes(mission, plan, asked, crashes, **how):
    """All that is kept of a run that is killed each time when so many more entries are kept, and resumed."""
    whole = Kept()
    for crash in [*crashes, None]:
        if whole.log and whole.log[-1]["kind"] == "report":
            break  # it was over before it could be killed
        commands = [entry["data"] for entry in whole.log if entry["kind"] == "command"]
        done = [one["verb"] for one in commands if one["outcome"] == "done" and one["verb"] in ("pause", "resume")]
        how["paused"] = done[-1:] == ["pause"]
        kept = performed(mission, plan, asked[len(commands) :], before=whole, killed_after=crash, **how)
        bodies, checkpoint = kept.bodies or whole.bodies, kept.checkpoint or whole.checkpoint
        parts = [getattr(whole, name) + getattr(kept, name) for name in ("log", "tracks", "others")]
        whole = Kept(*parts, bodies=bodies, checkpoint=checkpoint)
    return whole


def require_whole(kept, mission):
    """What is killed and resumed has no gap, and accounts for each task once."""
    log, tracks = kept.log, kept.tracks
    assert [entry["seq"] for entry in log] == list(range(1, len(log) + 1))
    assert all(a["time_s"] <= b["time_s"] for a, b in pairwise(log))
    assert all(a[1] < b[0] for a, b in pairwise(tracks))
    assert [entry["kind"] for entry in log].count("report") == 1
    report = log[-1]["data"]
    tasks = [task.id for task in mission.tasks]
    tasks += [entry["data"]["task"]["id"] for entry in log if entry["kind"] == "new_task"]
    told = [*report["tasks_done"], *(lost["task"] for lost in report["tasks_lost"])]
    assert sorted(told) == sorted(tasks)
    ended = Counter(entry["data"]["task"] for entry in log if entry["kind"] == "ends")
    again = {entry["data"]["task"] for entry in log if entry["kind"] == "load_lies"}
    assert all(count == 1 or task in again for task, count in ended.items())
    assert set(report["tasks_done"]) <= ended.keys()
