"""Robots that steer by their estimates: odometry leads them astray, sensors bring them back; true poses are as ever."""

import math
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

import muster
from muster import Camera, Landmark, Mission, Robot, Tag
from muster.mission.errors import ParameterError
from muster.motion.port import Waypoint
from muster.running.localisation import SENSORS, sensors_of
from muster.running.run_request import RunRequest
from muster.running.state_estimation import with_state_estimation
from muster.running.worlds import world_named
from muster.simulation import KinematicWorld, Noise
from muster.simulation.pose_sensors import Readings

WORLDS = [
    "kinematic",
    pytest.param("physics", marks=pytest.mark.skipif(find_spec("mujoco") is None, reason="needs the extra `physics`")),
]
SLIPS = Noise(slip=0.1, odometry=0.05)
SQUARE = [(2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)]
POSTS = tuple(Landmark(position=place) for place in ((-0.5, -0.5), (2.5, -0.5), (2.5, 2.5), (-0.5, 2.5), (1.0, 1.0)))
TAGS = tuple(
    Tag(id=number, position=(x, y), size_m=0.2)
    for number, (x, y) in enumerate((x, y) for x in (-1.0, 0.0, 1.0, 2.0, 3.0) for y in (-1.0, 0.0, 1.0, 2.0, 3.0))
)


def rover(**more):
    body = {"position": (0.0, 0.0), "kinematics": "differential-drive", "radius_m": 0.15, "speed_mps": 0.3}
    return Robot(id="r", yaw_rate_radps=1.8, **(body | more))


def off_at_the_end(world, localise, *, noise=SLIPS, pose=None, robot=None, seed=1):
    """How far a robot is from the last corner of a square when it takes itself to be there; and its error."""
    mission = Mission(robots=(robot or rover(),), tasks=(), landmarks=POSTS, tags=TAGS)
    bodies = world_named(world)(mission, seed=seed, noise=noise)
    robots = with_state_estimation(bodies, mission, pose=pose, localise=localise, seed=seed)
    height = mission.robots[0].position[2:] or (0.0,)
    robots.ports["r"].send([Waypoint((*corner, *height)) for corner in SQUARE])
    while not bodies.idle("r"):
        assert bodies.time_s < 200
        robots.advance(bodies.time_s + 1.0)
    truth = bodies.positions[0]
    return math.dist(truth[:2], SQUARE[-1]), math.dist(truth, robots.ports["r"].telemetry().position)


@pytest.mark.long
@pytest.mark.parametrize("world", WORLDS)
def test_odometry_leads_astray_and_lasers_back(world):
    off, _ = off_at_the_end(world, None)
    assert off > 0.05
    for localise in (("odometry", "lasers"), ("odometry", "motion-capture"), ("odometry", "rtk"), "motion-capture"):
        back, error = off_at_the_end(world, localise)
        assert back < (0.08 if "rtk" in localise else 0.02)
        assert error < (0.08 if "rtk" in localise else 0.03)


@pytest.mark.parametrize("world", WORLDS)
def test_tags_bring_a_drone_back(world):
    drone = Robot(
        id="r",
        position=(0.0, 0.0),
        kind="air",
        kinematics="quadcopter",
        radius_m=0.3,
        camera=Camera(fov_deg=90, tilt_deg=90),
    )
    astray, _ = off_at_the_end(world, "odometry", robot=drone)
    back, _ = off_at_the_end(world, "odometry,tags", robot=drone)
    assert astray > 0.1
    assert back < 0.05


@pytest.mark.parametrize("world", WORLDS)
def test_who_steers_by_its_true_pose_goes_where_it_is_sent(world):
    """Its telemetry has the estimate all the same."""
    off, error = off_at_the_end(world, "odometry", pose="true")
    assert off < 0.021
    assert error > 0.1


@pytest.mark.parametrize("world", WORLDS)
def test_true_poses_are_steered_by_as_ever(world):
    """Not a bit of the way differs from that of the world alone, with noise too; nor where no sensor errs."""
    mission = muster.load("6T-2R")
    for noise, how in ((SLIPS, {"pose": "true"}), (Noise(), {})):
        ways = []
        for estimated in (False, True):
            bodies = world_named(world)(mission, seed=3, noise=noise)
            robots = with_state_estimation(bodies, mission, **how) if estimated else bodies
            for name, port in robots.ports.items():
                port.send([Waypoint((1.0, float(name == "r_0"), 0.0)), Waypoint((2.0, 1.0, 0.0))])
            robots.advance(5.0)
            ways.append((bodies.positions, bodies.headings))
        assert np.array_equal(ways[0][0], ways[1][0])
        assert np.array_equal(ways[0][1], ways[1][1])


def test_an_estimate_that_is_the_truth_changes_nothing():
    """In the kinematic world odometry without noise is exact, to rounding."""
    off, error = off_at_the_end("kinematic", "odometry", noise=Noise())
    assert off < 1e-3
    assert error < 1e-9


def test_by_default_robots_steer_by_estimates_where_noise_makes_them_err():
    mission = muster.load("6T-2R")
    for noise, errs in ((Noise(), False), (Noise(velocity=0.1), False), (Noise(slip=0.1), True), (SLIPS, True)):
        world = KinematicWorld(mission, noise=noise)
        assert (with_state_estimation(world, mission) is not world) == errs


def test_a_misaligned_marker_bends_the_way():
    """A heading that is wrong by a constant angle makes a spiral to the goal, longer by the cosine of it."""
    straight = {}
    for turn in (0.0, 35.0):
        mission = Mission(robots=(rover(radius_m=0.0),), tasks=())
        bodies = KinematicWorld(mission)
        how = {"motion-capture": {"robot": "r", "turn_deg": turn, "position_m": 0, "heading_rad": 0}}
        robots = with_state_estimation(bodies, mission, localise=how)
        robots.ports["r"].send([Waypoint((4.0, 0.0, 0.0))])
        while not bodies.idle("r"):
            robots.advance(bodies.time_s + 1.0)
        straight[turn] = bodies.distances_m["r"]
        assert math.dist(bodies.positions[0], (4.0, 0.0, 0.0)) < 0.021
    assert straight[0.0] == pytest.approx(4.0, abs=1e-3)
    assert straight[35.0] == pytest.approx(4.0 / math.cos(math.radians(35.0)), rel=0.04)


def test_readings_drop_out_for_the_share_of_time():
    readings = Readings(10.0, 0.3, 1.0, np.random.default_rng(1))
    came = [readings.due(step / 10) for step in range(20_000)]
    assert np.mean(came) == pytest.approx(0.7, abs=0.03)
    ends = np.flatnonzero(np.diff(np.array(came).astype(int)) == 1).size
    assert (1 - np.mean(came)) * 2000 / ends == pytest.approx(1.0, rel=0.15)  # seconds a drop-out


def test_readings_come_at_their_rate():
    readings = Readings(2.0, 0.0, 1.0, np.random.default_rng(1))
    assert [step for step in range(21) if readings.due(step / 10)] == [0, 5, 10, 15, 20]


def test_python_takes_sensors_as_names_or_with_parameters():
    assert (
        sensors_of("odometry,lasers")
        == sensors_of(["odometry", "lasers"])
        == sensors_of({"odometry": {}, "lasers": {}})
    )
    assert sensors_of({"motion-capture": {"turn_deg": "35"}}) == sensors_of({"motion-capture": {"turn_deg": 35.0}})
    assert sensors_of(list(SENSORS)) == SENSORS


@pytest.mark.parametrize(
    ("localise", "wrong"),
    [
        ("odomety", "localise: \"odomety\"; expected odometry, inertial, .*; did you mean 'odometry'"),
        ("lasers", "localise: lasers; expected odometry among them, or motion-capture alone"),
        ({"odometry": {"x": 1}}, "localise: odometry: x; expected none"),
        (
            {"motion-capture": {"turn": 1}},
            "localise: motion-capture: turn; expected rate_hz, .*mean 'turn_deg'",
        ),
        ({"motion-capture": {"turn_deg": True}}, "localise: motion-capture: turn_deg: true; expected a number"),
        ({"motion-capture": {"drop_out": 1}}, "drop_out: 1.0; expected a share, 0 to below 1"),
        ({"motion-capture": {"rate_hz": 0}}, "rate_hz: 0.0; expected a finite number above 0"),
        ({"motion-capture": 3}, "localise: motion-capture: 3; expected a mapping"),
        ({"motion-capture": {"robot": "r_9"}}, "robot: r_9; expected one of the mission"),
        ("odometry,tags", "expected a mission with tags, and a robot with a camera"),
        ("odometry,lasers", "expected a mission with known landmarks"),
    ],
)
def test_sensors_that_are_none(localise, wrong):
    mission = muster.load("6T-2R")
    with pytest.raises(ParameterError, match=wrong):
        with_state_estimation(KinematicWorld(mission), mission, localise=localise)


def test_a_pose_that_is_none():
    mission = muster.load("6T-2R")
    with pytest.raises(ParameterError, match='pose: "truth"; expected true, estimate'):
        with_state_estimation(KinematicWorld(mission), mission, pose="truth")


@pytest.mark.long
def test_command_python_and_server_settings_mean_the_same():
    """The command's texts, Python's numbers and a server's JSON name the same sensors."""
    texts = {"odometry": {}, "motion-capture": {"robot": "r_1", "turn_deg": "35"}}
    numbers = {"odometry": {}, "motion-capture": {"robot": "r_1", "turn_deg": 35}}
    assert sensors_of(texts) == sensors_of(numbers)
    RunRequest.from_settings("kinematic", {"pose": "estimate", "localise": numbers})
    with pytest.raises(ParameterError, match="expected odometry among them"):
        RunRequest.from_settings("kinematic", {"localise": {"gps": {}}})
    mission = muster.load("6T-2R")
    plan = muster.solve(mission, iterations=100)
    one, other = (muster.simulate(mission, plan, localise=how) for how in (texts, numbers))
    assert replace(one) == other
    assert "steered by their estimated poses" in one.remarks[0]
