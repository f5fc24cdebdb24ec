"""`python -m tests.muster_control.runs.double_faults [FAULTS] [--seed N]`: the database away, then the server killed.

A real `muster serve` on a real PostgreSQL carries out runs of a fleet on duty, and four users order tasks. Then the
database is stopped or frozen, and when enough orders were accepted without it the server ends by kill -9. Both are
started again. In the end each order that was answered 202 is in the log and among the actions, once and in order.
"""

import argparse
import os
import sys
import tempfile
import threading
import time
from collections import Counter, defaultdict
from random import Random

import httpx
from tests.muster_control.databases import PostgreSQL, postgresql_programs
from tests.muster_control.runs.campaign import tell
from tests.muster_control.runs.process import Serving, until

from muster_control.store.store import Store

FAULTS_A_RUN = 4
USERS = 4
ORDERS = 100
"""How many orders are accepted at least while the database is away, before the server is killed."""
WITHIN_S = 300.0
MISSION = """schema: muster/1
name: duty
rules: {objective: lateness}
robots:
- {id: r_0, position: [0, 0], speed_mps: 5}
- {id: r_1, position: [10, 0], speed_mps: 5}
- {id: r_2, position: [20, 0], speed_mps: 5}
tasks:
- {id: first, position: [1, 1]}
"""
_GONE = (httpx.TransportError, OSError)


class Orderer(threading.Thread):
    """A user who orders tasks until the server is gone; `accepted` is what was answered 202: [(action, tasks)]."""

    def __init__(self, server, run, seed, name):
        super().__init__()
        self._http = httpx.Client(base_url=f"{server.url}/api/v1", timeout=30)
        self._run_id, self._random, self._name = run, Random(seed), name
        self.accepted, self.faults = [], []
        self.start()

    def run(self):
        try:
            k = 0
            while not self.faults:
                tasks = [f"{self._name}-{k + n}" for n in range(self._random.randint(1, 5))]
                k += len(tasks)
                self._order(tasks)
        except _GONE:
            return

    def _order(self, tasks):
        place = [round(self._random.uniform(0, 20), 2), round(self._random.uniform(0, 9), 2)]
        orders = [{"new_task": {"id": task, "position": place}} for task in tasks]
        answer = self._http.post(f"/runs/{self._run_id}/orders", json={"orders": orders})
        while answer.status_code == 429:
            time.sleep(0.1)
            answer = self._http.post(f"/runs/{self._run_id}/orders", json={"orders": orders})
        if answer.status_code == 202:
            self.accepted.append((answer.json()["id"], tasks))
        else:
            self.faults.append(f"{answer.status_code}: {answer.text}")


class DoubleFaults:
    """A database that goes away and a server that is killed then; `counted` says how often what happened."""

    def __init__(self, faults, seed=1, orders=ORDERS, log=None):
        self._faults, self._orders, self._random, self._log = faults, orders, Random(seed), log
        self.counted = Counter()
        self._postgresql = PostgreSQL(postgresql_programs())
        self._database = self._postgresql.new()
        self._server = Serving(self._database, log=log)
        self._store = Store.open(self._database)
        self._accepted = defaultdict(list)  # per user of a run and fault, in order

    def go(self, tell=lambda _: None):
        """All of it; returns what was counted."""
        try:
            plan = self._planned()
            while self.counted["faults"] < self._faults:
                self._run(plan, tell)
            self._server.end()
        finally:
            self._store.close()
            if self._server.process.poll() is None:
                self._server.kill()
            self._postgresql.close()
        return self.counted

    def _planned(self):
        http = self._server.http
        mission = http.post("/missions", json={"text": MISSION}).json()["id"]
        job = http.post(f"/missions/{mission}/plans", json={"iterations": 10}).json()["id"]
        return until(lambda: http.get(f"/jobs/{job}").json()["result"])["plan"]

    def _run(self, plan, tell):
        """One run, some faults, and the judgement."""
        body = {"plan": plan, "speed": 2.0, "settings": {"stay": True, "planning": {"allocator": "greedy"}}}
        run = self._server.http.post("/runs", json=body).json()["id"]
        self._accepted.clear()
        for _ in range(min(FAULTS_A_RUN, self._faults - self.counted["faults"])):
            self._fault(run)
            tell(dict(self.counted))
        until(lambda: not self._store.actions.unsettled(run), WITHIN_S)
        self._judge(run)
        assert self._server.http.post(f"/runs/{run}/actions", json={"verb": "cancel"}).status_code == 202
        until(lambda: self._store.runs.get(run).ended_at is not None, WITHIN_S)
        self.counted["runs"] += 1

    def _fault(self, run):
        """The database goes away while orders come, then the server is killed; both are started again."""
        number = self.counted["faults"]
        users = [Orderer(self._server, run, self._random.getrandbits(32), f"o{number}u{k}") for k in range(USERS)]
        time.sleep(self._random.uniform(0.0, 0.5))
        freezes = self._random.random() < 0.5
        (self._postgresql.freeze if freezes else self._postgresql.stop)()
        before = _orders(users)
        until(lambda: _orders(users) >= before + self._orders or _faults(users), WITHIN_S)
        time.sleep(self._random.uniform(0.0, 0.3))
        self._server.kill()
        for user in users:
            user.join()
        assert _faults(users) == []
        (self._postgresql.thaw if freezes else self._postgresql.start)()
        self._server = Serving(self._database, log=self._log)
        for k, user in enumerate(users):
            self._accepted[number, k] = user.accepted
        self.counted["frozen" if freezes else "stopped"] += 1
        self.counted["faults"] += 1
        self.counted["orders"] += _orders(users)
        self.counted["orders while away"] += _orders(users) - before

    def _judge(self, run):
        """Each accepted order took effect, once, and those of a user in order; nothing is left in the journal."""
        log = self._store.log.entries(run)
        commands = [entry.data["action"] for entry in log if entry.kind == "command"]
        tasks = [entry.data["task"]["id"] for entry in log if entry.kind == "new_task"]
        assert max(Counter(commands).values()) == 1
        assert max(Counter(tasks).values()) == 1
        outcomes = {action.id: action.outcome for action in self._store.actions.list(run=run, limit=1_000_000)}
        place = {action: k for k, action in enumerate(commands)}
        for accepted in self._accepted.values():
            lost = [one for one in accepted if outcomes.get(one[0]) != "done" or one[0] not in place]
            assert lost == [], f"run {run}: {len(lost)} of {len(accepted)} lost, the first: {lost[0]}"
            assert {task for _, ordered in accepted for task in ordered} <= set(tasks)
            assert [one for one, _ in accepted] == sorted((one for one, _ in accepted), key=place.__getitem__)


def _orders(users):
    return sum(len(tasks) for user in users for _, tasks in tuple(user.accepted))


def _faults(users):
    return [fault for user in users for fault in user.faults]


def main():
    parser = argparse.ArgumentParser(prog="tests.muster_control.runs.double_faults", description=__doc__)
    parser.add_argument("faults", nargs="?", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--orders", type=int, default=ORDERS, help="accepted while the database is away, a fault")
    parser.add_argument("--log", help="a file for what servers say")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_DATA_HOME"] = folder  # of the servers' journals
        counted = DoubleFaults(asked.faults, asked.seed, asked.orders, asked.log).go(tell)
    sys.stdout.write(
        f"0 of {counted['orders']} accepted orders lost, {counted['orders while away']} of them accepted without the "
        f"database, in {counted['faults']} double faults ({counted['stopped']} databases stopped, "
        f"{counted['frozen']} frozen) of {counted['runs']} runs\n"
    )


if __name__ == "__main__":
    main()
