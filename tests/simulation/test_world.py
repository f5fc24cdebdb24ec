"""What happens to robots of the kinematic world, noise, determinism, and what is wrong with what it is given."""

import numpy as np
import pytest
from tests.simulation.scenes import circle, mission, robot, send_across, states, until_idle

from muster.mission.errors import ParameterError
from muster.motion.port import RobotPort, Waypoint
from muster.simulation import KinematicWorld, Noise


def run(seed, **given):
    team = circle(12, 5.0, radius_m=0.3)
    world = KinematicWorld(team, seed=seed, **given)
    send_across(world, team)
    return states(world, 300)[0]


def test_the_same_seed_gives_the_same_run():
    noise = Noise(velocity=0.1, slip=0.05)
    assert (run(3, noise=noise) == run(3, noise=noise)).all()
    assert (run(3, noise=noise) != run(4, noise=noise)).any()


def test_advancing_at_once_is_stepping():
    team = circle(8, 5.0, radius_m=0.3)
    at_once, by_steps = KinematicWorld(team), KinematicWorld(team)
    for world in (at_once, by_steps):
        send_across(world, team)
    found = [one for _ in range(100) for one in at_once.advance(40.0)]
    stepped = [one for _ in range(400) for one in by_steps.step()]
    assert found == stepped
    assert (at_once.positions == by_steps.positions).all()


def test_a_port_is_a_robot_port():
    port: RobotPort = KinematicWorld(mission(robot())).ports["r"]
    assert port.robot == "r"
    said = port.telemetry()
    assert (said.time_s, said.order, said.passed, said.odometry_m) == (0.0, 0, 0, 0.0)


def test_telemetry_is_of_every_step():
    world = KinematicWorld(mission(robot()))
    world.ports["r"].send([Waypoint((9.0, 0.0, 0.0))])
    times = []
    for _ in range(5):
        world.step()
        times.append(world.ports["r"].telemetry().time_s)
    assert times == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5])
    assert world.ports["r"].telemetry().velocity == pytest.approx((1.0, 0.0, 0.0))


@pytest.mark.parametrize("arrival_m", [0.25, 0.5, 1.0])
@pytest.mark.parametrize("law", ["thesis", "profile"])
def test_undisturbed_robots_stop_at_the_arrival_distance_by_the_law_of_the_thesis_alone(law, arrival_m):
    team = mission(robot(kinematics="differential-drive", yaw_rate_radps=1.8))
    world = KinematicWorld(team, arrival_m=arrival_m, law=law)
    world.ports["r"].send([Waypoint((5.0, 0.0, 0.0))])
    assert until_idle(world, 20)
    left = 5.0 - world.positions[0, 0]
    assert left == pytest.approx(arrival_m if law == "thesis" else 0.0, abs=0.11 if law == "thesis" else 0.001)
    assert left <= arrival_m + 1e-9


def test_one_that_fails_stops_for_good_and_says_nothing():
    world = KinematicWorld(mission(robot(), robot("other", (0.0, 3.0))))
    port = world.ports["r"]
    port.send([Waypoint((9.0, 0.0, 0.0))])
    world.advance(2.0)
    world.fail("r")
    world.advance(4.0)
    assert port.send([Waypoint((0.0, 0.0, 0.0))]) == 2
    world.advance(8.0)
    assert world.positions[0] == pytest.approx((2.0, 0.0, 0.0))
    assert (port.telemetry().time_s, port.telemetry().order) == (pytest.approx(2.0), 1)
    world.recover("r")
    port.send([Waypoint((0.0, 0.0, 0.0))])
    world.advance(12.0)
    assert port.telemetry().position == pytest.approx((0.0, 0.0, 0.0), abs=0.01)
    assert port.telemetry().order == 3


def test_a_silent_one_goes_on():
    world = KinematicWorld(mission(robot()))
    port = world.ports["r"]
    port.send([Waypoint((9.0, 0.0, 0.0))])
    world.advance(2.0)
    world.silence("r")
    world.advance(5.0)
    assert port.telemetry().time_s == pytest.approx(2.0)
    assert world.positions[0, 0] == pytest.approx(5.0)
    world.unsilence("r")
    assert port.telemetry().time_s == pytest.approx(5.0)
    assert port.telemetry().odometry_m == pytest.approx(5.0)


def test_a_slow_one_takes_longer():
    world = KinematicWorld(mission(robot()))
    world.slow("r", 0.5)
    world.ports["r"].send([Waypoint((5.0, 0.0, 0.0))])
    assert until_idle(world, 60.0)["r"] == pytest.approx(10.0)


def test_one_joins_under_way_and_is_avoided():
    team = mission(robot("a", (-5.0, 0.0), radius_m=0.3))
    world = KinematicWorld(team)
    world.ports["a"].send([Waypoint((5.0, 0.0, 0.0))])
    world.advance(2.0)
    port = world.join(robot("b", (5.0, 0.0), radius_m=0.3))
    port.send([Waypoint((-5.0, 0.0, 0.0))])
    assert list(world.ports) == ["a", "b"]
    assert len(until_idle(world, 60.0)) == 2
    assert world.contacts == ()


def test_odometry_counts_what_slips():
    world = KinematicWorld(mission(robot()), noise=Noise(slip=0.2))
    world.ports["r"].send([Waypoint((50.0, 0.0, 0.0))])
    until_idle(world, 200.0)
    assert world.distances_m["r"] == pytest.approx(50.0, abs=0.03)
    assert world.ports["r"].telemetry().odometry_m == pytest.approx(50.0 / 0.9, rel=0.02)


def test_noise_on_velocity_costs_time_alone():
    world = KinematicWorld(mission(robot()), noise=Noise(velocity=0.2))
    world.ports["r"].send([Waypoint((50.0, 0.0, 0.0))])
    assert until_idle(world, 200.0)["r"] == pytest.approx(50 / (1 - 0.2 * np.sqrt(2 / np.pi)), rel=0.03)
    assert world.distances_m["r"] == pytest.approx(50.0, abs=0.03)


def test_noise_of_telemetry_is_the_same_whenever_it_is_asked():
    world = KinematicWorld(mission(robot()), noise=Noise(position_m=0.1, heading_rad=0.05))
    places, port = [], world.ports["r"]
    for _ in range(400):
        world.step()
        assert port.telemetry() == port.telemetry()
        places.append(port.telemetry().position)
    assert np.std(places, axis=0) == pytest.approx([0.1, 0.1, 0.0], rel=0.15)
    assert (world.positions == 0).all()


def test_the_observer_sees_every_step_or_every_so_often():
    seen, seldom = [], []
    for times, every in ((seen, 0.0), (seldom, 0.5)):
        world = KinematicWorld(mission(robot()), observer=lambda t, p, h, v, to=times: to.append(t), observe_s=every)
        world.ports["r"].send([Waypoint((0.73, 0.0, 0.0))])
        while world.time_s < 1.95:
            world.advance(2.0)
    assert seen == pytest.approx(np.arange(21) * 0.1)
    assert seldom == pytest.approx(np.arange(5) * 0.5)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"dt_s": 0.0}, "dt_s: 0.0; expected a finite number above 0"),
        ({"avoidance": "orka"}, "avoidance: orka; expected auto, orca, rvo, hrvo, avo, none"),
        ({"seed": -1}, "seed: -1; expected 0 to"),
    ],
)
def test_what_is_out_of_range_is_told(wrong, message):
    with pytest.raises(ParameterError, match=message):
        KinematicWorld(mission(robot()), **wrong)


def test_rvo_is_for_the_plane():
    with pytest.raises(ParameterError, match="avoidance: rvo; expected orca or none"):
        KinematicWorld(mission(robot(position=(0.0, 0.0, 1.0))), avoidance="rvo")


def test_wrong_robots_and_way_points_are_told():
    world = KinematicWorld(mission(robot()))
    with pytest.raises(ParameterError, match="robot s: not in the world"):
        world.fail("s")
    with pytest.raises(ParameterError, match="it is in the world"):
        world.join(robot())
    with pytest.raises(ParameterError, match="expected 2 coordinates"):
        world.join(robot("s", (0.0, 0.0, 0.0)))
    with pytest.raises(ParameterError, match="hold_s: -1"):
        world.ports["r"].send([Waypoint((0.0, 0.0, 0.0), hold_s=-1)])
    with pytest.raises(ParameterError, match="expected three finite numbers"):
        world.ports["r"].send([Waypoint((float("nan"), 0.0, 0.0))])
    with pytest.raises(ParameterError, match="factor: 2"):
        world.slow("r", 2)


def test_wrong_noise_is_told():
    with pytest.raises(ParameterError, match=r"slip: 1.5; expected a finite number, at least 0 and at most 1"):
        Noise(slip=1.5)
    with pytest.raises(ParameterError, match="velocity: -1; expected a finite number, at least 0"):
        Noise(velocity=-1)
