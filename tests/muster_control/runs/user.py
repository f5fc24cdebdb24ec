"""Uses mission control over its API while it is killed: a user who asks for things at random, and a watcher."""

import json
import threading
from random import Random

import httpx
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

import muster

_GONE = (httpx.TransportError, OSError)


class User:
    """Asks one thing after the other in a thread, until it leaves, the run is over, or the server is gone.

    `faults` are answers that no user should get, `asked` counts what was asked for.
    """

    def __init__(self, server, run, mission, seed, number):
        self._run, self._mission = run, mission
        self._http = httpx.Client(base_url=f"{server.url}/api/v1", timeout=30)
        self._random, self._number = Random(seed), number
        there = muster.load(mission)
        self._robots, self._tasks = [r.id for r in there.robots], [t.id for t in there.tasks]
        places = zip(*(task.position for task in there.tasks), strict=True)
        self._floor = [(min(axis), max(axis)) for axis in places]
        self.faults, self.asked = [], 0
        self._leaving = threading.Event()
        self._thread = threading.Thread(target=self._go)
        self._thread.start()

    def leave(self, *, hurry=False):
        """Ask for nothing more, but maybe that the run comes to its end as fast as it goes."""
        self._leaving.set()
        self._thread.join()
        if hurry:
            self._act("speed", speed=None)
        self._http.close()

    def _go(self):
        try:
            self._act("resume")  # a pause may have been the last thing before a kill
            while not self._leaving.wait(self._random.uniform(0.05, 0.5)):
                if self._random.random() < 0.25:
                    self._plan()
                elif not self._ask():
                    return
            self._act("resume")
        except _GONE:  # the server was killed
            return

    def _ask(self):
        """Something that a user may want of a run; new tasks have names of their own. Whether it is under way."""
        what = self._random.random()
        robot, task = self._random.choice(self._robots), self._random.choice(self._tasks)
        place = [round(self._random.uniform(*side), 2) for side in self._floor]
        new = {"id": f"new-{self._random.getrandbits(40):x}", "position": place, "type": "B"}
        if what < 0.15:
            going = self._act("pause")
            self._leaving.wait(self._random.uniform(0, 0.2))
            return self._act("resume") and going
        if what < 0.3:
            return self._act("speed", speed=self._random.choice((10, 20, 40)))
        events = ({"new_task": new}, {"cancel_task": task}, {"robot_fails": robot}, {"robot_returns": robot})
        moved = {"move_task": {"task": task, "position": place}}
        return self._act("event", **self._random.choice((*events, {"robot_returns": robot}, moved)))

    def _act(self, verb, **data):
        answer = self._http.post(f"/runs/{self._run}/actions", json={"verb": verb, "data": data})
        return self._answered(answer, 202, 409)

    def _plan(self):
        wishes = {"iterations": self._random.choice((1, 50, 5000)), "seed": self._number}
        self._answered(self._http.post(f"/missions/{self._mission}/plans", json=wishes), 202)

    def _answered(self, answer, *expected):
        self.asked += 1
        if answer.status_code not in expected:
            self.faults.append(f"{answer.request.url}: {answer.status_code} {answer.text}")
        return answer.status_code != 409


class Watcher:
    """Keeps each entry of a run that its stream tells; after each kill it listens again behind what it has."""

    def __init__(self):
        self.seen = []
        self._thread = None

    def watch(self, server, run):
        """Listen, unless it does already."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._listen, args=(server.url.replace("http", "ws", 1), run))
            self._thread.start()

    def leave(self, last=None):
        """The stream ends with the run, or the server; with `last` wait until it has told that entry."""
        if self._thread is not None:
            self._thread.join(60.0)
            assert not self._thread.is_alive(), "its stream does not end"
            self._thread = None
        assert last is None or self.seen[-1]["seq"] == last

    def _listen(self, url, run):
        after = self.seen[-1]["seq"] if self.seen else 0
        try:
            with connect(f"{url}/api/v1/runs/{run}/stream?after={after}", max_size=2**24) as stream:
                for text in stream:
                    said = json.loads(text)
                    if said["type"] == "entry":
                        self.seen.append({key: said[key] for key in ("seq", "kind", "data")})
        except (WebSocketException, OSError):
            return
