"""Random missions with transports, collections, batteries and stations, and what happens in them, by seed."""

from dataclasses import replace
from random import Random

from muster.mission.model import Battery, Event, Mission, Robot, Rules, Station, Task

FIELD_M = 20.0
SERVICES = (("charge",), ("charge",), ("swap",), ("charge", "unload"), ("swap", "unload"))


def mission_of(seed):
    """A mission of 1 to 3 robots, 1 or 2 stations, 2 to 4 transports, some collections, and up to five events."""
    random = Random(f"goods {seed}")
    stations = tuple(_station(k, random) for k in range(random.randint(1, 2)))
    robots = tuple(_robot(k, random) for k in range(random.randint(1, 3)))
    tasks = [task for k in range(random.randint(2, 4)) for task in transport(str(k), random)]
    tasks += [_collection(k, random) for k in range(random.randint(0, 3))]
    tasks += [_work(k, random) for k in range(random.randint(0, 2))]
    events = sorted(_events(robots, stations, tasks, random), key=lambda event: event.at_s)
    rules = Rules(
        objective=random.choice(("total", "total+max", "makespan")),
        usage=random.choice(("distance", "distance", "time")),
        return_to_start=random.random() < 0.3,
        stability=random.choice((None, None, 1)),
    )
    return Mission(
        name=f"goods {seed}",
        rules=rules,
        stations=stations,
        robots=robots,
        tasks=tuple(tasks),
        events=tuple(events),
    )


def drain_of(mission, seed):
    """How much faster than by usage the battery of each robot drains."""
    random = Random(f"drain {seed}")
    most = random.choice((1.0, 1.2, 1.5))
    return {robot.id: random.uniform(1.0, most) for robot in mission.robots}


def transport(name, random):
    """What one task takes on board, and another delivers."""
    amount = random.choice((1.0, 1.0, 2.0))
    takes = Task(id=f"take {name}", position=_place(random), load=amount, duration_s=random.choice((0.0, 2.0)))
    brings = Task(
        id=f"bring {name}",
        position=_place(random),
        delivers=takes.id,
        duration_s=random.choice((None, 2.0)),
        actuation_cost=random.choice((0.0, 0.0, 1.5)),
    )
    return takes, brings


def _collection(k, random):
    return Task(id=f"collect {k}", position=_place(random), load=random.choice((0.5, 1.0)), duration_s=1.0)


def _work(k, random):
    return Task(id=f"work {k}", position=_place(random), actuation_cost=random.choice((0.0, 3.0)))


def _place(random):
    return round(random.uniform(0, FIELD_M), 2), round(random.uniform(0, FIELD_M), 2)


def _station(k, random):
    services = random.choice(SERVICES)
    return Station(
        id=f"station {k}",
        position=_place(random),
        services=services,
        slots=random.choice((1, 1, 2)),
        charge_per_s=random.choice((0.5, 2.0)) if "charge" in services else None,
        swap_s=random.choice((0.0, 8.0)),
        partial=random.random() < 0.7,
    )


def _robot(k, random):
    battery = Battery(
        capacity=random.choice((45.0, 60.0, 80.0)),
        at_start=random.choice((1.0, 1.0, 0.7)),
        reserve=random.choice((0.1, 0.2)),
    )
    return Robot(
        id=f"r_{k}",
        position=_place(random),
        speed_mps=random.choice((1.0, 1.0, 2.0)),
        load_capacity=random.choice((2.0, 3.0)),
        load_at_start=random.choice((None, None, None, 0.5)),
        battery=battery if random.random() < 0.9 else None,
    )


def _events(robots, stations, tasks, random):
    for k in range(random.randint(0, 5)):
        at_s = round(random.uniform(1, 120), 1)
        kind = random.choice(("station", "station", "robot", "robot", "new", "cancel", "silent"))
        if kind == "station":
            station = random.choice(stations).id
            yield Event(at_s=at_s, station_fails=station)
            if random.random() < 0.8:
                yield Event(at_s=at_s + random.uniform(1, 60), station_returns=station)
        elif kind == "robot":
            robot = random.choice(robots).id
            yield Event(at_s=at_s, robot_fails=robot)
            if random.random() < 0.3:
                yield Event(at_s=at_s + random.uniform(5, 60), robot_returns=robot)
        elif kind == "silent" and random.random() < 0.4:
            robot = random.choice(robots).id
            yield Event(at_s=at_s, robot_silent=robot)
            yield Event(at_s=at_s + random.uniform(6, 30), robot_returns=robot)
        elif kind == "new":
            takes, brings = transport(f"new {k}", random)
            yield Event(at_s=at_s, new_task=takes)
            yield Event(at_s=at_s + random.choice((0.0, 0.0, 15.0)), new_task=brings)
        elif kind == "cancel" and random.random() < 0.4:
            yield Event(at_s=at_s, cancel_task=random.choice(tasks).id)


def without_events(mission):
    return replace(mission, events=())
