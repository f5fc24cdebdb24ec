"""Further rules in disturbed missions: alternatives, times on board, stations for certain robots, breaks and duties.

What must hold is read from events alone.
"""

from dataclasses import replace
from random import Random

from muster.mission.task_relations import alternatives_of

ROUNDING_S = 1e-6


def with_further_rules(mission, seed):
    """The mission with more rules, half of the time; its draws are as without."""
    random = Random(f"further {seed}")
    if random.random() < 0.5:
        return mission
    tied = _tied(mission.tasks, random)
    tasks = tuple(_further(task, tied, random) for task in mission.tasks)
    ids = [robot.id for robot in mission.robots]
    stations = tuple(
        replace(one, only_robots=tuple(random.sample(ids, random.randint(1, len(ids)))))
        if random.random() < 0.5
        else one
        for one in mission.stations
    )
    robots = tuple(_resting(robot, random) for robot in mission.robots)
    events = tuple(_with_alternative(event, mission.tasks, random) for event in mission.events)
    return replace(mission, tasks=tasks, stations=stations, robots=robots, events=events)


def _tied(tasks, random):
    """Pairs of alternatives that no task needs both of."""
    needed = {name for t in tasks for name in (*t.prerequisites, *t.starts_with, *t.same_robot_as)}
    free = [t for t in tasks if not (t.prerequisites or t.starts_with or t.same_robot_as or t.id in needed)]
    free = [t.id for t in free if t.delivers is None]
    random.shuffle(free)
    return dict(zip(free[0:4:2], free[1:4:2], strict=False))


def _further(task, tied, random):
    most_s = random.uniform(15, 60)
    keys = {"longest_aboard_s": most_s} if task.delivers is not None and random.random() < 0.6 else {}
    return replace(task, **keys, **({"either_or": (tied[task.id],)} if task.id in tied else {}))


def _resting(robot, random):
    if robot.available_until_s is not None or random.random() < 0.6:
        return robot
    first = random.uniform(20, 60)
    shifts = ((0.0, first), (first + random.uniform(5, 40), random.choice((None, 400.0))))
    return replace(robot, **random.choice(({"longest_duty_s": random.uniform(40, 200)}, {"shifts_s": shifts})))


def _with_alternative(event, tasks, random):
    """A new task may stand for one that there is, unless something else is said of the two together."""
    new = event.new_task
    if new is None or new.delivers is not None or random.random() < 0.6:
        return event
    return replace(event, new_task=replace(new, either_or=(random.choice(tasks).id,)))


def check_further_rules(report, executor):
    """What was done keeps the rules, and what was not is said to be so for a reason."""
    ledger, lost = executor.ledger, executor.lost()
    begins, ends = {}, {}
    for event in executor.events:
        if event.kind == "starts":
            begins[event.data["task"]] = event.time_s
            _look_aboard(report, ledger.tasks[event.data["task"]], event.time_s, ends)
        elif event.kind == "ends":
            ends[event.data["task"]] = event.time_s
        elif event.kind == "service_begins":
            only = _only(executor, event.data["station"])
            report.check(only is None or event.data["robot"] in only, f"{event.data['robot']} calls at {event.data}")
            report.counts["calls at stations for some"] += only is not None
    for names in alternatives_of(ledger.tasks.values()):
        done = [name for name in names if name in ledger.ends_s]
        report.check(len(done) <= 1, f"{done} are done, of {names}")
        report.counts["alternatives done"] += len(names) > 1 and len(done)
        for name in names:
            if "in its place" in lost.get(name, ""):
                report.check(bool(done), f"{name} is lost for others that are not done: {lost[name]}")


def _only(executor, station):
    return next(one.only_robots for one in executor.mission.stations if one.id == station)


def _look_aboard(report, task, begin_s, ends):
    if task.longest_aboard_s is not None and task.delivers in ends:
        aboard_s = begin_s - ends[task.delivers]
        report.counts["times on board limited"] += 1
        report.check(aboard_s <= task.longest_aboard_s + ROUNDING_S, f"{task.id}: on board for {aboard_s}")
