"""Random missions with every action, by seed: in the plane or in space, over a map or without one."""

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


def random_mission(seed, *, tasks=9, robots=4, spatial=None, over_map=False, **rules):
    """Rovers and drones, some with cameras of two makes; over a map two walls stand in the way of some actions."""
    random = Random(seed)
    spatial = random.random() < 0.4 if spatial is None else spatial

    def place():
        while True:
            point = (random.uniform(12, 48), random.uniform(12, 48), *([random.uniform(0, 4)] if spatial else []))
            if not over_map or not near_a_wall(point):
                return point

    cameras = [Camera(fov_deg=60, tilt_deg=45, mount=(0.2, 0.1, -0.1)), Camera(fov_deg=40, tilt_deg=90), None]
    actions = [
        lambda: None,
        lambda: Action(name="go-to-goal"),
        lambda: Action(name="sensor-activation", duration_s=random.uniform(0, 5)),
        lambda: Action(name="stationary-observation", width_m=random.uniform(1, 4), heading_deg=random.uniform(0, 360)),
        lambda: Action(
            name="raster-search",
            side_m=random.uniform(1, 8),
            height_m=random.uniform(1, 5),
            spacing_m=random.uniform(0.5, 3),
        ),
        lambda: Action(name="ground-patrol", side_m=random.uniform(1, 8)),
        lambda: Action(name="delivery", pickup=place()),
    ]

    def task(k):
        action = actions[k % len(actions)]()
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
                camera=random.choice(cameras) if k else cameras[seed % 2],
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
