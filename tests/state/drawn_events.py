"""Random events of all kinds, in any order, for tests of what reads events: pages, words, the fold in JavaScript."""

import random
from dataclasses import fields, replace

from tests.state.played import NEWCOMER, SAMPLES, site
from tests.state.test_events import DATA

from muster.mission.model import Station, Task
from muster.mission.yaml_writer import plain
from muster.state import MissionState, event_of
from muster.state.event import KINDS

NEW = (*SAMPLES["new_task"], Task(id="late", position=(3.0, 1.0), starts_with=("trio",)))


def tied_site():
    """The site of `played`, with tasks that begin together, and a station that stands alone."""
    tied = (
        Task(id="duo", position=(1.0, 1.0), starts_with=("t_5",)),
        Task(id="trio", position=(2.0, 1.0), starts_with=("duo",)),
    )
    rack = Station(id="rack", position=(70.0, 0.0), services=("unload",))
    return replace(site(), tasks=(*site().tasks, *tied), stations=(*site().stations, rack))


class Drawn:
    """Draws events of all kinds, which fit what is known when they happen, and little else."""

    def __init__(self, seed, plan):
        self.draw = random.Random(seed)
        self.state, self.plan, self.now = MissionState(tied_site()), plan, 0.0

    def entries(self, count):
        for _ in range(count):
            self.now += self.draw.choice([0.0, 1.0])
            for kind, data in self.happens(self.draw.choice(sorted(KINDS))):
                yield self.applied(kind, data)

    def applied(self, kind, data):
        self.state.apply(event_of(self.now, kind, data))
        return {"time_s": self.now, "kind": kind, "data": plain(data)}

    def happens(self, kind):
        data = {one.name: self.value(kind, one.name) for one in fields(KINDS[kind])[1:]}
        data = {name: value for name, value in data.items() if value is not None or name == "next_s"}
        ledger = self.state.ledger
        told = ledger.cancelled.keys() | ledger.told_lost.keys()
        known = {name for name in self.state.tasks if name in (ledger.arrival_usage if name in ledger.ends_s else told)}
        settled = ledger.settled(self.now) & known
        if kind == "forgets":
            data["tasks"] = self.draw.sample(sorted(settled), min(1, len(settled)))
        items = self.state.goods.on_board[data["robot"]] if kind == "robot_fails" else ()
        aboard = {item.task for item in items if item.task is not None}
        if kind == "load_lies" or not aboard <= ledger.ends_s.keys():
            return
        yield kind, data
        for task in sorted(aboard):
            yield "load_lies", {"task": task, "robot": data["robot"], "position": [1.0, 2.0], "load": {"kg": 1.0}}

    def value(self, kind, name):
        draw, state = self.draw, self.state
        robots = draw.sample(sorted(state.robots), draw.choice([1, 2]))
        tasks = sorted(state.tasks)
        made = {
            "robot": lambda: plain(NEWCOMER) if kind == "robot_joins" else robots[0],
            "robots": lambda: [{"words": "stands"}] if kind == "final_states" else robots,
            "team": lambda: draw.choice([[], robots]),
            "task": lambda: plain(draw.choice(NEW)) if kind == "new_task" else draw.choice(tasks),
            "tasks": list,
            "station": lambda: "dock",
            "door": lambda: draw.choice("ab"),
            "position": lambda: [draw.uniform(0, 9), 1.0],
            "reason": lambda: draw.choice(["unreachable: no way", "skill: lift", ""]),
            "others": lambda: draw.choice([{}, {draw.choice(tasks): robots}]),
            "for_now": lambda: draw.random() < 0.2,
            "goes_on": lambda: draw.random() < 0.3,
            "next_s": lambda: draw.choice([None, 50.0]),
            "ended_s": lambda: draw.choice([None, 1.0]),
            "routes": lambda: {robots[0]: draw.sample(tasks, 2)},
            "left_out": lambda: self.left_out(kind, tasks),
            "plan": lambda: draw.choice([None, self.plan.as_dict()]),
            "places": lambda: {robots[0]: [1.0, draw.uniform(0, 9), 90.0]},
            "causes": lambda: [{"kind": "robot_fails", "robot": robots[0]}],
            "event": lambda: {"cancel_task": "no such"},
            "load": lambda: {"kg": 1.0},
            "again": list,
            "used": lambda: {robots[0]: 1.0} if kind == "resumed" else 1.0,
            "usage": lambda: [1.0, 1.0],
            "waited_s": lambda: {robots[0]: 1.0},
            "services": lambda: ["unload"],
            "cell_m": lambda: 0.5,
            "origin": lambda: [0.0, 0.0, 0.0],
            "size": lambda: [2, 3],
            "runs": lambda: [[draw.choice([0, 1]), draw.choice([0, 1]), draw.choice([1, 2]), draw.choice([0, 1, 2])]],
            "explored_m2": lambda: draw.uniform(0, 9),
            "longer_m": lambda: draw.choice([None, 3.5]),
        }
        if name in made:
            return made[name]()
        kind_of = {"words": "waits", "cause": "team", "what": "elsewhere", "how": "", "waits_for": robots[0]}
        numbers = ("by_s", "since_s", "until_s", "takes_s", "zero_s", "capacity", "charge", "missing", "drain")
        if name in ("waits_for",) and kind == "standstill":
            return robots
        return 1.0 if name in numbers else kind_of.get(name, robots[0] if name in ("round", "makes_room_for") else None)

    def left_out(self, kind, tasks):
        if kind == "robots_free":
            return tasks[:1]
        return {self.draw.choice(tasks): self.draw.choice([None, "skill: lift (r_0)"] if kind == "plan" else ["skill"])}


def one_of_each():
    """An entry of each kind, as a log has it."""
    return [{"time_s": float(k), "kind": kind, "data": data} for k, (kind, data) in enumerate(plain(DATA).items())]
