"""Random small missions on a line with goods, batteries and stations, and plans of them. All numbers are whole."""

from dataclasses import replace
from random import Random

from muster.mission.model import Battery, Mission, Robot, Rules, Station, Task
from muster.mission.plan import Plan, Route, RouteStop

SERVICES = (("charge",), ("swap",), ("unload",), ("charge", "unload"), ("swap", "unload"))


def random_mission(seed, *, tasks=5, robots=2, stations=2, **rules):
    """A mission in which loads, pairs, batteries and slots decide now and then."""
    random = Random(seed)
    named = random.random() < 0.3
    goods = ("sand", "water") if named else ("",)

    def amount(low, high):
        values = {name: random.randint(low, high) for name in goods}
        return values if named else values[""]

    made = [_task(random, k, amount) for k in range(tasks)]
    made = [_paired(random, made, k) for k in range(tasks)]
    battery = lambda: Battery(  # noqa: E731
        capacity=random.randint(12, 30), at_start=random.choice((1, 1, 0.5)), reserve=random.choice((0, 0, 0.25))
    )
    values = {
        "usage": random.choice(("distance", "time")),
        "objective": random.choice(("total", "max", "makespan", "average")),
    }
    return Mission(
        name=f"carry {seed}",
        rules=Rules(return_to_start=random.random() < 0.3, **(values | rules)),
        robots=tuple(
            Robot(
                id=f"r_{k}",
                position=(random.randint(-6, 6), 0),
                load_capacity=amount(2, 5) if random.random() < 0.8 else None,
                load_at_start=amount(0, 2) if random.random() < 0.3 else None,
                battery=battery() if random.random() < 0.8 else None,
                available_from_s=random.choice((0, 0, 3)),
            )
            for k in range(robots)
        ),
        tasks=tuple(made),
        stations=tuple(
            Station(
                id=f"s_{k}",
                position=(random.randint(-6, 6), 0),
                services=(services := random.choice(SERVICES)),
                slots=random.choice((1, 1, 2)),
                charge_per_s=random.choice((0.5, 1)) if "charge" in services else None,
                swap_s=random.choice((0, 4)),
                partial=random.random() < 0.7,
            )
            for k in range(stations)
        ),
    )


def _task(random, k, amount):
    return Task(
        id=f"t_{k}",
        position=(random.randint(-6, 6), 0),
        actuation_cost=random.choice((0, 0, 2)),
        duration_s=random.choice((None, 0, 3)),
        load=amount(-2, 3) if random.random() < 0.4 else None,
        prerequisites=(f"t_{random.randrange(k)}",) if k and random.random() < 0.2 else (),
    )


def _paired(random, tasks, k):
    """The task, which now and then delivers what the one before takes on board."""
    if k % 2 == 0 or random.random() < 0.5:
        return tasks[k]
    pickup = tasks[k - 1]
    if not isinstance(pickup.load, int | float) or pickup.load <= 0:
        return tasks[k]
    return replace(tasks[k], delivers=pickup.id)


def random_plan(mission, seed, *, stated=False):
    """Routes with stations here and there; with `stated` the plan says who is served when, and how much is charged."""
    random = Random(seed)
    routes = {robot.id: [] for robot in mission.robots}
    robot_of = {}
    for task in mission.tasks if random.random() < 0.8 else random.sample(mission.tasks, len(mission.tasks)):
        robot = random.choice([*routes, *routes, None])
        robot = robot_of.get(task.delivers, robot) if random.random() < 0.9 else robot
        robot_of[task.id] = robot
        if robot is not None:
            routes[robot].append(task.id)
    for route in routes.values():
        for station in mission.stations:
            for _ in range(random.choice((0, 1, 1, 2))):
                route.insert(random.randint(0, len(route)), station.id)
    made = tuple(Route(name, tuple(route)) for name, route in routes.items())
    return Plan(routes=tuple(_stated(mission, route, random) for route in made) if stated else made)


def _stated(mission, route, random):
    """The route with stops that say, of stations, in which order these serve; other times say nothing."""
    stations = {station.id: station for station in mission.stations}
    begin = 0
    stops = []
    for name in route.tasks:
        begin += random.randint(1, 9)
        amount = random.choice((None, random.randint(0, 12))) if _charges(stations.get(name)) else None
        stops.append(RouteStop(name, 0, begin, 0, name in stations, amount))
    return replace(route, stops=tuple(stops))


def _charges(station):
    return station is not None and station.charges and station.partial
