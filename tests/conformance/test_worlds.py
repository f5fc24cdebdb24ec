"""What every world keeps, whatever moves the robots in it."""

import json
import math
from importlib.util import find_spec

import numpy as np
import pytest
from tests.simulation.scenes import circle, mission, robot, send_across, states, until_idle

from muster.mission.errors import ParameterError
from muster.motion.port import RobotPort, Waypoint
from muster.simulation import KinematicWorld, Noise, SimulatedWorld

without_physics = pytest.mark.skipif(find_spec("mujoco") is None, reason="the extra `physics` is not installed")
KINDS = {
    "holonomic": {"radius_m": 0.3, "acceleration_mps2": 2.0},
    "waffle": {"kinematics": "differential-drive", "radius_m": 0.3, "speed_mps": 0.26, "yaw_rate_radps": 1.82},
    "hexacopter": {"kind": "air", "kinematics": "hexacopter", "radius_m": 0.4, "speed_mps": 0.8, "yaw_rate_radps": 2.5},
    "drone": {"kind": "air", "kinematics": "quadcopter", "radius_m": 0.7, "speed_mps": 0.5, "yaw_rate_radps": 2.5},
}
every_kind = pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)


def share_of_swings(kind):
    """The published velocity loop of hexacopters swings over what is commanded."""
    return 0.08 if kind.get("kinematics") == "hexacopter" else 0.02


@pytest.fixture(params=["kinematic", pytest.param("physics", marks=without_physics)])
def world_of(request):
    if request.param == "kinematic":
        return KinematicWorld
    from muster_physics import PhysicsWorld

    return PhysicsWorld


@pytest.mark.long(keep=3)
@every_kind
def test_robots_reach_way_points_turn_and_hold(world_of, kind):
    world: SimulatedWorld = world_of(mission(robot(**kind)))
    port: RobotPort = world.ports["r"]
    way = [Waypoint((1.0, 0.5, 0.0), heading=2.0, hold_s=2.0, label="work"), Waypoint((0.0, 1.0, 0.0), label="end")]
    port.send(way)
    begun = None
    while not (passed := world.step()):
        if begun is None and math.dist(world.positions[0], way[0].position) < 0.02:
            begun = world.time_s
        assert world.time_s < 20
    assert [one.label for one in passed] == ["work"]
    assert world.time_s - begun >= 1.9
    assert math.dist(world.positions[0], way[0].position) < 0.02
    assert world.headings[0] == pytest.approx(2.0, abs=0.02)
    assert not world.idle("r")
    (last,) = world.advance(60.0)
    assert (last.label, last.idle, last.order, last.passed) == ("end", True, 1, 2)
    assert world.idle("r")
    world.advance(world.time_s + 3)
    assert math.dist(world.positions[0], way[1].position) < 0.02
    assert world.distances_m["r"] == pytest.approx(2 * math.hypot(1, 0.5), rel=share_of_swings(kind))
    said = port.telemetry()
    assert said.odometry_m == pytest.approx(world.distances_m["r"], rel=0.01)  # wheels count how far they roll
    assert said.velocity == (0.0, 0.0, 0.0)


@pytest.mark.long(keep=4)
@every_kind
def test_robots_go_at_their_top_speed(world_of, kind):
    world = world_of(mission(robot(**kind)))
    world.ports["r"].send([Waypoint((9.0, 0.0, 0.0))])
    _, _, velocities = states(world, 60)
    speeds = np.linalg.norm(velocities[:, 0], axis=1)
    top = kind.get("speed_mps", 1.0)
    assert speeds[30:].mean() == pytest.approx(top, rel=0.02)
    assert speeds.max() <= (1 + share_of_swings(kind)) * top


def test_robots_swap_without_contact(world_of):
    team = circle(5, 2.0, **KINDS["waffle"])
    world = world_of(team)
    send_across(world, team)
    assert len(until_idle(world, 120.0)) == 5
    assert world.contacts == ()
    assert world.min_distance_m >= 0.6


def test_the_same_seed_gives_the_same_run(world_of):
    def run(seed):
        team = circle(3, 1.5, **KINDS["waffle"])
        world = world_of(team, seed=seed, noise=Noise(velocity=0.1, slip=0.05))
        send_across(world, team)
        return states(world, 60)[0]

    assert (run(3) == run(3)).all()
    assert (run(3) != run(4)).any()


def test_advancing_at_once_is_stepping(world_of):
    team = circle(3, 1.0, radius_m=0.2)
    at_once, by_steps = world_of(team), world_of(team)
    for world in (at_once, by_steps):
        send_across(world, team)
    found = [one for _ in range(10) for one in at_once.advance(8.0)]
    stepped = [one for _ in range(80) for one in by_steps.step()]
    assert found == stepped
    assert len(found) == 3
    assert (at_once.positions == by_steps.positions).all()


def test_one_that_fails_stops_and_one_that_is_silent_goes_on(world_of):
    world = world_of(mission(robot("a", radius_m=0.3), robot("b", (0.0, 3.0), radius_m=0.3)))
    for name, y in (("a", 0.0), ("b", 3.0)):
        world.ports[name].send([Waypoint((9.0, y, 0.0))])
    world.advance(2.0)
    world.fail("a")
    world.silence("b")
    world.advance(4.0)
    assert world.positions[0, 0] < 2.6
    assert world.positions[1, 0] > 3.5
    assert all(port.telemetry().time_s == pytest.approx(2.0) for port in world.ports.values())
    stood = world.positions[0]
    world.recover("a")
    world.unsilence("b")
    world.advance(6.0)
    assert math.dist(world.positions[0], stood) < 0.02
    world.ports["a"].send([Waypoint((0.0, 0.0, 0.0))])
    world.slow("a", 0.5)
    _, _, velocities = states(world, 20)
    assert np.linalg.norm(velocities[-1, 0]) == pytest.approx(0.5, rel=0.02)


def test_one_joins_under_way_and_is_avoided(world_of):
    world = world_of(mission(robot("a", (-3.0, 0.0), radius_m=0.3)))
    world.ports["a"].send([Waypoint((3.0, 0.0, 0.0))])
    world.advance(1.0)
    before = world.positions[0]
    port = world.join(robot("b", (3.0, 0.0), radius_m=0.3))
    assert list(world.ports) == ["a", "b"]
    assert (world.positions[0] == before).all()
    port.send([Waypoint((-3.0, 0.0, 0.0))])
    assert len(until_idle(world, 60.0)) == 2
    assert world.contacts == ()


def test_odometry_counts_what_slips(world_of):
    world = world_of(mission(robot()), noise=Noise(slip=0.2))
    world.ports["r"].send([Waypoint((20.0, 0.0, 0.0))])
    until_idle(world, 200.0)
    assert world.distances_m["r"] == pytest.approx(20.0, abs=0.05)
    assert world.ports["r"].telemetry().odometry_m == pytest.approx(20.0 / 0.9, rel=0.03)


def test_the_observer_sees_every_step(world_of):
    times = []
    world = world_of(mission(robot()), observer=lambda now, places, headings, velocities: times.append(now))
    world.ports["r"].send([Waypoint((0.73, 0.0, 0.0))])
    while world.time_s < 1.95:
        world.advance(2.0)
    assert times == pytest.approx(np.arange(21) * 0.1)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [({"dt_s": 0.0}, "dt_s: 0.0; expected"), ({"avoidance": "orka"}, "avoidance: orka"), ({"seed": -1}, "seed: -1")],
)
def test_what_is_out_of_range_is_told(world_of, wrong, message):
    with pytest.raises(ParameterError, match=message):
        world_of(mission(robot()), **wrong)


@every_kind
def test_a_world_made_of_a_snapshot_goes_on_as_the_one_of_which_it_is(world_of, kind):
    team = mission(robot("a", **kind), robot("b", position=(0.0, 5.0), **kind), robot("c", position=(0.0, 9.0), **kind))
    world = world_of(team)
    for k, port in enumerate(world.ports.values()):
        port.send([Waypoint((6.0, 5.0 * k, 0.0), label="there")])
    world.advance(2.0)
    world.fail("b")
    world.silence("c")
    snapshot = json.loads(json.dumps(world.snapshot()))
    again = world_of(team, snapshot=snapshot)
    assert again.time_s == pytest.approx(world.time_s)
    for name in ("positions", "headings", "velocities", "frames", "axes"):
        np.testing.assert_allclose(getattr(again, name), getattr(world, name), atol=1e-9, err_msg=name)
    assert again.distances_m == world.distances_m
    assert again.min_distance_m == world.min_distance_m
    for one in (world, again):
        one.ports["a"].send([Waypoint((6.0, 0.0, 0.0))])
        one.ports["b"].send([Waypoint((6.0, 5.0, 0.0))])  # it is out of order
        one.advance(5.0)
    near_m = 1e-9 if world_of is KinematicWorld else 0.3  # forces, and what bodies would still go on, begin anew
    np.testing.assert_allclose(again.positions[:2], world.positions[:2], atol=near_m)
    assert again.ports["c"].telemetry().time_s < again.time_s
    again.recover("b")
    again.ports["b"].send([Waypoint((6.0, 5.0, 0.0))])
    before = again.positions[1, 0]
    again.advance(7.0)
    assert again.positions[1, 0] > before + 0.1


def test_batteries_and_contacts_are_in_a_snapshot(world_of):
    team = mission(*(robot(f"r_{k}", position=(float(k), 0.0), radius_m=0.3, work_capacity=100.0) for k in range(2)))
    world = world_of(team, batteries={"all": 0.5}, avoidance="none")
    world.ports["r_0"].send([Waypoint((3.0, 0.0, 0.0))])
    world.advance(4.0)
    assert len(world.contacts) == 1
    again = world_of(team, avoidance="none", snapshot=json.loads(json.dumps(world.snapshot())))
    charges = [[one.ports[name].telemetry().charge for name in one.ports] for one in (world, again)]
    assert charges[0] == pytest.approx(charges[1])
    assert charges[0][0] < 0.5
    assert again.contacts == world.contacts
    again.advance(5.0)
    assert len(again.contacts) == 1
