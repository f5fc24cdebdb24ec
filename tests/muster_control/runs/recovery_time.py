"""`python -m tests.muster_control.runs.recovery_time [ORDERS]`: how long a recovery takes.

A database gets the log of a standing fleet, as a server that is killed leaves it: with all entries since the first
order, the last checkpoint, and where robots stood. Then `muster serve` is started with it. Told are the seconds until
the run goes on, and the memory of server and runner.
"""

import sys
import tempfile
import time
from itertools import islice
from pathlib import Path

from tests.muster_control.runs.process import serving, until
from tests.muster_control.runs.stage import performed
from tests.muster_control.runs.store import planned

import muster
from muster.mission.model import Mission, Robot, Rules
from muster.state import MissionState, checkpoint_of, event_of
from muster_control.contract import Checkpoint, Entry
from muster_control.runs.log.checkpoints import MOST_ENTRIES, packed_state
from muster_control.store.store import Store

ROBOTS = 20
APART_S, KEEP_S = 0.5, 300.0
"""Seconds between two orders; after which those that are done are forgotten."""
RUNNER = "muster_control.runs.runner.main"
FACTS = {"state": "running", "speed": 1.0, "resumed": 0}
_AT_ONCE = 500


def mission():
    robots = tuple(Robot(id=f"r_{k}", position=(10.0 * k, 0.0), speed_mps=2.0) for k in range(ROBOTS))
    return Mission(name="standing fleet", robots=robots, tasks=(), rules=Rules(objective="lateness"))


def story(orders):
    """The entries of a fleet that serves one order after the other: time, kind and data."""
    for k in range(orders):
        now, task, robot = k * APART_S, f"o_{k}", f"r_{k % ROBOTS}"
        told = {"task": task, "robot": robot, "used": 3.0 * (k // ROBOTS)}
        order = {"id": task, "position": [k % 190, 1.0 + k % 7], "due_s": now}
        asked = {"action": k + 1, "verb": "event", "data": {"new_task": order}, "who": "ada", "outcome": "done"}
        yield now, "command", asked
        yield now, "new_task", {"task": order}
        yield now, "replanned", {"causes": [{"kind": "new_task", "task": order}], "added": {task: robot}}
        yield now, "plan", {"routes": {robot: [task]}, "stops": {}, "lines": {robot: [[0, 0], [1, 1]]}, "left_out": {}}
        for kind in ("sets_out", "arrives", "starts"):
            yield now, kind, told
        if k < orders - ROBOTS:  # the last are under way
            yield now, "ends", {**told, "usage": [3.0, 3.0]}
        if k % 60 == 59 and (old := k - int(KEEP_S / APART_S)) >= 60:
            yield now, "forgets", {"tasks": [f"o_{one}" for one in range(old - 59, old + 1)]}


def filled(store, orders):
    """A run with the log of so many orders; the last checkpoint is as old as it gets. Returns its size in bytes."""
    there = mission()
    number = planned(store, there)
    plan = store.plans.get(number)
    run = store.runs.add(plan.mission, plan.mission_version, number, "kinematic", {"stay": True}, 1.0, "ada").id
    begun = performed(there, muster.solve(there, "greedy"), settings={"stay": True, "until_s": 1.0})
    first = (0.0, "plan", begun.log[0]["data"])
    state, entries, seq = MissionState(there), [first, *story(orders)], 0
    for portion in batched(entries, _AT_ONCE):
        rows = [Entry(run=run, seq=seq + k, time_s=t, kind=kind, data=d) for k, (t, kind, d) in enumerate(portion, 1)]
        store.log.append(run, rows[-1].time_s, rows)
        seq = rows[-1].seq
        for now, kind, data in portion:
            if kind != "command":
                state.apply(event_of(now, kind, data))
        if seq <= len(entries) - MOST_ENTRIES + _AT_ONCE:
            kept = Checkpoint(run=run, seq=seq, data=packed_state(checkpoint_of(state)), facts=FACTS)
    store.log.add_checkpoint(kept)
    last = Entry(run=run, seq=seq + 1, time_s=orders * APART_S, kind="seen", data={})
    store.log.append(run, last.time_s, [last], bodies={**begun.bodies, "time_s": last.time_s, "seq": last.seq})
    store.runs.set(run, state="running")
    return run, last.seq, len(kept.data)


def batched(items, size):
    items = iter(items)
    return iter(lambda: list(islice(items, size)), [])


def memory_mb(pid):
    status = Path(f"/proc/{pid}/status").read_text()
    return int(status.partition("VmRSS:")[2].split()[0]) / 1024


def told(file, run, entries, orders):
    """The seconds until the server answers, and the run goes on; and the memory of both, MB."""
    begun = time.monotonic()
    with serving(f"sqlite:///{file}") as server:
        started = time.monotonic()
        until(lambda: server.http.get(f"/runs/{run}").json()["state"] == "running", 600.0)
        ended = time.monotonic()
        sizes = [memory_mb(pid) for pid in (server.process.pid, *server.children(RUNNER))]
        until(
            lambda: "resumed" in {one["kind"] for one in server.http.get(f"/runs/{run}/events?after={entries}").json()}
        )
        assert server.http.get(f"/runs/{run}").json()["time_s"] >= orders * APART_S
    return (started - begun, ended - started), sizes


def main(orders=100_000):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "muster.db"
        store = Store.open(f"sqlite:///{file}")
        run, entries, checkpoint = filled(store, orders)
        store.close()
        size = f"{entries} entries, a database of {file.stat().st_size / 2**20:.0f} MB"
        sys.stdout.write(f"{orders} orders: {size}, the last checkpoint {checkpoint / 1024:.0f} kB\n")
        seconds, sizes = told(file, run, entries, orders)
        sys.stdout.write("the server answers after {:.1f} s, the run goes on {:.1f} s later\n".format(*seconds))
        sys.stdout.write("memory: server {:.0f} MB, runner {:.0f} MB\n".format(*sizes))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
