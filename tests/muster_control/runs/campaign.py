"""`python -m tests.muster_control.runs.campaign [MOST_KILLS] [--seed N] [--db URL]`: mission control is killed.

A real `muster serve` carries missions out, of which a user asks for things over its API, watches the stream, and has
more planned. Its process, a run's, or a planning worker's ends by kill -9 some times a run; when the run is over, its
log, its report and its actions are judged. Runs follow each other until so many have been killed; then the jobs are
judged: each is done once, and has one plan.
"""

import argparse
import json
import sys
import tempfile
import time
from collections import Counter
from itertools import pairwise
from pathlib import Path
from random import Random

from tests.muster_control.runs.process import Serving, kill, until
from tests.muster_control.runs.user import User, Watcher

import muster
from muster_control.store.store import Store

MISSION = "31T-6R50"
SPEED = 20.0
KILLS_A_RUN = 6
RUNNER, WORKER = "muster_control.runs.runner.main", "muster_control.work.worker"
WITHIN_S = 300.0
LONG = 20_000
"""Iterations of a plan that takes a second or so."""


class Campaign:
    """A server that is killed and started again; `counted` says how often what happened."""

    def __init__(self, kills, seed, database, log=None):
        self.kills, self.database, self.counted = kills, database, Counter()
        self._random, self._log = Random(seed), log
        self._struck = set()  # jobs under which a worker was killed: twice would be once too often
        self._server = Serving(database, log=log)
        self._store = Store.open(database)

    @property
    def killed(self):
        return sum(self.counted[what] for what in ("servers", "runners", "workers"))

    def go(self, tell=lambda _: None):
        """All of it; returns what was counted."""
        try:
            plan = self._planned()
            while self.killed < self.kills:
                self._run(plan)
                tell(dict(self.counted))
            self._judge_jobs()
            self._server.end()
        finally:
            self._store.close()
            if self._server.process.poll() is None:
                self._server.kill()
        return self.counted

    def _planned(self):
        http = self._server.http
        job = http.post(f"/missions/{MISSION}/plans", json={"iterations": 200}).json()["id"]
        return until(lambda: http.get(f"/jobs/{job}").json()["result"])["plan"]

    def _run(self, plan):
        """One run, some kills, and the judgement."""
        body = {"plan": plan, "world": "kinematic", "speed": SPEED, "settings": {"seed": 1}}
        run = self._server.http.post("/runs", json=body).json()["id"]
        watcher, most = Watcher(), min(self.kills, self.killed + KILLS_A_RUN)
        while self.killed < most and not self._over(run):
            user = self._met(run, watcher)
            going = True
            while going and self.killed < most and not self._over(run):
                time.sleep(self._random.uniform(0.0, 2.0))
                going = self._kill()
            self._leave(user)
            if not going:
                watcher.leave()
                self._server = Serving(self.database, log=self._log)
        self._leave(self._met(run, watcher), hurry=True)
        until(lambda: self._over(run), WITHIN_S)
        watcher.leave(len(self._store.log.entries(run)))
        judge(self._store, run, watcher.seen)
        self.counted["runs"] += 1
        self.counted["entries"] += len(self._store.log.entries(run))
        self.counted["actions"] += len(self._store.actions.list(run=run, limit=10_000))

    def _met(self, run, watcher):
        """A user who asks for things, and a watcher who listens."""
        watcher.watch(self._server, run)
        return User(self._server, run, MISSION, self._random.getrandbits(32), self.killed)

    def _leave(self, user, **how):
        user.leave(**how)
        assert user.faults == []
        self.counted["asked"] += user.asked

    def _over(self, run):
        return self._store.runs.get(run).ended_at is not None

    def _kill(self):
        """Something at random; whether the server still lives."""
        what = self._random.choice(("servers", "runners", "workers"))
        if what == "servers":
            self._server.kill()
            self.counted[what] += 1
            return False
        if what == "runners":
            self.counted[what] += any(kill(pid) for pid in self._server.children(RUNNER)[-1:])
        else:
            self.counted[what] += self._kill_worker()
        return True

    def _kill_worker(self):
        """One that works; whether there was one."""
        asked = self._server.http.post(f"/missions/{MISSION}/plans", json={"iterations": LONG}).json()["id"]
        until(lambda: self._store.jobs.get(asked).state != "queued")
        time.sleep(self._random.uniform(0.0, 0.3))
        at_work = {job.id for job in self._store.jobs.list("running")}
        if not at_work or at_work & self._struck:
            return False
        self._struck |= at_work
        return any(kill(pid) for pid in self._server.children(WORKER))

    def _judge_jobs(self):
        """Each job that was asked for is done, and each has one plan, and each plan is of one job."""
        jobs = until(lambda: all_over(self._store), WITHIN_S)
        self.counted["jobs"] = len(jobs)
        assert {job.state for job in jobs} == {"done"}, [job for job in jobs if job.state != "done"]
        plans = [job.result["plan"] for job in jobs]
        assert sorted(plans) == sorted(plan.id for plan in self._store.plans.list())


def all_over(store):
    """The jobs, when none is queued or under way."""
    jobs = store.jobs.list(limit=100_000)
    return jobs if all(job.ended_at is not None for job in jobs) else None


def judge(store, run, seen):
    """Each task once in the report, no gap in the log, each action once, nothing seen that was not kept."""
    entries = store.log.entries(run)
    found = store.runs.get(run)
    assert found.state == "ended", found
    assert [entry.seq for entry in entries] == list(range(1, len(entries) + 1))
    assert all(a.time_s <= b.time_s for a, b in pairwise(entries))
    kept = {entry.seq: (entry.kind, json.loads(json.dumps(entry.data))) for entry in entries}
    assert [one["seq"] for one in seen] == list(range(1, len(entries) + 1))
    assert all(kept[one["seq"]] == (one["kind"], one["data"]) for one in seen)
    reports = [entry for entry in entries if entry.kind == "report"]
    assert reports == entries[-1:]
    report = reports[0].data
    assert found.report == report
    tasks = [task.id for task in muster.load(MISSION).tasks]
    tasks += [entry.data["task"]["id"] for entry in entries if entry.kind == "new_task"]
    told = [*report["tasks_done"], *(lost["task"] for lost in report["tasks_lost"])]
    assert sorted(told) == sorted(tasks)
    ended = Counter(entry.data["task"] for entry in entries if entry.kind == "ends")
    assert ended == dict.fromkeys(report["tasks_done"], 1)
    commands = Counter(entry.data["action"] for entry in entries if entry.kind == "command")
    assert set(commands.values()) <= {1}
    outcomes = {entry.data["action"]: entry.data["outcome"] for entry in entries if entry.kind == "command"}
    actions = until(lambda: settled(store, run))
    for action in actions:
        late = "done" if action.verb == "run.start" else "the run was over before"
        assert action.outcome == outcomes.get(action.id, late), action
    assert outcomes.keys() <= {action.id for action in actions}
    assert found.resumed == sum(entry.kind == "resumed" for entry in entries)
    stretches = list(store.log.stretches(run))
    assert all(a.until_s < b.from_s for a, b in pairwise(stretches))
    assert stretches[-1].until_s >= report["mission_time_s"] - 0.2


def settled(store, run):
    """The actions of a run, when it is known what came of each."""
    return None if store.actions.unsettled(run) else store.actions.list(run=run, limit=100_000)


def tell(counted):
    sys.stdout.write(f"{counted}\n")
    sys.stdout.flush()


def main():
    parser = argparse.ArgumentParser(prog="tests.muster_control.runs.campaign", description=__doc__)
    parser.add_argument("kills", nargs="?", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--db", help="a new database; by default one of SQLite that is deleted afterwards")
    parser.add_argument("--log", help="a file for what servers say")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        database = asked.db or f"sqlite:///{Path(folder) / 'muster.db'}"
        counted = Campaign(asked.kills, asked.seed, database, asked.log).go(tell)
    killed = ", ".join(f"{counted[what]} {what}" for what in ("servers", "runners", "workers"))
    rest = ", ".join(f"{counted[what]} {what}" for what in ("runs", "entries", "actions", "jobs"))
    sys.stdout.write(f"killed: {killed}; as they should be: {rest}\n")


if __name__ == "__main__":
    main()
