"""Teams in space without a map: drones and robots on the ground share one, touch nothing, and do what can be done."""

from importlib.util import find_spec

import numpy as np
import pytest

from muster import Map, Mission, Robot, Simulation, Task, Zone, load, simulate, solve
from muster.motion.map_world import World
from muster.motion.maps.occupancy_rules import read_grid
from muster_studies.unknown.scenes import hall, random_space

BOTH = ("ground", "air")


def block(x, y, width, depth, floor=None, ceiling=4.0, forbidden=BOTH):
    corners = ((x, y), (x + width, y), (x + width, y + depth), (x, y + depth))
    return Zone(polygon=corners, floor_m=floor, ceiling_m=ceiling, forbidden_to=forbidden)


def rover(name="rover", place=(1.0, 4.0, 0.0)):
    return Robot(id=name, position=place, radius_m=0.2, speed_mps=1.0)


def drone(name="drone", place=(1.0, 2.0, 0.0)):
    return Robot(id=name, position=place, radius_m=0.2, speed_mps=2.0, kind="air", kinematics="quadcopter")


def yard(*zones, robots, tasks):
    chart = Map(boundary=((0.0, 0.0), (14.0, 0.0), (14.0, 8.0), (0.0, 8.0)), zones=zones)
    places = (
        Task(id=name, position=place, only_robots=None if robot is None else (robot,))
        for name, (place, robot) in tasks.items()
    )
    return Mission(name="yard", map=chart, robots=tuple(robots), tasks=tuple(places))


def carried_out(mission, until_s=600.0, **how):
    """The run, the least clearance of its robots from true obstacles in radii, and the places of each by step."""
    world, worlds, places = World.of(mission), [], []
    run = Simulation(mission, solve(mission, "greedy"), on_world=worlds.append, unknown=True, **how)
    while not run.done and run.time_s < until_s:
        run.advance(run.time_s + 0.1)
        places.append(worlds[0].positions.copy())
    steps = np.stack(places)
    least = min(
        float(world.clearance(steps[:, k], robot.kind, robot.radius_m).min()) / robot.radius_m
        for k, robot in enumerate(mission.robots)
    )
    return run, least, steps


@pytest.mark.long
@pytest.mark.parametrize("world", ["kinematic", pytest.param("physics", marks=pytest.mark.long)])
def test_a_drone_finds_its_way_over_a_wall_and_around_a_tower(world):
    if world == "physics" and find_spec("mujoco") is None:
        pytest.skip("the extra `physics` is not installed")
    mission = yard(
        block(4, 0, 0.4, 8, ceiling=3.0),
        block(8, 2, 1.5, 4, ceiling=30.0),
        robots=[drone(place=(1.0, 4.0, 1.0))],
        tasks={"behind": ((13.0, 4.0, 1.0), None)},
    )
    run, least, steps = carried_out(mission, world=world)
    report = run.result()
    assert report.tasks_done == ("behind",)
    assert least >= 0.99
    assert steps[:, 0, 2].max() < 6
    assert report.ground.driven_m < 1.5 * report.ground.with_map_m


@pytest.mark.long
def test_robots_pass_below_a_bridge_that_those_in_the_air_see_as_one():
    mission = yard(
        block(6, 0, 1.5, 8, floor=1.2, ceiling=3.0),
        robots=[rover(), drone(place=(1.0, 6.0, 2.0))],
        tasks={"ground": ((12.0, 4.0, 0.0), "rover"), "air": ((12.0, 6.0, 2.0), "drone")},
    )
    run, least, _ = carried_out(mission)
    assert set(run.result().tasks_done) == {"ground", "air"}
    assert least >= 0.99
    assert not run._ground.map.ground.seen.occupied.any()
    assert run._ground.map.air.seen.occupied.any()


@pytest.mark.long
def test_a_bridge_lower_than_a_robot_stops_it_alone():
    tall = Robot(id="tall", position=(1.0, 4.0, 0.0), radius_m=0.5, speed_mps=1.0)
    mission = yard(
        block(6, 0, 1.0, 6, floor=0.6, ceiling=2.0),
        robots=[rover(place=(1.0, 2.0, 0.0)), tall],
        tasks={"low": ((12.0, 2.0, 0.0), "rover"), "high": ((12.0, 4.0, 0.0), "tall")},
    )
    run, least, steps = carried_out(mission)
    assert set(run.result().tasks_done) == {"low", "high"}
    assert least >= 0.98
    assert np.abs(steps[:, 0, 1] - 2.0).max() < 0.3
    assert steps[:, 1, 1].max() > 6.4


@pytest.mark.long
def test_drones_stay_below_a_ceiling():
    mission = yard(
        block(0, 0, 14, 8, floor=2.5, ceiling=2.8),
        block(6, 0, 0.3, 6, ceiling=2.5),
        robots=[drone(place=(1.0, 4.0, 1.0))],
        tasks={"room": ((13.0, 2.0, 1.0), None), "loft": ((7.0, 4.0, 4.0), None)},
    )
    run, least, steps = carried_out(mission)
    report = run.result()
    assert report.tasks_done == ("room",)
    assert [task for task, _ in report.tasks_lost] == ["loft"]
    assert least >= 0.99
    assert steps[..., 2].max() < 2.5


@pytest.mark.long
def test_a_no_fly_zone_is_known_and_no_obstacle_on_the_ground():
    zone = Zone(polygon=((5.0, 0.0), (7.0, 0.0), (7.0, 6.0), (5.0, 6.0)), forbidden_to=("air",))
    mission = yard(
        zone,
        robots=[rover(place=(1.0, 2.0, 0.0)), drone(place=(1.0, 4.0, 1.0))],
        tasks={"ground": ((12.0, 2.0, 0.0), "rover"), "air": ((12.0, 4.0, 1.0), "drone")},
    )
    run, _, steps = carried_out(mission)
    assert set(run.result().tasks_done) == {"ground", "air"}
    assert steps[:, 1, 1].max() > 6.2
    assert np.abs(steps[:, 0, 1] - 2.0).max() < 0.3
    assert not run._ground.map.air.seen.occupied.any()


def test_what_drones_see_from_above_is_known_on_the_ground_and_the_reverse():
    wall = block(9, 1, 0.4, 7, ceiling=1.0)
    mission = yard(
        block(4, 0, 0.4, 7, ceiling=1.0),
        wall,
        robots=[rover(place=(1.0, 1.0, 0.0)), drone(place=(1.0, 3.0, 0.0))],
        tasks={"air": ((8.0, 4.0, 3.0), "drone")},
    )
    run, _, steps = carried_out(mission)
    assert np.ptp(steps[:, 0], axis=0).max() < 0.01
    team_map = run._ground.map
    found = team_map.ground.seen.centres(np.argwhere(team_map.ground.seen.occupied))
    assert ((found[:, 0] > 8.9) & (found[:, 1] > 1)).sum() > 20
    team_map.share_air()
    (cell,) = np.floor(team_map.ground.seen.frame.to_grid(np.array([[8.0, 4.0]]))).astype(int)
    assert team_map.ground.seen.known[cell[1], cell[0]]
    alone, _, _ = carried_out(
        yard(
            wall,
            robots=[rover(place=(8.0, 4.0, 0.0)), drone(place=(1.0, 3.0, 0.0))],
            tasks={"ground": ((8.0, 2.0, 0.0), "rover")},
        )
    )
    air = alone._ground.map.air.seen
    points = air.points_in(np.argwhere(air.occupied))
    assert (np.abs(points[:, 0] - 9.0) < 0.05).sum() > 50


@pytest.mark.long
@pytest.mark.parametrize("seed", [pytest.param(k, marks=[] if k == 7 else pytest.mark.long) for k in range(12)])
def test_random_worlds_in_space(seed):
    run, least, _ = carried_out(random_space(seed))
    report = run.result()
    assert {task.id for task in run._executor.mission.tasks} - set(report.tasks_done) == {"in a tower"}
    assert least >= 0.97
    assert report.contacts == 0
    assert report.ground.driven_m < 1.5 * report.ground.with_map_m


@pytest.mark.long
def test_five_drones_explore_a_building_in_a_fraction_of_the_time_of_one():
    reports = [carried_out(hall(0, robots), 3000.0, explore=True)[0].result() for robots in (1, 5)]
    one, five = reports
    assert five.mission_time_s < 0.4 * one.mission_time_s
    assert min(report.ground.explored_m2 for report in reports) > 0.9 * 40 * 30


@pytest.mark.long
def test_the_map_that_was_built_is_a_mission_that_muster_reads(tmp_path):
    mission = yard(
        block(6, 0, 1.0, 5, ceiling=2.0),
        block(9, 2, 1.5, 6, floor=1.2, ceiling=3.0),
        robots=[rover(), drone(place=(1.0, 6.0, 2.0))],
        tasks={"ground": ((12.0, 4.0, 0.0), "rover"), "air": ((13.0, 6.0, 4.0), "drone")},
    )
    run, _, _ = carried_out(mission)
    run.save_map(tmp_path / "built.yaml")
    built = load(tmp_path / "built.mission.yaml")
    floors = {zone.floor_m for zone in built.map.zones}
    assert None in floors
    assert len(floors) > 1
    truth, world = World.of(mission), World.of(built)
    air = run._ground.map.air.seen
    points = air.points_in(np.argwhere(air.occupied))
    assert world.clearance(points, "air").max() < 1e-3
    corners = np.array([(x, y, zone.ceiling_m) for zone in built.map.zones for x, y in zone.polygon])
    assert truth.clearance(corners, "air").max() < 2.1 * air.frame.cell_m
    report = simulate(built, solve(built, "greedy"))
    assert set(report.tasks_done) == {"ground", "air"}
    slice_ = read_grid(Map(ros_yaml=str(tmp_path / "built.yaml")), tmp_path, [])
    assert slice_.blocked.any()
