"""A team without a map does all that can be done, touches nothing, and says what its map proves to be out of reach."""

import json
from dataclasses import replace
from importlib.util import find_spec
from itertools import pairwise

import numpy as np
import pytest
import shapely

from muster import (
    Camera,
    Found,
    Map,
    Mission,
    ParameterError,
    Robot,
    Simulation,
    Tag,
    Task,
    Zone,
    load,
    simulate,
    solve,
)
from muster.mission.model import Event, Work
from muster.motion.grid import Grid
from muster.motion.map_world import Body, World
from muster.motion.maps.occupancy_rules import read_grid
from muster.perception.explored_ground import ExploredGround, ruled_world
from muster.perception.occupancy_map import OccupancyMap
from muster.running.begun import Begun
from muster.running.run_request import RunRequest
from muster.state import MissionState, checkpoint_of, restored
from muster.state.explored_map import FREE
from muster_studies.unknown.scenes import building, random_space, random_world
from muster_studies.unknown.study import carried_out

NO_FLY = Zone(polygon=((1.0, 5.0), (3.0, 5.0), (3.0, 6.0), (1.0, 6.0)), forbidden_to=("air",))


def room(*boxes, tasks, robots=1, zones=(), events=()):
    walls = (
        Zone(polygon=((x, y), (x + w, y), (x + w, y + h), (x, y + h)), forbidden_to=("ground", "air"))
        for x, y, w, h in boxes
    )
    chart = Map(boundary=((0.0, 0.0), (12.0, 0.0), (12.0, 8.0), (0.0, 8.0)), zones=(*walls, *zones))
    team = (Robot(id=f"r_{k}", position=(1.0, 2.0 + k), radius_m=0.2, speed_mps=1.0) for k in range(robots))
    places = (Task(id=f"t_{k}", position=place) for k, place in enumerate(tasks))
    return Mission(name="room", map=chart, robots=tuple(team), tasks=tuple(places), events=tuple(events))


POCKET = ((6.0, 1.0, 0.3, 6.0), (3.0, 6.7, 3.3, 0.3), (3.0, 1.0, 3.3, 0.3))


def least_clearance(mission, of_m=None, **how):
    """The report of a run, and the least distance of a robot from the true obstacles, in radii or that length."""
    world, worlds, least = World.of(mission), [], []
    with_plan = Simulation(mission, solve(mission, "greedy"), on_world=worlds.append, unknown=True, **how)
    while not with_plan.done:
        with_plan.advance(with_plan.time_s + 0.1)
        for robot, place in zip(mission.all_robots, worlds[0].positions, strict=False):
            least.append(world.clearance(place[None, :2], robot.kind)[0] / (of_m or robot.radius_m))
    return with_plan, min(least)


def test_a_team_gets_out_of_a_pocket_and_touches_nothing():
    mission = room(*POCKET, tasks=[(11.0, 4.0), (4.5, 4.0), (8.0, 1.0)], robots=2)
    run, least = least_clearance(mission)
    report = run.result()
    assert set(report.tasks_done) == {"t_0", "t_1", "t_2"}
    assert least > 0.99
    assert report.ground.ways_closed > 0
    assert report.ground.driven_m < 2 * report.ground.with_map_m


def test_what_the_map_proves_to_be_walled_in_is_unreachable_and_the_rest_is_done():
    walls = ((8, 2, 3, 0.3), (8, 5, 3, 0.3), (8, 2, 0.3, 3.3), (11, 2, 0.3, 3.3))
    report = simulate(mission := room(*walls, tasks=[(9.5, 3.5), (11.5, 7.0)]), solve(mission, "greedy"), unknown=True)
    assert report.tasks_done == ("t_1",)
    assert report.tasks_lost[0][0] == "t_0"
    assert "unreachable" in report.tasks_lost[0][1]


def test_the_plan_tells_robots_nothing_of_obstacles():
    """Whatever plan was made with the map, the first way leads through an obstacle that another hides."""
    mission = room((4.0, 1.0, 0.3, 6.0), (8.0, 0.0, 0.3, 6.5), tasks=[(11.0, 2.0)])
    run = Simulation(mission, solve(mission, "greedy"), unknown=True)
    assert run._executor.mission.map.zones == ()
    state = run._executor.crew["r_0"]
    way = np.array([state.position, *state.points_left])[:, :2]
    along = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(way)])
    assert World.of(mission).clearance(along, "ground").min() == 0


def test_no_fly_zones_and_doors_are_known_by_rule():
    door = Zone(id="gate", polygon=((6.0, 0.0), (6.3, 0.0), (6.3, 1.0), (6.0, 1.0)), open=True)
    mission = room(
        (6.0, 1.0, 0.3, 7.0), tasks=[(11.0, 0.6)], zones=(NO_FLY, door), events=[Event(at_s=1.0, door_closes="gate")]
    )
    run = Simulation(mission, solve(mission, "greedy"), unknown=True)
    assert run._executor.mission.map.zones == (NO_FLY, door)
    while not run.done:
        run.advance(run.time_s + 5.0)
    assert run.result().tasks_done == ()


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("world", ["kinematic", "physics"])
def test_the_border_of_a_no_fly_zone_is_no_obstacle_to_those_below(world):
    if world == "physics" and find_spec("mujoco") is None:
        pytest.skip("the extra `physics` is not installed")
    across = Zone(polygon=((5.0, 0.0), (6.0, 0.0), (6.0, 8.0), (5.0, 8.0)), forbidden_to=("air",))
    mission = room(tasks=[(11.0, 4.0)], zones=(across,))
    drone = Robot(id="drone", position=(2.0, 6.0), radius_m=0.2, kind="air", kinematics="quadcopter")
    mission = replace(mission, robots=(*mission.robots, drone))
    run = Simulation(mission, solve(mission, "greedy"), unknown=True, world=world)
    while not run.done:
        run.advance(run.time_s + 5.0)
    seen = run._ground.map.ground.seen
    at = seen.centres(np.argwhere(seen.occupied))
    assert not ((np.abs(at[:, 0] - 5.5) < 0.6) & (np.abs(at[:, 1] - 4.0) < 3.8)).any()
    assert run.result().tasks_done == ("t_0",)


def test_what_a_silent_robot_sees_reaches_the_team_when_it_is_heard():
    mission = room(
        (3.0, 1.0, 0.3, 6.0),
        tasks=[(11.0, 4.0)],
        robots=2,
        events=[
            Event(at_s=0.5, robot_silent="r_0"),
            Event(at_s=0.5, robot_silent="r_1"),
            Event(at_s=6.0, robot_returns="r_0"),
        ],
    )
    run = Simulation(mission, solve(mission, "greedy"), unknown=True)
    run.advance(0.6)
    known = np.count_nonzero(run._ground.map.ground.seen.known)
    while run.time_s < 5.0:
        run.advance(5.0)
    assert np.count_nonzero(run._ground.map.ground.seen.known) == known
    while run.time_s < 7.0:
        run.advance(7.0)
    assert np.count_nonzero(run._ground.map.ground.seen.known) > known


def test_frontiers_become_tasks_until_all_is_explored():
    mission = room((4.0, 0.0, 0.3, 6.0), (8.0, 2.0, 0.3, 6.0), tasks=[], robots=2)
    run, least = least_clearance(mission, explore=True)
    report = run.result()
    assert report.ground.frontiers > 0
    assert report.tasks_lost == ()
    assert report.ground.explored_m2 > 0.93 * (12 * 8 - 2 * 0.3 * 6)
    assert least > 0.99


@pytest.mark.long
def test_what_cameras_find_while_robots_explore_becomes_a_task():
    """Frontiers are tasks of themselves where there is something to be found; no task of the mission leads there."""
    mission = room((4.0, 0.0, 0.3, 6.0), (8.0, 2.0, 0.3, 6.0), tasks=[])
    drone = Robot(
        id="drone",
        position=(1.0, 2.0),
        radius_m=0.2,
        kind="air",
        kinematics="quadcopter",
        camera=Camera(fov_deg=120, tilt_deg=90),
    )
    tag = Tag(id=5, position=(10.0, 3.0))
    mission = replace(mission, robots=(drone,), tags=(tag,), found=(Found(becomes=Work(duration_s=1.0)),))
    report = simulate(mission, solve(mission, "greedy"), unknown=True)
    assert "found-5" in [found.task for found in report.found]
    assert "found-5" in report.tasks_done
    assert report.ground.frontiers > 0


def test_a_wide_robot_that_joins_keeps_off_what_was_seen_before():
    mission = room((6.0, 0.0, 0.3, 5.0), tasks=[(11.0, 1.0)])
    run = Simulation(mission, solve(mission, "greedy"), unknown=True)
    run.advance(1.0)
    wide = Body(0.8, "ground")
    way = run._ground.map.ground.way(wide, (1.5, 2.0), (10.0, 2.0)).points
    face = shapely.LineString([(6.0, 0.0), (6.0, 4.9)])  # as far as the robot has seen it
    assert shapely.LineString(way).distance(face) > 0.79


def test_events_tell_the_map_from_its_beginning_and_the_state_folds_it():
    mission = room(*POCKET, tasks=[(11.0, 4.0)])
    run = Simulation(mission, solve(mission, "greedy"), unknown=True)
    while not run.done:
        run.advance(run.time_s + 5.0)
    explored = MissionState.after(mission, run.events).explored
    assert np.array_equal(explored.rows, run._ground._shown._told)
    assert explored == run.state.explored
    row, column = np.floor(np.array([2.0, 1.0]) / explored.cell_m).astype(int)
    assert explored.rows[row][column] == FREE  # where the robot began
    assert restored(mission, checkpoint_of(run.state)).explored == explored


@pytest.mark.long
def test_the_map_that_was_built_is_saved_as_a_map_of_ros(tmp_path):
    mission = load("market-rescue-arena")
    file = tmp_path / "built.yaml"
    simulate(mission, solve(mission, "greedy"), unknown=True, explore=True, save_map=file)
    faults = []
    grid = read_grid(Map(ros_yaml=file.name), tmp_path, faults)
    assert not faults
    again = World.of(replace(mission, map=Map(ros_yaml=str(file))))
    free = np.array([robot.position for robot in mission.robots])
    assert (again.clearance(free, "ground") > 0).all()
    inside = np.array([[0.375, 0.65], [1.25, 1.2]])
    assert (again.clearance(inside, "ground") == 0).all()
    assert grid.resolution_m == pytest.approx(0.02)


def test_the_physics_world_too():
    if find_spec("mujoco") is None:  # not imported here: first it must be said how it draws
        pytest.skip("the extra `physics` is not installed")
    mission = room((4.0, 1.0, 0.3, 7.0), tasks=[(6.0, 6.0)])
    run, least = least_clearance(mission, world="physics")
    assert run.result().tasks_done == ("t_0",)
    assert least > 0.98


def test_what_does_not_go_together_is_refused():
    with pytest.raises(ParameterError, match="explore"):
        RunRequest(explore=True)
    with pytest.raises(ParameterError, match="traffic"):
        RunRequest(unknown=True, traffic="reserve")
    with pytest.raises(ParameterError, match="law"):
        RunRequest(unknown=True, law="trajectory")
    with pytest.raises(ParameterError, match="save_map"):
        simulate(mission := load("6T-2R"), solve(mission, "greedy"), save_map="built.yaml")
    with pytest.raises(ParameterError, match="unknown: mission 6T-2R has no map"):
        simulate(mission, solve(mission, "greedy"), unknown=True)


def test_a_robot_that_joins_maps_too():
    mission = room((6.0, 1.0, 0.3, 7.0), tasks=[(11.0, 6.0), (2.0, 6.0)])
    joins = Robot(id="new", position=(9.0, 4.0), radius_m=0.2, speed_mps=1.0)
    run, least = least_clearance(replace(mission, events=(Event(at_s=1.0, robot_joins=joins),)))
    assert set(run.result().tasks_done) == {"t_0", "t_1"}
    assert {event.robot for event in run.events.since(0) if event.kind == "ends"} == {"new", "r_0"}
    assert least > 0.98


@pytest.mark.parametrize("walls", [((4.0, 1.0, 0.3, 7.0),), POCKET], ids=["wall", "pocket"])
@pytest.mark.parametrize("speed_mps", [4.0, *(pytest.param(speed, marks=pytest.mark.long) for speed in (1.0, 0.1))])
@pytest.mark.parametrize("width", [0.0, 0.5])
def test_a_narrow_robot_keeps_off_walls_of_which_its_beams_miss_parts(width, speed_mps, walls):
    """The world stops bodies at walls, and a point nowhere: it would be inside."""
    least_m = 0.05 * speed_mps
    mission = room(*walls, tasks=[(11.0, 4.0)])
    robot = replace(mission.robots[0], speed_mps=speed_mps, radius_m=width * least_m)
    run, least = least_clearance(replace(mission, robots=(robot,)), of_m=least_m)
    assert run.result().tasks_done == ("t_0",)
    assert least > 0.6


@pytest.mark.parametrize("at_s", [0.0, pytest.param(0.5, marks=pytest.mark.long)])
def test_a_point_that_joins_drives_through_no_wall(at_s):
    mission = room((4.0, 1.0, 0.3, 7.0), tasks=[(1.0, 6.0), (6.0, 4.0)])
    only_new = replace(mission.tasks[1], only_robots=("new",))
    joins = Event(at_s=at_s, robot_joins=Robot(id="new", position=(2.0, 4.0)))
    run, least = least_clearance(replace(mission, tasks=(mission.tasks[0], only_new), events=(joins,)), of_m=0.05)
    assert set(run.result().tasks_done) == {"t_0", "t_1"}
    assert least > 0.6


def test_a_line_between_two_points_that_were_hit_is_not_clear_for_a_body_of_no_width():
    seen = ExploredGround(
        ruled_world(World.of(room(tasks=[(2.0, 2.0)]))),
        OccupancyMap(Grid(np.zeros((40, 40), dtype=bool), 0.05, (0, 0, 0)), 0.5),
    )
    seen.seen.hit(np.array([[1.0, 1.0], [1.0, 1.05]]), np.array([[1.0, 1.0], [1.0, 1.05]]) + 1e-6)
    cells = np.argwhere(seen.seen.occupied)
    through, beside = (np.array([(0.5, y), (1.5, y)]) for y in (1.025, 1.2))
    assert not seen.is_clear(Body(0.0, "ground"), through, 1, cells)
    assert seen.is_clear(Body(0.0, "ground"), beside, 1, cells)


@pytest.mark.long
@pytest.mark.parametrize("seed", [2, *(pytest.param(k, marks=pytest.mark.long) for k in range(50) if k != 2)])
def test_in_random_worlds_all_that_can_be_reached_is_done(seed):
    outcome = carried_out(random_world(seed))
    assert outcome.done == outcome.wanted > 0
    assert outcome.clearance > 0.99
    assert outcome.contacts == 0


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_five_robots_explore_in_at_most_a_third_of_the_time_of_one(seed):
    one, five = (carried_out(building(seed, robots), explore=True) for robots in (1, 5))
    assert five.time_s <= 0.35 * one.time_s
    assert five.explored_m2 == pytest.approx(one.explored_m2, rel=0.03)


@pytest.mark.long
@pytest.mark.parametrize(
    ("mission", "explore"),
    [
        (random_world(2), False),
        *(
            pytest.param(mission, explore, marks=pytest.mark.long)
            for mission, explore in ((random_world(2), True), (random_space(2), False), (random_space(2), True))
        ),
    ],
    ids=lambda one: one.name if isinstance(one, Mission) else None,
)
def test_a_run_that_goes_on_after_a_crash_has_its_map(mission, explore):
    first = Simulation(mission, plan := solve(mission, "greedy"), unknown=True, explore=explore)
    first._ground._kept_s = -100.0
    while first.time_s < 10.0:
        first.advance(10.0)
    first._ground._kept_s = -100.0
    bodies = json.loads(json.dumps(first.snapshot()))
    begun = Begun.of(restored(first._executor.mission, checkpoint_of(first.state)), bodies, first.time_s, "kinematic")
    again = Simulation(mission, plan, unknown=True, explore=explore, begun=begun)
    known, was = again._ground.map.ground.seen.known, first._ground.map.ground.seen.known
    assert (known | ~was).all()
    assert again._ground.map.ground.seen.occupied.sum() >= first._ground.map.ground.seen.occupied.sum()
    while not again.done:
        again.advance(again.time_s + 5.0)
    report = again.result()
    left = {task.id for task in mission.tasks} - set(report.tasks_done)
    assert len(left) == 1
    assert next(iter(left)).startswith("in a ")
    assert (report.ground.frontiers > 0) == explore
