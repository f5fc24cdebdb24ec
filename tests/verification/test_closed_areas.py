"""Closed areas: the judge and the planner against places on legs one by one, and what nobody may carry out."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from tests.closed_missions import closed_mission, greatest_depth_m

import muster
from muster import Mission, Plan, Robot, Task, load
from muster.mission.errors import NotSupportedError, PlanError
from muster.mission.ignorable_rules import IGNORABLE
from muster.mission.plan import Route
from muster.mission.rules import Rules
from muster.mission.site import Map, Zone
from muster.mission.tasks import Action
from muster.motion.map_world import World, body_of
from muster.motion.straight_ways import StraightWays
from muster.verification import verify
from muster.verification.closed_areas import ClosedAreas

CASES = Path(__file__).parents[1] / "data" / "cases" / "nofly"
CLEAR_M = 0.2
"""More than lies between two of the places that are looked at one by one."""
ARENA = ((0, 0), (40, 0), (40, 30), (0, 30))
WALL = ((5, 0), (9, 0), (9, 20), (5, 20))


def straight(*tasks, zone=None, robot=None, **rules):
    team = (Robot(id="r", position=(1, 1)) if robot is None else robot,)
    zones = (Zone(polygon=WALL, **(zone or {})),)
    area = Map(boundary=ARENA, zones=zones)
    return Mission(name="z", robots=team, tasks=tasks, map=area, rules=Rules(travel="euclidean", **rules))


def judged(mission, *tasks, **kwargs):
    verdict = verify(mission, Plan(routes=(Route("r", tasks),)), **kwargs)
    return [(v.kind, v.robot, v.task, v.detail) for v in verdict.violations]


def kinds(mission, *tasks):
    return [kind for kind, *_ in judged(mission, *tasks)]


@pytest.mark.parametrize("seeds", [range(5), pytest.param(range(5, 150), marks=pytest.mark.long)])
def test_judge_and_planner_agree_with_places_looked_at_one_by_one(seeds):
    counts = {True: 0, False: 0}
    for seed in seeds:
        mission = closed_mission(seed)
        areas, world = ClosedAreas(mission), World.of_travel(mission)
        places = [robot.position for robot in mission.robots] + [task.position for task in mission.tasks]
        for robot in mission.robots:
            ways = StraightWays(world, body_of(robot))
            for start, end in pairwise(places):
                depth_m = greatest_depth_m(mission, robot, start, end)
                closed = areas.obstacle(robot, start, end)
                assert closed == ways.obstacle(np.array(start), np.array(end)), (seed, robot.id, start, end)
                if depth_m > 1e-6 or depth_m < -CLEAR_M:
                    assert (closed is not None) == (depth_m > 0), (seed, robot.id, start, end)
                    counts[depth_m > 0] += 1
    assert min(counts.values()) > len(seeds)


@pytest.mark.long
@pytest.mark.parametrize("seeds", [range(10), pytest.param(range(10, 60), marks=pytest.mark.long)])
@pytest.mark.parametrize("allocator", ["greedy", "search", "auction", "consensus-bundle", "genetic"])
def test_no_plan_enters_a_closed_area(allocator, seeds):
    done = left_out = 0
    for seed in seeds:
        mission = closed_mission(seed)
        plan = muster.solve(mission, allocator, iterations=20, time_limit=None)
        verdict = muster.verify(mission, plan)
        assert verdict.valid, (seed, verdict.violations)
        robots, tasks = ({one.id: one for one in group} for group in (mission.robots, mission.tasks))
        for route in plan.routes:
            robot, here = robots[route.robot], robots[route.robot].position
            for task in map(tasks.get, route.tasks):
                entry, leave = task.entry or task.position, task.exit or task.position
                assert max(greatest_depth_m(mission, robot, *leg) for leg in ((here, entry), (entry, leave))) < 1e-6
                here = leave
            if route.tasks and robot.return_to_start:
                assert greatest_depth_m(mission, robot, here, robot.position) < 1e-6
        done, left_out = done + plan.tasks_completed, left_out + len(plan.unassigned)
    assert min(done, left_out) > len(seeds) / 4


def test_the_case_of_a_leg_through_a_zone():
    mission = load(CASES / "euclid-through-zone.yaml")
    assert judged(mission, "a") == [("closed-area", "r", "a", "the leg from its start to task a enters zone 0")]
    plan = muster.solve(mission, iterations=10)
    assert [(r.reason, r.detail) for item in plan.unassigned for r in item.reasons] == [
        ("unreachable", "closed area: the straight leg from (1, 1) to (20, 1) enters zone 0")
    ]
    assert [item.task for item in muster.check(mission).impossible] == ["a"]


def test_a_way_by_another_task_leads_around():
    mission = straight(Task(id="far", position=(20, 12)), Task(id="over", position=(5, 25)))
    assert kinds(mission, "far") == ["closed-area"]
    assert judged(mission, "over", "far") == []
    assert muster.solve(mission, iterations=50).routes[0].tasks == ("over", "far")


def test_nobody_can_have_it_ignored():
    mission = straight(Task(id="a", position=(20, 1)))
    assert [kind for kind, *_ in judged(mission, "a", ignore=IGNORABLE)] == ["closed-area"]
    said = Plan(routes=(Route("r", ("a",)),), ignored=IGNORABLE)
    assert [v.kind for v in verify(mission, said).violations] == ["closed-area"]


@pytest.mark.parametrize(
    ("zone", "robot", "found"),
    [
        ({"forbidden_to": ("air",)}, {}, []),
        ({"forbidden_to": ("air",)}, {"kind": "air"}, ["closed-area"]),
        ({"floor_m": 50, "ceiling_m": 60}, {"kind": "air"}, ["closed-area"]),  # heights in the plane are unknown
        ({"floor_m": 50, "ceiling_m": 60}, {}, ["closed-area"]),
        ({"id": "gate", "open": True}, {}, []),
        ({"id": "gate"}, {}, ["closed-area"]),
    ],
)
def test_a_zone_is_closed_to_whom_it_says(zone, robot, found):
    mission = straight(Task(id="a", position=(20, 1)), zone=zone, robot=Robot(id="r", position=(1, 1), **robot))
    assert kinds(mission, "a") == found


@pytest.mark.parametrize(
    ("zone", "start", "goal", "found"),
    [
        ({"ceiling_m": 10}, (1, 1, 12), (20, 1, 12), []),  # over it
        ({"floor_m": 5}, (1, 1, 2), (20, 1, 2), []),  # below it
        ({"floor_m": 5, "ceiling_m": 10}, (1, 1, 2), (20, 1, 12), ["closed-area"]),
        ({"ceiling_m": 10}, (1, 1, 0), (20, 1, 12), ["closed-area"]),
        ({"floor_m": 8, "ceiling_m": 30}, (1, 1, 0), (30, 1, 20), ["closed-area"]),  # below it, but drones climb first
        ({"floor_m": 8, "ceiling_m": 15}, (1, 1, 0), (30, 1, 20), []),  # over it then, and below it
        ({"floor_m": 8, "ceiling_m": 30}, (30, 1, 20), (1, 1, 0), ["closed-area"]),  # and land upright
        ({"floor_m": 8, "ceiling_m": 15}, (7, 1, 0), (7, 25, 20), ["closed-area"]),  # the column over the start
        ({"floor_m": 8, "ceiling_m": 15}, (7, 1, 0), (7, 25, 5), []),
    ],
)
def test_heights_count_in_space(zone, start, goal, found):
    drone = Robot(id="r", position=start, kind="air", radius_m=0.25)
    mission = straight(Task(id="a", position=goal), zone=zone, robot=drone)
    mission = replace(mission, map=replace(mission.map, boundary=((-9, -9), (50, -9), (50, 40), (-9, 40))))
    assert kinds(mission, "a") == found
    assert muster.solve(mission, iterations=10).complete == (not found)


@pytest.mark.parametrize(("radius_m", "found"), [(0.0, []), (0.5, ["closed-area"])])
def test_a_body_does_not_reach_into_a_zone_it_passes(radius_m, found):
    robot = Robot(id="r", position=(2, 20.4), radius_m=radius_m)
    assert kinds(straight(Task(id="a", position=(20, 20.4)), robot=robot), "a") == found


def test_along_the_side_of_a_zone_is_outside_of_it():
    robot = Robot(id="r", position=(5, 25), radius_m=0.0)
    mission = straight(Task(id="a", position=(5, 2)), robot=robot)
    assert judged(mission, "a") == []
    assert muster.solve(mission, iterations=10).complete


@pytest.mark.parametrize(
    ("task", "detail"),
    [
        (Task(id="a", position=(2, 40)), "the leg from its start to task a leaves the boundary"),
        (Task(id="a", position=(3, 5), exit=(20, 5)), "the work at (3, 5) to (20, 5) enters zone 0"),
        (
            Task(id="a", position=(20, 5), action=Action(name="delivery", pickup=(2, 2))),
            "the work at (2, 2) to (20, 5) enters zone 0",
        ),
        (
            Task(id="a", position=(3, 10), action=Action(name="ground-patrol", side_m=6)),
            "the work at (0, 13) to (6, 13) enters zone 0",
        ),
    ],
)
def test_work_keeps_out_too(task, detail):
    mission = straight(task)
    assert [found for *_, found in judged(mission, "a")] == [detail]
    assert not muster.solve(mission, iterations=10).complete


def test_the_way_home_counts_and_stations_do():
    robot = Robot(id="r", position=(1, 1), end_position=(20, 1))
    mission = straight(Task(id="a", position=(2, 2)), robot=robot)
    assert [found for *_, found in judged(mission, "a")] == [
        "the leg from task a to where the route must end enters zone 0"
    ]


def test_a_concave_boundary_is_kept():
    robot = Robot(id="r", position=(1, 25))
    horseshoe = ((0, 0), (40, 0), (40, 30), (30, 30), (30, 10), (10, 10), (10, 30), (0, 30))
    mission = replace(straight(Task(id="a", position=(35, 25)), robot=robot), map=Map(boundary=horseshoe))
    assert kinds(mission, "a") == ["closed-area"]
    assert not muster.solve(mission, iterations=10).complete


def test_with_a_table_the_places_of_work_count(tmp_path):
    (tmp_path / "t.csv").write_text(",r,a,b\nr,0,1,1\na,1,0,1\nb,1,1,0\n")
    (tmp_path / "m.yaml").write_text(
        "schema: muster/1\nname: z\nrules: {travel: matrix}\ntravel: {v: t.csv}\nsuitability: {v: {t: 1}}\n"
        "map:\n  boundary: [[0, 0], [40, 0], [40, 30], [0, 30]]\n"
        "  zones: [{polygon: [[5, 0], [9, 0], [9, 20], [5, 20]]}]\n"
        "robots: [{id: r, type: v, position: [1, 1]}]\n"
        "tasks: [{id: a, type: t, position: [20, 1]}, {id: b, type: t, position: [7, 1]}]\n"
    )
    mission = load(tmp_path / "m.yaml")
    assert judged(mission, "a", "b") == [("closed-area", "r", "b", "at task b the robot enters zone 0")]
    plan = muster.solve(mission, iterations=10)
    assert plan.routes[0].tasks == ("a",)
    with pytest.raises(NotSupportedError, match=r"rules\.travel: matrix; expected euclidean or map: a simulated run"):
        muster.simulate(mission, plan)


def test_nothing_begins_with_a_plan_through_a_zone():
    mission = straight(Task(id="a", position=(20, 1)))
    plan = Plan(routes=(Route("r", ("a",)),))
    with pytest.raises(PlanError, match=r"<plan>: closed-area: r, a, the leg from its start to task a enters zone 0"):
        muster.simulate(mission, plan)
    with pytest.raises(PlanError, match="closed-area"):
        muster.export(mission, plan, "csv")
