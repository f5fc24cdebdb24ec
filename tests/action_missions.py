"""Random missions with every action, by seed: in the plane or in space, over a map or without one."""

from dataclasses import replace
from random import Random

from muster import Mission, Robot, Rules, Task
from muster.mission.model import Action, Camera, Map, Zone

WALLS = ((20.0, 10.0, 22.0, 40.0), (35.0, 25.0, 37.0, 55.0))
"""West, south, east, north."""


def box(west, south, east, north):
    return ((west, south), (east, south), (east, north), (west, north))


def near_a_wall(point):
    return any(
        west - 1 < point[0] < east + 1 and south - 1 < point[1] < north + 1 for west, south, east, north in WALLS
    )


ARENA = Map(boundary=box(0, 0, 60, 60), zones=tuple(Zone(polygon=box(*wall)) for wall in WALLS))


CAMERAS = (Camera(fov_deg=60, tilt_deg=45, mount=(0.2, 0.1, -0.1)), Camera(fov_deg=40, tilt_deg=90), None)
ACTIONS = (
    "go-to-goal", "sensor-activation", "stationary-observation", "raster-search", "ground-patrol", "delivery"
)  # fmt: skip


def random_action(name, random, place):
    """An action of a name; `place` makes pickups."""

    def size(least, most):
        return round(random.uniform(least, most), 2)

    keys = {
        "sensor-activation": lambda: {"duration_s": size(0, 5)},
        "stationary-observation": lambda: {"width_m": size(1, 4), "heading_deg": size(0, 360)},
        "raster-search": lambda: {"side_m": size(1, 8), "height_m": size(1, 5), "spacing_m": size(0.5, 3)},
        "ground-patrol": lambda: {"side_m": size(1, 8)},
        "delivery": lambda: {"pickup": place()},
    }
    return Action(name=name, **keys.get(name, dict)())


def acting(task, random, place):
    """The task, with an action in two of three."""
    if random.random() < 1 / 3:
        return task
    action = random_action(random.choice(ACTIONS), random, place)
    task = replace(task, duration_s=None) if action.duration_s is not None else task
    return replace(task, action=action, actuation_cost=0 if action.has_geometry else task.actuation_cost)


def able(robot, random):
    """The robot as a rover or a drone, perhaps with a camera."""
    return replace(robot, kind=random.choice(("ground", "air")), camera=random.choice(CAMERAS))


def walled(mission, random):
    """A mission of places within 10 m of the origin over a map of two walls. Robots start and end where they can."""
    heights = {"floor_m": 0, "ceiling_m": random.choice((None, 5))} if mission.dimensions == 3 else {}
    walls = ((-4, -12, -3, 3), (3, -3, 4, 12))
    zones = [
        Zone(polygon=box(*wall), forbidden_to=random.choice((("ground", "air"), ("ground",))), **heights)
        for wall in walls
    ]

    def clear(point):
        return point and (
            point[0] + 3 if any(west - 1 < point[0] < east + 1 for west, _, east, _ in walls) else point[0],
            *point[1:],
        )

    robots = tuple(
        replace(
            robot,
            position=clear(robot.position),
            end_position=clear(robot.end_position),
            radius_m=random.choice((0, 0.3)),
        )
        for robot in mission.robots
    )
    rules = replace(mission.rules, travel=random.choice((None, None, None, "euclidean")))
    return replace(mission, map=Map(boundary=box(-20, -20, 20, 20), zones=tuple(zones)), robots=robots, rules=rules)


def random_mission(seed, *, tasks=9, robots=4, spatial=None, over_map=False, **rules):
    """Rovers and drones, some with cameras of two makes; over a map two walls stand in the way of some actions."""
    random = Random(seed)
    spatial = random.random() < 0.4 if spatial is None else spatial

    def place():
        while True:
            point = (random.uniform(12, 48), random.uniform(12, 48), *([random.uniform(0, 4)] if spatial else []))
            if not over_map or not near_a_wall(point):
                return point

    kinds = [None, *ACTIONS]

    def task(k):
        kind = kinds[k % len(kinds)]
        action = kind and random_action(kind, random, place)
        typed = action is None or not action.has_geometry
        return Task(
            id=str(k),
            position=place(),
            action=action,
            actuation_cost=random.choice((0, 3)) if typed else 0,
            duration_s=2.5 if k % 5 == 3 and (action is None or action.duration_s is None) else None,
            entry=place() if random.random() < 0.15 else None,
            exit=place() if random.random() < 0.15 else None,
            prerequisites=(str(k - 1),) if k and random.random() < 0.15 else (),
        )

    values = {
        "objective": random.choice(("total", "max", "total+max", "average", "makespan")),
        "usage": random.choice(("distance", "time")),
        "return_to_start": random.random() < 0.3,
    }
    return Mission(
        name=f"actions-{seed}",
        rules=Rules(**(values | rules)),
        robots=tuple(
            Robot(
                id=f"r_{k}",
                position=place(),
                kind="air" if k % 2 else "ground",
                camera=random.choice(CAMERAS) if k else CAMERAS[seed % 2],
                speed_mps=random.choice((0.5, 1, 2)),
                efficiency=random.choice((0.8, 1)),
                radius_m=random.choice((0, 0.3)) if over_map else 0,
                work_capacity=random.choice((None, 150)),
            )
            for k in range(robots)
        ),
        tasks=tuple(task(k) for k in range(tasks)),
        map=ARENA if over_map else None,
    )
