"""Travel over maps: what plans are made of is what the judge finds, for every body and every leg."""

import math
import pickle
from dataclasses import replace
from random import Random

import numpy as np
import pytest
import shapely
from tests.verification.brute_paths import star

import muster
from muster import Mission, Robot, Rules, Task
from muster.allocation.bounds.feasibility import impossible
from muster.mission.errors import MissionError, NotSupportedError
from muster.mission.model import Map, Zone
from muster.model.problem import Problem
from muster.motion.map_world import World
from muster.verification.travel import Travel, place_at_end, place_of_start, place_of_task


def box(west, south, width, height, **more):
    corners = ((west, south), (west + width, south), (west + width, south + height), (west, south + height))
    return Zone(polygon=corners, **more)


def random_mission(seed, *, tasks=8, spatial=False):
    """Rovers and drones of several radii among boxes; places are where all of them can stand."""
    random = Random(seed)
    zones = tuple(
        box(
            *(5 + 9 * random.random() + 10 * k for k in cell),
            random.uniform(1, 6),
            random.uniform(1, 6),
            ceiling_m=random.uniform(2, 8) if spatial else None,
            forbidden_to=random.choice((("ground",), ("air",), ("ground", "air"))),
        )
        for cell in [(i, j) for i in range(3) for j in range(3)]
    )

    def near(point, zone):
        (west, south), (east, north) = zone.polygon[0], zone.polygon[2]
        return west - 0.7 < point[0] < east + 0.7 and south - 0.7 < point[1] < north + 0.7

    def point():
        while True:
            found = (random.uniform(1, 39), random.uniform(1, 39), *([random.uniform(0, 9)] if spatial else []))
            if not any(near(found, zone) for zone in zones):
                return found

    robots = tuple(
        Robot(
            id=f"r_{k}",
            position=point(),
            radius_m=random.choice((0.0, 0.2, 0.6)),
            kind=random.choice(("ground", "air")),
            end_position=point() if k == 1 else None,
        )
        for k in range(4)
    )
    work = tuple(
        Task(id=str(k), position=point(), entry=point() if k == 2 else None, exit=point() if k in (2, 3) else None)
        for k in range(tasks)
    )
    arena = Map(boundary=((0, 0), (40, 0), (40, 40), (0, 40)), zones=zones)
    return Mission(
        name="boxes", robots=robots, tasks=work, map=arena, rules=Rules(return_to_start=random.random() < 0.5)
    )


def assert_as_judged(mission, rel):
    """Every leg of every robot; returns the problem, which takes long to compile in space."""
    problem, travel = Problem.compile(mission), Travel(mission)
    n = len(problem.tasks)
    for i, robot in enumerate(problem.robots):
        places = [(j, place_of_task(task)) for j, task in enumerate(problem.tasks)]
        start, end = (problem.start(i), place_of_start(robot)), place_at_end(robot, mission.rules)
        legs = [(a, b) for a in [start, *places] for b in places if a is not b]
        legs += [(a, (problem.end(i), end)) for a in places] if end is not None else []
        for (a, here), (b, there) in legs:
            metres = travel.metres(robot, here, there)
            assert problem.legs(i, [a], [b])[0, 0] == pytest.approx(math.inf if metres is None else metres, rel=rel)
    assert n
    return problem


@pytest.mark.long(keep=3)
@pytest.mark.parametrize("seed", range(6))
def test_lengths_are_those_of_the_judge(seed):
    assert_as_judged(random_mission(seed), rel=1e-6)


@pytest.mark.parametrize("seed", [pytest.param(0, marks=pytest.mark.long), 1])
def test_in_space_they_are_nearly(seed):
    assert_as_judged(random_mission(seed, tasks=4, spatial=True), rel=1e-2)


def on_borders(random, world, robot, count):
    """Corners of what is free for a robot, and points of its sides, as near as float64 comes to them."""
    region = world.free_space(robot.radius_m, robot.kind).region
    corners = shapely.get_coordinates(region).tolist()
    for _ in range(count):
        side = region.boundary.interpolate(random.random(), normalized=True)
        yield random.choice((tuple(random.choice(corners)), (side.x, side.y)))


@pytest.mark.parametrize("offset", [(0.0, 0.0), (5e5, 4e6)])
@pytest.mark.parametrize("seed", range(6))
def test_lengths_are_those_of_the_judge_between_places_on_borders(seed, offset):
    random = Random(seed)
    stars = [star(np.random.default_rng(10 * seed + k), (10 + 20 * (k % 2), 5 + 9 * k), 9, 6) for k in range(4)]
    zones = tuple(
        Zone(polygon=tuple((x + offset[0], y + offset[1]) for x, y in ring))
        for ring in stars
        if shapely.is_valid(shapely.Polygon(ring)) and shapely.Polygon(ring).area > 0
    )
    corners = tuple((x + offset[0], y + offset[1]) for x, y in ((-9, -9), (40, 0), (37, 43), (-5, 40)))
    rover = Robot(id="rover", position=corners[0], radius_m=random.choice((0.0, 0.3)))
    bare = Mission(name="stars", robots=(rover,), tasks=(), map=Map(boundary=corners, zones=zones))
    start, *places = on_borders(random, World.of(bare), rover, 9)
    tasks = tuple(Task(id=str(k), position=place) for k, place in enumerate(places))
    mission = replace(bare, robots=(replace(rover, position=start),), tasks=tasks)
    assert_as_judged(mission, rel=1e-6)


@pytest.mark.parametrize(
    ("zones", "radius"),
    [
        ((box(0, 8, 4, 1), box(4, 8, 6, 1)), 0.0),  # side by side
        ((box(0, 8, 4, 1), box(4, 7, 6, 1)), 0.0),  # corner to corner
        ((box(0, 8, 3.5, 1), box(4, 8, 6, 1)), 0.25),  # as far apart as the drone is wide
        ((box(1e-9, 8, 10, 1),), 0.0),  # almost at the boundary
        pytest.param(  # one upon the other
            (box(0, 8, 10, 1, ceiling_m=4), box(0, 8, 10, 1, floor_m=4)), 0.0, marks=pytest.mark.long
        ),
        pytest.param(  # edge to edge
            (box(0, 8, 10, 1, ceiling_m=4), box(0, 9, 10, 1, floor_m=4)), 0.0, marks=pytest.mark.long
        ),
    ],
)
def test_a_drone_does_not_pass_where_zones_touch(zones, radius):
    """In a narrow arena: where there is no way, all of it is searched."""
    arena = Map(boundary=((0, 0), (10, 0), (10, 16), (0, 16)), zones=zones)
    drone = Robot(id="drone", position=(4.0, 5.0, 1.0), kind="air", radius_m=radius)
    task = Task(id="t", position=(4.0, 12.0, 1.0))
    mission = Mission(name="slits", robots=(drone,), tasks=(task,), map=arena)
    problem = assert_as_judged(mission, rel=1e-2)
    assert np.isinf(problem.legs(0, [problem.start(0)], [0])).all()


@pytest.mark.long
def test_in_two_rooms_lengths_are_those_of_the_judge():
    walls = (box(19, -1, 2, 42), box(5, 5, 5, 20), box(30, 10, 5, 25))
    arena = Map(boundary=((0, 0), (40, 0), (40, 40), (0, 40)), zones=walls)
    robots = tuple(Robot(id=f"r_{k}", position=(x, 20.0), radius_m=0.3) for k, x in enumerate((3.0, 24.0)))
    tasks = tuple(Task(id=str(k), position=(x, 20.0)) for k, x in enumerate((12.0, 15.0, 38.0, 23.0)))
    mission = Mission(name="rooms", robots=robots, tasks=tasks, map=arena)
    assert_as_judged(mission, rel=1e-6)
    plan = muster.solve(mission, iterations=100)
    assert plan.complete
    assert muster.verify(mission, plan).valid


@pytest.mark.long
def test_on_the_shipped_floor_plan_they_are_those_of_the_judge():
    assert_as_judged(muster.load("floor"), rel=1e-6)


@pytest.mark.long
@pytest.mark.parametrize(("seed", "allocator"), list(enumerate(2 * ["search", "greedy", "auction"])))
def test_plans_are_admissible(seed, allocator):
    mission = random_mission(seed, spatial=seed in (0, 4))
    limits = {"iterations": 200} if allocator == "search" else {}
    plan = muster.solve(mission, allocator, seed=seed, **limits)
    assert plan.complete
    assert muster.verify(mission, plan).valid


def test_a_part_knows_the_ways_of_the_whole():
    problem = Problem.compile(random_mission(1))
    part = problem.part([0, 2], [1, 3, 4])
    sent = pickle.loads(pickle.dumps(part))
    for one in (part, sent):
        np.testing.assert_array_equal(
            one.legs(1, [one.start(1), 0], [1, 2]), problem.legs(2, [problem.start(2), 1], [3, 4])
        )


def test_a_team_over_a_map_can_be_divided():
    mission = random_mission(2, tasks=24)
    plan = muster.solve(mission, iterations=400, parts=2)
    assert plan.complete
    assert muster.verify(mission, plan).valid


def walled_off(*, robots=(), tasks=()):
    walls = (box(4, 0, 1, 10, forbidden_to=("ground",)), box(7, 7, 2, 2))
    arena = Map(boundary=((0, 0), (10, 0), (10, 10), (0, 10)), zones=walls)
    rover = Robot(id="rover", position=(1.0, 1.0), radius_m=0.3)
    return Mission(
        name="walled-off", robots=(rover, *robots), tasks=(Task(id="near", position=(2.0, 5.0)), *tasks), map=arena
    )


def test_what_no_way_leads_to_is_impossible_and_says_why():
    mission = walled_off(tasks=(Task(id="far", position=(6.0, 2.0)), Task(id="in", position=(8.0, 8.0))))
    found = {item.task: [(r.reason, r.detail) for r in item.reasons] for item in impossible(Problem.compile(mission))}
    assert found == {
        "far": [("unreachable", "disconnected: no free way leads from (1, 1) to (6, 2), radius 0.3 m")],
        "in": [("unreachable", "goal blocked: (8, 8): inside zone 1")],
    }
    plan = muster.solve(mission, iterations=50)
    assert plan.tasks_completed == 1
    assert muster.verify(mission, plan).valid
    assert {reason.reason for left in plan.unassigned for reason in left.reasons} == {"unreachable"}


def test_who_can_come_there_does_it():
    mission = walled_off(
        robots=(Robot(id="drone", position=(2.0, 1.0), kind="air"),), tasks=(Task(id="far", position=(6.0, 2.0)),)
    )
    plan = muster.solve(mission, iterations=50)
    assert plan.complete
    assert "far" in next(route.tasks for route in plan.routes if route.robot == "drone")


def test_a_robot_that_starts_in_a_wall_is_an_error():
    mission = walled_off(robots=(Robot(id="stuck", position=(8.0, 6.9), radius_m=0.5),))
    with pytest.raises(MissionError, match=r"robots\[1\]\.position: .*0\.1 m from zone 1, radius 0\.5 m"):
        muster.solve(mission, iterations=10)


def test_the_straight_line_stays_where_it_is_asked_for():
    mission = random_mission(3)
    straight = Mission(
        name="straight", robots=mission.robots, tasks=mission.tasks, map=mission.map, rules=Rules(travel="euclidean")
    )
    problem = Problem.compile(straight)
    lengths = problem.over(problem.robot_paths).exits[0][:, None] - problem.over(problem.robot_paths).entries[0]
    open_legs = np.isfinite(problem.travel[0][0])
    assert 0 < open_legs.sum() < open_legs.size
    assert problem.travel[0][0][open_legs] == pytest.approx(np.linalg.norm(lengths, axis=2)[open_legs])
    apart = replace(straight, map=replace(straight.map, zones=()))
    assert len(Problem.compile(apart).travel[0]) == 0  # where nothing can be in the way there is no table


def test_too_many_places_for_a_table_are_refused():
    tasks = tuple(Task(id=str(k), position=(1 + k * 1e-3, 1.0)) for k in range(6000))
    with pytest.raises(NotSupportedError, match="6003 starts, ends and tasks; expected at most 6000"):
        Problem.compile(walled_off(tasks=tasks)).ready()
