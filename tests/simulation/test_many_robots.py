"""Many robots in the kinematic world: no contacts, no deadlocks, walls, what is measured."""

import itertools

import numpy as np
import pytest
from tests.simulation.scenes import circle, mission, robot, send_across, states, until_idle

import muster
from muster.mission.model import Map, Zone
from muster.motion.map_world import World, body_of
from muster.motion.path import Path
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.port import Waypoint
from muster.simulation import KinematicWorld

KINDS = ("holonomic", "differential-drive")


@pytest.mark.parametrize(
    ("count", "kind", "acceleration"), [*itertools.product((8, 32), KINDS, (None, 1.0)), (2, "holonomic", None)]
)
def test_crossing_circles_end_without_contact(count, kind, acceleration):
    team = circle(count, max(5.0, 0.375 * count), radius_m=0.3, kinematics=kind, acceleration_mps2=acceleration)
    world = KinematicWorld(team)
    send_across(world, team)
    assert len(until_idle(world, 120.0)) == count
    assert world.contacts == ()
    assert world.min_distance_m >= 0.6 - 1e-9


@pytest.mark.parametrize("method", ["rvo", "hrvo", "avo"])
def test_other_methods_do_not_end_in_contacts_either(method):
    team = circle(8, 5.0, radius_m=0.3)
    world = KinematicWorld(team, avoidance=method)
    send_across(world, team)
    world.advance(60.0)
    assert world.contacts == ()


def test_without_avoidance_they_meet_and_that_is_told():
    team = circle(2, 5.0, radius_m=0.3, speed_mps=1.01)
    world = KinematicWorld(team, avoidance="none")
    send_across(world, team)
    until_idle(world, 60.0)
    (contact,) = world.contacts
    assert contact.robots == ("r_0", "r_1")
    assert contact.time_s == pytest.approx(4.65, abs=0.1)
    assert contact.least_distance_m == world.min_distance_m == pytest.approx(0.0, abs=1e-9)  # between two steps


def test_balls_pass_each_other_in_space():
    corners = list(itertools.product((-4.0, 4.0), (-4.0, 4.0), (1.0, 9.0)))
    given = {"kind": "air", "kinematics": "quadcopter", "radius_m": 0.4}
    world = KinematicWorld(mission(*(robot(f"r_{k}", place, **given) for k, place in enumerate(corners))))
    for k, (x, y, z) in enumerate(corners):
        world.ports[f"r_{k}"].send([Waypoint((-x, -y, 10.0 - z))])
    assert len(until_idle(world, 120.0)) == 8
    assert world.contacts == ()


def test_drones_are_not_pushed_below_the_ground():
    given = {"kind": "air", "kinematics": "quadcopter", "radius_m": 0.4}
    team = [robot(f"r_{k}_{y:g}", (2.0 * k - 5, y, 0.1), **given) for k in range(6) for y in (-3.0, 3.0)]
    world = KinematicWorld(mission(*team))
    for one in team:
        x, y, z = one.position
        world.ports[one.id].send([Waypoint((-x, -y, z))])
    positions, _, _ = states(world, 300)
    assert positions[:, :, 2].min() >= -1e-9
    assert world.contacts == ()


def test_drones_give_way_to_those_on_the_ground():
    ground = robot("g", (-3.0, 0.0, 0.5), radius_m=0.4)
    air = robot("a", (3.0, 0.1, 0.5), kind="air", kinematics="quadcopter", radius_m=0.4)
    world = KinematicWorld(mission(ground, air))
    world.ports["g"].send([Waypoint((3.0, 0.0, 0.5))])
    world.ports["a"].send([Waypoint((-3.0, 0.1, 0.5))])
    assert len(until_idle(world, 60.0)) == 2
    assert world.contacts == ()
    assert world.distances_m["g"] == pytest.approx(6.0, rel=0.005)


@pytest.mark.parametrize(("kind", "acceleration"), list(itertools.product(KINDS, (None, 1.0))))
def test_two_exchange_places_in_a_corridor(kind, acceleration):
    half = 0.3 * 4.2 / 2  # 4 radii, and a twentieth for the margin of those that face their way
    corridor = Map(boundary=((-6, -half), (6, -half), (6, half), (-6, half)))
    given = {"radius_m": 0.3, "kinematics": kind, "acceleration_mps2": acceleration}
    team = mission(robot("west", (-4.0, 0.0), **given), robot("east", (4.0, 0.0), **given), map=corridor)
    world = KinematicWorld(team)
    send_across(world, team)
    assert len(until_idle(world, 60.0)) == 2
    assert world.contacts == ()


@pytest.mark.parametrize(("kind", "count"), list(itertools.product(KINDS, (1, 3))))
def test_goes_around_those_who_stand(kind, count):
    row = [robot(f"s_{k}", (5.0, 0.7 * (k - (count - 1) / 2)), radius_m=0.3) for k in range(count)]
    world = KinematicWorld(mission(robot("go", radius_m=0.3, kinematics=kind), *row))
    for one in row:
        world.fail(one.id)
    before = world.positions[1:]
    world.ports["go"].send([Waypoint((10.0, 0.0, 0.0))])
    while not world.idle("go") and world.time_s < 60:
        world.advance(60.0)
    assert world.positions[0, :2] == pytest.approx((10.0, 0.0), abs=0.03)
    assert (world.positions[1:] == before).all()
    assert world.contacts == ()


def test_who_has_nothing_to_do_makes_room_and_comes_back():
    wall = Map(boundary=((-6, -0.5), (6, -0.5), (6, 0.5), (1, 0.5), (1, 2), (-1, 2), (-1, 0.5), (-6, 0.5)))
    world = KinematicWorld(mission(robot("go", (-4.0, 0.0), radius_m=0.3), robot("idle", radius_m=0.3), map=wall))
    world.ports["go"].send([Waypoint((4.0, 0.0, 0.0))])
    while not world.idle("go") and world.time_s < 120:
        world.advance(120.0)
    assert world.positions[0, :2] == pytest.approx((4.0, 0.0), abs=0.03)
    assert world.contacts == ()


def test_waits_for_the_place_of_one_at_work():
    world = KinematicWorld(mission(robot("first", radius_m=0.3), robot("second", (6.0, 0.0), radius_m=0.3)))
    world.ports["first"].send([Waypoint((0.0, 0.0, 0.0), hold_s=20.0), Waypoint((0.0, 5.0, 0.0))])
    world.ports["second"].send([Waypoint((0.2, 0.0, 0.0))])
    done = until_idle(world, 60.0)
    assert done["second"] > 20.0
    assert world.distances_m["second"] == pytest.approx(5.8, rel=0.05)  # it stands while it waits
    assert world.contacts == ()


def test_without_a_radius_nobody_is_avoided():
    team = circle(6, 5.0)
    world = KinematicWorld(team)
    send_across(world, team)
    done = until_idle(world, 60.0)
    assert list(done.values()) == pytest.approx([10.0] * 6)
    assert world.contacts == ()
    assert world.min_distance_m == pytest.approx(0.0, abs=1e-9)


def test_two_of_different_priority_share_unequally():
    given = {"radius_m": 0.3, "avoidance_priority": 0.0}
    firm = robot("firm", (-5.0, 0.0), radius_m=0.3, avoidance_priority=1.0)
    team = mission(firm, robot("mild", (5.0, 0.1), **given))
    world = KinematicWorld(team)
    send_across(world, team)
    until_idle(world, 60.0)
    assert world.distances_m["firm"] < world.distances_m["mild"]
    assert world.contacts == ()


def random_orders(world, random, steps, side):
    """Lets robots go to random places, with new orders under way; yields at each step."""
    for step in range(steps):
        for port in world.ports.values():
            if step % 20 == 0 and random.random() < 0.2:
                places = random.uniform(0.7, side - 0.7, (2, 2))
                port.send([Waypoint((x, y, 0.0), hold_s=random.choice([0.0, 1.0])) for x, y in places])
        world.step()
        yield step


@pytest.mark.parametrize("seed", range(4))
def test_random_crowds_touch_neither_each_other_nor_walls(seed):
    random = np.random.default_rng(seed)
    around = Map(boundary=((0, 0), (8, 0), (8, 8), (0, 8)), zones=(Zone(polygon=((3, 3), (5, 3.5), (4, 5))),))
    places = [(x, y) for x in (1.0, 2.0, 6.0, 7.0) for y in (1.0, 4.0, 7.0)]
    robots = [
        robot(
            f"r_{k}",
            place,
            radius_m=float(random.uniform(0.1, 0.4)),
            kinematics=str(random.choice(KINDS)),
            acceleration_mps2=[None, float(random.uniform(0.3, 2.0))][k % 2],
            speed_mps=float(random.uniform(0.2, 1.5)),
        )
        for k, place in enumerate(places)
    ]
    team = mission(*robots, map=around)
    world, chart = KinematicWorld(team, seed=seed), World.of(team)
    deepest = 0.0
    for step in random_orders(world, random, 800, 8.0):
        if step % 10 == 0:
            clear = chart.clearance(world.positions[:, :2], "ground")
            deepest = max(deepest, max(one.radius_m - c for one, c in zip(robots, clear, strict=True)))
    assert world.contacts == ()
    assert deepest <= 1e-3


@pytest.mark.parametrize("name", ["floor", "yard"])
def test_all_get_along_shortest_paths_of_a_shipped_map(name):
    team, random = muster.load(name), np.random.default_rng(0)
    robot_paths, world, planned = RobotPaths.of(team), KinematicWorld(team), {}
    for one in team.robots:
        places = [one.position, *(team.tasks[k].position for k in random.choice(len(team.tasks), 3, replace=False))]
        found = [robot_paths.path(body_of(one), a, b) for a, b in itertools.pairwise(places)]
        paths = [path for path in found if isinstance(path, Path)]
        if len(paths) == len(found):
            corners = [point for path in paths for point in path.points[1:]]
            world.ports[one.id].send([Waypoint((*map(float, point), 0.0)[:3]) for point in corners])
            planned[one.id] = sum(path.length_m for path in paths)
    while not all(map(world.idle, planned)) and world.time_s < 600:
        world.advance(600.0)
    assert all(map(world.idle, planned))
    assert len(planned) >= 2
    assert world.contacts == ()
    assert {k: world.distances_m[k] for k in planned} == pytest.approx(planned, rel=0.1)
