"""Random tiny missions in which robots have hardly enough time for their tasks, by seed."""

import json
from random import Random

from muster import MissionError
from muster.mission.reading.yaml_reader import parse_yaml

KINDS = ("window", "deadline", "shift", "skill", "team", "either", "lag", "duty")
_SIDE = 12


def tight_mission(seed, most=4):
    """Return the mission of a seed, of two tasks or more."""
    for attempt in range(1000):
        random = Random(f"tight {seed} {attempt}")
        try:
            return parse_yaml(json.dumps(_mission(random, seed, most)), f"tight-{seed}.yaml")
        except MissionError:
            continue
    raise AssertionError(f"no mission of seed {seed} is one")


def _mission(random, seed, most):
    robots, tasks = random.choice((1, 2, 2, 2, 3)), random.randint(2, most)
    has = {key: random.random() < 0.4 for key in KINDS}
    has["shift"] |= not (has["window"] or has["deadline"])
    rules = {"return_to_start": random.random() < 0.4, "timing": "constant"}
    made = {"schema": "muster/1", "name": f"tight-{seed}", "rules": rules}
    made["robots"] = [_robot(random, k, has) for k in range(robots)]
    made["tasks"] = [_task(random, k, has, robots) for k in range(tasks)]
    return made


def _place(random):
    return [random.randint(0, _SIDE), random.randint(0, _SIDE) if random.random() < 0.5 else 0]


def _robot(random, k, has):
    robot = {"id": f"r{k}", "position": _place(random), "speed_mps": random.choice((1, 2, 4))}
    robot["skills"] = [skill for skill in ("a", "b") if random.random() < 0.6]
    if random.random() < 0.2:
        robot["efficiency"] = 0.5
    if has["shift"]:
        begins = random.choice((0, 0, 5))
        ends = begins + random.randint(12, 35)
        robot |= {"available_from_s": begins, "available_until_s": ends}
        if random.random() < 0.2:
            robot = {key: value for key, value in robot.items() if not key.startswith("available")}
            first, last = random.randint(6, 15), random.randint(25, 40)
            robot["shifts_s"] = [[begins, begins + first], [begins + 20, begins + last]]
    if has["duty"] and random.random() < 0.5:
        robot["longest_duty_s"] = random.randint(12, 40)
    return robot


def _task(random, k, has, robots):
    task = {"id": f"t{k}", "position": _place(random), "duration_s": random.randint(3, 14)}
    if random.random() < 0.1:
        task["exit"] = _place(random)
    if has["window"] and random.random() < 0.6:
        begin = random.randint(0, 20)
        task["window_s"] = [[begin, begin + random.randint(2, 15)]]
        if random.random() < 0.3:
            begin = task["window_s"][0][1] + random.randint(2, 10)
            task["window_s"].append([begin, begin + random.randint(2, 10)])
    if has["deadline"] and random.random() < 0.6:
        task["deadline_s"] = random.randint(15, 45)
    if has["skill"] and random.random() < 0.5:
        task["requires"] = [random.choice(("a", "b"))]
    if has["team"] and random.random() < 0.5:
        task |= random.choice(({"robots_needed": 2}, {"team": [{"count": 1, "requires": ["a"]}, {"count": 1}]}))
    if has["either"] and k and random.random() < 0.4:
        task["either_or"] = f"t{random.randrange(k)}"
    if k and random.random() < 0.3:
        lag = {"task": f"t{random.randrange(k)}"}
        if has["lag"]:
            lag |= random.choice(({"after_s": 4}, {"within_s": 6}, {"after_s": 2, "within_s": 9}))
        task["prerequisites"] = [lag]
    return task
