"""Robots heard through filters in the worlds: nearer to the truth, by as much as filters say; and all is done so."""

import math
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

import muster
from muster import Event, Robot, Simulation, Task
from muster.execution import Executor
from muster.mission.plan import Plan, Route
from muster.motion.frames import wrapped
from muster.motion.port import Waypoint
from muster.perception.joint_estimate import BIAS
from muster.running.localisation import Localisation, sensors_of
from muster.running.reckoning_noise import LEAST, reckoning_errors
from muster.running.simulation import carry_out
from muster.running.state_estimation import EstimatedWorld, LocalisedPorts, with_state_estimation
from muster.running.worlds import world_named
from muster.simulation import KinematicWorld, Noise

NOISE = Noise(position_m=0.1, heading_rad=0.05, slip=0.05)
needs_physics = pytest.mark.skipif(find_spec("mujoco") is None, reason="needs the extra `physics`")
WORLDS = ["kinematic", pytest.param("physics", marks=needs_physics)]


class Watched(EstimatedWorld):
    """Keeps by how much robots are off at each step, as they say and fused, and what their filters make of it."""

    def __init__(self, world, mission):
        self.places, self.headings, self.innovations = [], [], {name: [] for name in world.ports}
        self.bodies = world
        localisation = Localisation(sensors_of(("odometry", "inertial")), mission, 0, told=True)
        self.freedom = [0, 1, 2, 3] if mission.dimensions == 3 else [0, 1, 3]
        super().__init__(world, LocalisedPorts(world, localisation), steered=False)

    def _listen(self):
        super()._listen()
        said = [port.telemetry() for port in self.bodies.ports.values()]
        fused = [port.telemetry() for port in self.ports.values()]
        truth = self.bodies.positions
        self.places.append([np.array([one.position for one in told]) - truth for told in (said, fused)])
        facing = self.bodies.headings
        self.headings.append([wrapped(np.array([one.heading for one in told]) - facing) for told in (said, fused)])
        for name, port in self.ports.items():
            fix = port.estimate.told_poses.fix
            if fix is not None:
                off, spread = fix.innovation[self.freedom], fix.innovation_covariance[np.ix_(*[self.freedom] * 2)]
                self.innovations[name].append(float(off @ np.linalg.solve(spread, off)))


def watched(name, world, noise=NOISE, seed=1):
    """A plan of a shipped mission carried out to the end."""
    mission = muster.load(name)
    hearing = Watched(bodies := world_named(world)(mission, seed=seed, noise=noise), mission)
    executor = Executor(mission, muster.solve(mission, iterations=100), hearing.ports)
    executor.tick(0.0)
    while not executor.done:
        hearing.advance(bodies.time_s + 0.5)
        executor.tick(bodies.time_s)
    assert executor.lost() == {}
    return mission, hearing


@pytest.mark.long
@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize("name", ["6T-2R", "auction-1"])
def test_fused_poses_are_nearer_to_the_truth_by_more_than_half(name, world):
    """Each robot's, place and heading; and filters know by how much they err: innovations are chi-square."""
    mission, hearing = watched(name, world)
    said, fused = np.sqrt((np.array(hearing.places) ** 2).sum(axis=3).mean(axis=0))
    assert said == pytest.approx(0.1 * math.sqrt(mission.dimensions), rel=0.1)
    assert (fused < 0.35 * said).all()
    said, fused = np.sqrt((np.array(hearing.headings) ** 2).mean(axis=0))
    assert said == pytest.approx(0.05, rel=0.15)
    assert (fused < 0.3 * said).all()
    for nis in hearing.innovations.values():
        freedom = len(hearing.freedom) * len(nis)
        from scipy.stats import chi2  # takes half a second to import

        low, high = chi2.ppf([0.0005, 0.9995], freedom)
        assert low < sum(nis) < high


@pytest.mark.long
def test_filters_learn_the_bias_of_gyros():
    noise = replace(NOISE, gyro_bias_radps=0.02, gyro_radps=0.005)
    _, hearing = watched("11T-2R", "kinematic", noise)
    for name, port in hearing.ports.items():
        bias = port.estimate.estimate.mean[BIAS]
        assert bias == pytest.approx(hearing.bodies.ports[name]._bias_radps, abs=0.005)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("name", ["6T-2R-actions", "11T-2R", "market-rescue-arena", "auction-1"])
def test_all_tasks_are_done_where_robots_err(name):
    all_are_done_by_robots_that_err(name, "kinematic")


@pytest.mark.long
@needs_physics
@pytest.mark.parametrize("name", ["6T-2R-actions", "auction-1"])
def test_all_tasks_are_done_where_bodies_err(name):
    all_are_done_by_robots_that_err(name, "physics")


def all_are_done_by_robots_that_err(name, world):
    mission = muster.load(name)
    noise = replace(NOISE, velocity=0.05, odometry=0.02, gyro_radps=0.01, gyro_bias_radps=0.01, accelerometer_mps2=0.1)
    report = carry_out(mission, muster.solve(mission, iterations=100), world=world, noise=noise, seed=2)
    assert (len(report.tasks_done), report.contacts) == (len(mission.tasks), 0)


def test_usage_is_what_wheels_count_not_the_way_of_fused_poses():
    mission = muster.load("6T-2R")
    plan = muster.solve(mission, iterations=100)
    exact, err = (
        carry_out(mission, plan, noise=noise, seed=1, pose="true")
        for noise in (Noise(slip=0.05), Noise(slip=0.05, position_m=0.1))
    )
    for one, other in zip(exact.robots, err.robots, strict=True):
        assert other.usage_flown == pytest.approx(one.usage_flown, rel=0.005)
        assert other.usage_flown > 1.015 * other.usage_planned


@pytest.mark.parametrize("noise", [Noise(), Noise(slip=0.1, odometry=0.1, gyro_radps=0.1), Noise(attitude_rad=0.1)])
def test_where_robots_steer_by_exact_poses_nothing_is_filtered(noise):
    world = KinematicWorld(muster.load("6T-2R"), noise=noise)
    assert with_state_estimation(world, muster.load("6T-2R"), pose="true") is world


def test_who_says_where_it_is_says_the_fused_place():
    mission = muster.load("6T-2R")
    simulation = Simulation(mission, muster.solve(mission, iterations=100), noise=NOISE, seed=1)
    simulation.advance(10.0)
    truth = dict(zip(simulation._world.ports, simulation._world.positions, strict=True))
    for name, place in simulation.positions.items():
        raw = simulation._world.ports[name].telemetry().position
        assert place != raw
        assert math.dist(place, truth[name]) < 0.1


@pytest.mark.long
def test_who_joins_is_fused_too():
    mission = replace(muster.load("6T-2R"), events=())
    plan = Plan(routes=(Route("r_0", tuple(task.id for task in mission.tasks)), Route("r_1", ())))
    simulation = Simulation(mission, plan, noise=NOISE)
    late = Robot(id="late", position=(0.0, 0.0), kinematics="differential-drive", radius_m=0.2)
    simulation.report(Event(at_s=0, robot_joins=late))
    simulation.report(Event(at_s=0, new_task=Task(id="new", position=(1.0, 1.0), only_robots=("late",))))
    while not simulation.done:
        simulation.advance(1000.0)
    assert "new" in simulation.result().tasks_done
    assert simulation._robots.ports["late"].estimate.told_poses is not None
    assert math.dist(simulation.positions["late"], simulation._world.positions[2]) < 0.1


def test_it_hears_each_step_and_stops_where_something_was_passed():
    mission = muster.Mission(robots=(Robot(id="r", position=(0.0, 0.0)),), tasks=())
    worlds = [KinematicWorld(mission, noise=NOISE, seed=3) for _ in range(2)]
    fused, plain = with_state_estimation(worlds[0], mission, pose="true"), worlds[1]
    for hearing in (fused, plain):
        hearing.ports["r"].send([Waypoint((1.0, 0.0, 0.0), label="there"), Waypoint((2.0, 0.0, 0.0))])
    for _ in range(4):
        assert fused.advance(5.0) == plain.advance(5.0)
        assert worlds[0].time_s == worlds[1].time_s
    assert worlds[0].time_s == pytest.approx(5.0)
    assert list(fused.ports) == ["r"]
    assert len(fused.ports) == 1
    assert fused.ports["r"].estimate.told_poses is not None


@pytest.mark.parametrize("noise", [Noise(slip=0.3), Noise(odometry=0.05), Noise(slip=0.1, odometry=0.02)])
def test_a_filter_counts_with_what_the_world_draws(noise):
    """Means and deviations of what is travelled of what is counted, by drawing it."""
    robot = Robot(id="r", position=(0.0, 0.0), radius_m=0.3, kinematics="differential-drive")
    world = KinematicWorld(muster.Mission(robots=(robot,), tasks=()), noise=noise, seed=1)
    world.ports["r"].send([Waypoint((2000.0, 0.0, 0.0))])
    ways, turns = [], []
    for _ in range(4000):
        before = world.positions[0].copy()
        world.step()
        counted = world.ports["r"].odometry()
        ways.append(math.dist(before, world.positions[0]) / counted.way_m[0])
        turns.append(counted.turned_rad / counted.way_m[0])
    errors = reckoning_errors(robot, world)
    assert np.mean(ways) == pytest.approx(errors.way_kept, abs=4 * errors.way_share / math.sqrt(4000))
    assert np.std(ways) == pytest.approx(errors.way_share, rel=0.05)
    assert np.std(turns) * errors.turn_kept == pytest.approx(errors.turn_per_m, rel=0.05)


def test_an_exact_world_leaves_nothing_to_count_with_and_bodies_skid():
    robot = Robot(id="r", position=(0.0, 0.0))
    exact = reckoning_errors(robot, KinematicWorld(muster.Mission(robots=(robot,), tasks=())))
    assert (exact.way_kept, exact.turn_kept) == (1.0, 1.0)
    assert max(exact.way_share, exact.turn_share, exact.slip, exact.gyro_radps) < 1e-5
    assert min(LEAST.way_share, LEAST.turn_share, LEAST.slip, LEAST.skid, LEAST.gyro_radps) > 5e-4
