"""Random missions with narrow places, by seed: doors, aisles, dead ends, corridors, and rooms with doors."""

from dataclasses import replace
from itertools import product
from random import Random

from muster import Mission, Robot, Rules, Task
from muster.generation import narrow
from muster.mission.model import Map, Zone

RADIUS_M = narrow.RADIUS_M
SKILL = "gripper"
MOST_TASKS = 3
"""Tasks for each robot, at most."""
WALL_M = 0.3


def mission_of(seed):
    """A mission of 4 to 12 robots, all holonomic or all differential drives."""
    random = Random(f"traffic {seed}")
    make = random.choice((*SCENES, rooms, rooms))
    kinematics, count = random.choice(narrow.KINEMATICS), random.randint(4, 12)
    if make in (narrow.two_way_door, narrow.corridor):
        count -= count % 2
    mission = make(kinematics, seed + 1, count)
    mission = replace(mission, tasks=mission.tasks[: MOST_TASKS * len(mission.robots)])
    if random.random() < 0.5:
        mission = replace(mission, tasks=tuple(replace(task, only_robots=None) for task in mission.tasks))
        mission = _with_skills(mission, random)
    return mission


def rooms(kinematics, seed, count):
    """Rooms of a size on a grid, with doors in the walls between them so that each can be reached from each."""
    random = Random(f"rooms {seed}")
    across, up, side = random.randint(2, 3), random.randint(2, 3), random.uniform(3.5, 5.0)
    boundary = ((0.0, 0.0), (across * side, 0.0), (across * side, up * side), (0.0, up * side))
    zones = tuple(zone for wall in _walls(across, up, random) for zone in _wall_with_door(*wall, side, random))
    places = [
        (side * x + side * (0.5 + dx), side * y + side * (0.5 + dy))
        for x, y in product(range(across), range(up))
        for dx, dy in product((-0.25, 0.25), repeat=2)
    ]
    random.shuffle(places)
    goals = random.choices(places, k=2 * count)
    robots = tuple(_robot(f"r_{k}", place, kinematics, random) for k, place in enumerate(places[:count]))
    tasks = tuple(
        Task(id=f"t_{k}", position=place, duration_s=random.choice((0.0, 2.0, 5.0))) for k, place in enumerate(goals)
    )
    rules = Rules(objective="makespan", usage="time", return_to_start=random.random() < 0.3)
    return Mission(name="rooms", robots=robots, tasks=tasks, map=Map(boundary=boundary, zones=zones), rules=rules)


SCENES = (narrow.one_way_door, narrow.two_way_door, narrow.aisles, narrow.dead_ends, narrow.corridor)


def newcomer(name, place, like):
    """A robot as those of the mission, elsewhere."""
    return replace(like, id=name, position=place, end_position=None)


def _with_skills(mission, random):
    """Half of the robots have a skill that a third of the tasks ask for."""
    robots = [replace(robot, skills=(SKILL,)) if k % 2 == 0 else robot for k, robot in enumerate(mission.robots)]
    tasks = [replace(task, requires=(SKILL,)) if random.random() < 1 / 3 else task for task in mission.tasks]
    return replace(mission, robots=tuple(robots), tasks=tuple(tasks))


def _walls(across, up, random):
    """Walls between rooms, each with its lower or left room and whether it has a door: a random tree, and some more."""
    pairs = [((x, y), (x + 1, y)) for x, y in product(range(across - 1), range(up))]
    pairs += [((x, y), (x, y + 1)) for x, y in product(range(across), range(up - 1))]
    random.shuffle(pairs)
    group = {room: room for room in product(range(across), range(up))}
    for one, other in pairs:
        joins = group[one] != group[other]
        old, new = group[other], group[one]
        group = {room: new if its == old else its for room, its in group.items()}
        yield one, one[0] != other[0], joins or random.random() < 0.3


def _wall_with_door(room, upright, has_door, side, random):
    """The boxes of the wall at the right (upright) or the upper side of a room, and of its door."""
    low, high, half = 0.0, side, WALL_M / 2
    spans = [(low - half, high + half)]
    if has_door:
        wide, at = random.uniform(0.75, 1.3), random.uniform(0.3, 0.7) * side
        spans = [(low - half, at - wide / 2), (at + wide / 2, high + half), (at - wide / 2, at + wide / 2)]
    x, y = room[0] * side, room[1] * side
    for k, (begin, end) in enumerate(spans):
        door = {"id": f"door_{room[0]}_{room[1]}_{upright:d}", "open": True} if k == 2 else {}
        if upright:
            yield _box(x + side - half, max(0.0, y + begin), x + side + half, y + end, **door)
        else:
            yield _box(max(0.0, x + begin), y + side - half, x + end, y + side + half, **door)


def _box(left, low, right, high, **door):
    return Zone(polygon=((left, low), (right, low), (right, high), (left, high)), **door)


def _robot(name, place, kinematics, random):
    drives = kinematics == narrow.DIFFERENTIAL
    return Robot(
        id=name,
        position=place,
        heading_deg=random.uniform(-180, 180) if drives else 0.0,
        radius_m=RADIUS_M,
        speed_mps=narrow.SPEED_MPS,
        kinematics=kinematics,
        acceleration_mps2=narrow.ACCELERATION_MPS2 if drives else None,
        yaw_rate_radps=narrow.YAW_RATE_RADPS if drives else None,
    )
