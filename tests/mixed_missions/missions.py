"""Random tiny missions in which rules of every kind meet, by seed."""

import json
from random import Random

from muster import MissionError
from muster.mission.reading.yaml_reader import parse_yaml

OBJECTIVES = ("total", "max", "total+max", "average", "makespan", "lateness")
RULES = (
    "window",
    "deadline",
    "due",
    "shift",
    "prerequisite",
    "lag",
    "team",
    "needs",
    "together",
    "relation",
    "goods",
    "battery",
    "station",
    "capacity",
    "skill",
    "efficiency",
    "priority",
    "least",
    "ends",
)
"""Kinds of rules and keys, of which each mission has some."""
SERVICES = (("charge",), ("charge",), ("swap",), ("charge", "unload"), ("swap", "unload"), ("unload",))
_SIDE = 20


def mixed_mission(seed):
    """Return the mission of a seed, which is read as a file would be, and its text.

    What rules forbid in a file, such as a task that waits for itself, is drawn anew.
    """
    for attempt in range(1000):
        maker = _Maker(Random(f"mixed {seed} {attempt}"))
        text = json.dumps(maker.mission(f"mixed-{seed}"), indent=1)
        try:
            return parse_yaml(text, f"mixed-{seed}.yaml"), text
        except MissionError:
            continue
    raise AssertionError(f"no mission of seed {seed} is one")


class _Maker:
    def __init__(self, random):
        self.random = random
        share = random.choice((0.25, 0.4, 0.6))
        self.has = {rule for rule in RULES if random.random() < share}
        self.robots = random.choice((1, 2, 2, 2, 2, 3))
        self.stations = random.choice((1, 1, 1, 2)) if self.has & {"battery", "station"} else 0
        most = 3 if self.robots == 3 or self.stations == 2 or (self.stations and self.robots == 2) else 4
        self.tasks = random.randint(1 if random.random() < 0.05 else 2, most)

    def mission(self, name):
        random = self.random
        objective = random.choice(OBJECTIVES)
        rules = {
            "objective": objective,
            "usage": random.choice(("distance", "time")),
            "return_to_start": random.random() < 0.5,
            "timing": "constant",
        }
        if objective == "makespan" and random.random() < 0.3:
            rules["makespan_includes_return"] = True
        if "capacity" in self.has and random.random() < 0.3:
            rules["capacity_reserve"] = 0.1
        made = {"schema": "muster/1", "name": name, "rules": rules}
        made["robots"] = [self._robot(k) for k in range(self.robots)]
        made["tasks"] = [self._task(k) for k in range(self.tasks)]
        self._tie(made["tasks"])
        if self.stations:
            made["stations"] = [self._station(k) for k in range(self.stations)]
        return made

    def _in(self, rule, share):
        return rule in self.has and self.random.random() < share

    def _place(self):
        return [self.random.randint(0, _SIDE), self.random.randint(0, _SIDE)]

    def _robot(self, k):
        random = self.random
        robot = {"id": f"r{k}", "position": self._place(), "speed_mps": random.choice((1, 1, 2))}
        robot["skills"] = [skill for skill in ("a", "b") if random.random() < 0.75]
        if self._in("efficiency", 0.5):
            robot["efficiency"] = 0.5
        if "needs" in self.has:
            robot["abilities"] = {"lift": random.randint(1, 4)}
        if self._in("capacity", 0.6):
            robot["work_capacity"] = random.randint(20, 70)
        if self._in("shift", 0.4):
            robot["available_from_s"] = random.choice((3, 7))
        if self._in("shift", 0.5):
            robot["available_until_s"] = random.randint(25, 80)
        if self._in("goods", 0.8):
            robot["load_capacity"] = random.randint(2, 5)
            if random.random() < 0.15:
                robot["load_at_start"] = random.randint(1, 2)
        if self._in("battery", 0.8):
            robot["battery"] = {
                "capacity": random.randint(20, 50),
                "reserve": random.choice((0, 0.1)),
                "at_start": random.choice((1, 0.6)),
            }
        if self._in("least", 0.4):
            robot["min_tasks"] = random.choice((1, 2))
        if self._in("ends", 0.3):
            robot["end_position"] = self._place()
        elif self._in("ends", 0.3):
            robot["return_to_start"] = random.random() < 0.5
        return robot

    def _task(self, k):
        random = self.random
        task = {"id": f"t{k}", "position": self._place(), "actuation_cost": random.choice((0, 0, 3))}
        if random.random() < 0.8:
            task["duration_s"] = random.randint(0, 6)
        if self._in("window", 0.6):
            task["window_s"] = self._windows()
        if self._in("deadline", 0.4):
            task["deadline_s"] = random.randint(12, 60)
        if "due" in self.has or random.random() < 0.3:
            task["due_s"] = random.randint(0, 40)
        if self._in("priority", 0.5):
            task["priority"] = random.choice((0.5, 3))
        if self._in("ends", 0.15):
            task["exit"] = self._place()
        before = [f"t{j}" for j in range(k) if self._in("prerequisite", 0.45)]
        if before:
            task["prerequisites"] = [self._lag(name) for name in before]
        if self._in("goods", 0.5):
            task["load"] = random.choice((-2, 1, 2, 3))
        return {**task, **self._members()}

    def _members(self):
        """Who may do a task, and how many together."""
        random, keys = self.random, {}
        if self._in("skill", 0.4):
            keys["requires"] = [random.choice(("a", "b"))]
        if self._in("skill", 0.1):
            keys["only_robots"] = [f"r{random.randrange(self.robots)}"]
        if self._in("needs", 0.5):
            return {**keys, "needs": {"lift": random.randint(1, 6)}}
        return {**keys, **self._team()} if self._in("team", 0.5) else keys

    def _windows(self):
        random = self.random
        begin = random.randint(0, 30)
        windows = [[begin, begin + random.randint(3, 30)]]
        if random.random() < 0.25:
            begin = windows[0][1] + random.randint(2, 10)
            windows.append([begin, random.choice((None, begin + random.randint(2, 15)))])
        return windows

    def _lag(self, name):
        random = self.random
        if not self._in("lag", 0.7):
            return name
        lag = {"task": name}
        if random.random() < 0.5:
            lag["after_s"] = random.choice((0, 2, 5))
        if random.random() < 0.6:
            lag["within_s"] = lag.get("after_s", 0) + random.randint(1, 15)
        return lag

    def _team(self):
        random = self.random
        if random.random() < 0.6:
            return {"robots_needed": random.choice((2, 2, 1))}
        return {"team": [{"count": 1, "requires": [random.choice(("a", "b"))]}, {"count": 1}]}

    def _tie(self, tasks):
        """Tie tasks to each other: by goods, begins and robots."""
        random = self.random
        for k in range(1, len(tasks)):
            other = tasks[random.randrange(k)]
            if self._in("goods", 0.5):
                other["load"] = random.randint(1, 3)
                tasks[k].pop("load", None)
                tasks[k]["delivers"] = other["id"]
            other = tasks[random.randrange(k)]
            if self._in("together", 0.4):
                tasks[k]["starts_with"] = other["id"]
            if self._in("relation", 0.4):
                tasks[k][random.choice(("same_robot_as", "other_robot_than"))] = other["id"]

    def _station(self, k):
        random = self.random
        services = random.choice(SERVICES)
        station = {"id": f"s{k}", "position": self._place(), "services": list(services), "slots": random.choice((1, 9))}
        if "charge" in services:
            station["charge_per_s"] = random.choice((1, 4))
            station["partial"] = random.random() < 0.7
        if "swap" in services:
            station["swap_s"] = random.choice((0, 4))
        return station
