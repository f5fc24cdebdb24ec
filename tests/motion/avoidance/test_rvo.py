"""RVO of the thesis, (A.4) to (A.20), by hand and against a plain search; HRVO by its geometry."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.motion.avoidance.scenes import random_agents

from muster import core
from muster.mission.errors import ParameterError
from muster.motion.avoidance import Agents, Crowd, Hrvo, Obstacles, Rvo, run, towards
from muster.motion.avoidance.rvo import Parameters

DEGREE = math.pi / 180
HEAD_ON = core.VelocityObstacle((0, 0), (2, 0), (1, 0), (-1, 0), 1.0)  # R_i = 0.5


def test_ideal_velocity():
    """(A.4): 3-4-5; and onto the goal where it is nearer than a step."""
    preference = towards(np.array([[3.0, 4.0], [0.1, 0.0]]), np.array([0.5, 2.0]), 0.25)
    assert preference(np.zeros((2, 2)), 0) == pytest.approx(np.array([[0.3, 0.4], [0.4, 0.0]]))


def test_velocity_obstacle_by_hand():
    """(A.5) to (A.7): theta_R = asin(1 / 2) = 30 degrees."""
    assert HEAD_ON.theta_ik == 0
    assert HEAD_ON.theta_R == pytest.approx(30 * DEGREE)
    root = math.sqrt(3) / 2
    assert HEAD_ON.boundaries == pytest.approx([0, 0, root, 0.5, root, -0.5, 2, 1])
    moved = core.VelocityObstacle((1, 1), (1, 4), (0.4, 0), (0, 0.2), 1.5)
    assert moved.theta_ik == pytest.approx(90 * DEGREE)
    assert moved.boundaries == pytest.approx([1.2, 1.1, -0.5, root, 0.5, root, 3, 1.5])


@pytest.mark.parametrize(
    ("angle", "suitable"), [(0, False), (29, False), (-29, False), (31, True), (-31, True), (180, True)]
)
def test_suitable_by_hand(angle, suitable):
    """(A.12), (A.13)."""
    v = (math.cos(angle * DEGREE), math.sin(angle * DEGREE))
    assert HEAD_ON.phi_delta(v) == pytest.approx(angle * DEGREE)
    assert HEAD_ON.suitable(v) == suitable


def test_time_to_collision_by_hand():
    """(A.18) to (A.20); what the formula means: along the ray until the disc of radius 2 R_i around robot k."""
    assert HEAD_ON.time_to_collision((1, 0)) == pytest.approx(1.0)
    assert HEAD_ON.time_to_collision((2, 0)) == pytest.approx(0.5)
    v = (math.cos(20 * DEGREE), math.sin(20 * DEGREE))
    assert HEAD_ON.phi_1(v) == pytest.approx(20 * DEGREE)
    phi_2 = math.asin(2 * math.sin(20 * DEGREE))
    assert HEAD_ON.time_to_collision(v) == pytest.approx(2 * math.cos(20 * DEGREE) - math.cos(phi_2))
    t = HEAD_ON.time_to_collision(v)
    assert math.dist((t * v[0], t * v[1]), (2, 0)) == pytest.approx(1.0)


def test_angles_beyond_pi():
    """To the left, where phi_l passes pi and 0.5 (phi_l + phi_r) as printed would point to the right."""
    left = core.VelocityObstacle((0, 0), (-2, 0), (0, 0), (0, 0), 1.0)
    assert not left.suitable((-1, 0.1))
    assert not left.suitable((-1, -0.1))
    assert left.suitable((1, 0))
    assert left.phi_1((-1, -0.1)) == pytest.approx(math.atan(0.1))


def plain(agents, parameters, i):
    """v_opt of robot i by (A.8) to (A.20), and whether a velocity is suitable."""
    obstacles = [
        core.VelocityObstacle(
            tuple(agents.positions[i]),
            tuple(agents.positions[k]),
            tuple(agents.velocities[i]),
            tuple(agents.velocities[k]),
            agents.radii[i] + agents.radii[k],
        )
        for k in range(len(agents.positions))
        if k != i
    ]
    v_id = agents.preferred[i]
    magnitudes = np.linspace(parameters.v_min_mps, agents.max_speeds[i], parameters.magnitudes)
    angles = np.arange(0, 2 * math.pi, parameters.n_rad)
    tried = [tuple(v_id), *((m * math.cos(a), m * math.sin(a)) for m, a in itertools.product(magnitudes, angles))]
    suitable = [v for v in tried if all(o.suitable(v) for o in obstacles)]
    if suitable:
        return min(math.dist(v, v_id) for v in suitable), True
    return min(
        parameters.w_m / min(o.time_to_collision(v) for o in obstacles if not o.suitable(v)) + math.dist(v, v_id)
        for v in tried
    ), False


@given(seed=st.integers(0, 10**6), closed_in=st.booleans())
@settings(max_examples=25)
def test_the_best_velocity_is_chosen(seed, closed_in):
    """Both branches: a robot closed in by fast ones has no suitable velocity."""
    agents = random_agents(seed, 9, spacing=3.1 if closed_in else 8.0)
    parameters = Parameters(magnitudes=4, n_rad=0.3, w_m=2.0)
    found = Rvo(parameters).velocities(agents)
    for i in range(9):
        best, suitable = plain(agents, parameters, i)
        if suitable:
            assert math.dist(found[i], agents.preferred[i]) == pytest.approx(best, abs=1e-9)
        else:
            vsf = vsf_of(agents, parameters, i, found[i])
            assert vsf == pytest.approx(best, rel=1e-9)


def vsf_of(agents, parameters, i, v):
    only = Agents(
        positions=agents.positions,
        velocities=agents.velocities,
        preferred=np.tile(v, (9, 1)),
        radii=agents.radii,
        max_speeds=agents.max_speeds,
    )
    times = []
    for k in set(range(9)) - {i}:
        obstacle = core.VelocityObstacle(
            tuple(only.positions[i]),
            tuple(only.positions[k]),
            tuple(only.velocities[i]),
            tuple(only.velocities[k]),
            agents.radii[i] + agents.radii[k],
        )
        if not obstacle.suitable(tuple(v)):
            times.append(obstacle.time_to_collision(tuple(v)))
    return parameters.w_m / min(times) + math.dist(v, agents.preferred[i])


def test_both_branches_are_met():
    """So that the property above is one of both."""
    parameters = Parameters(magnitudes=4, n_rad=0.3, w_m=2.0)
    met = {plain(random_agents(seed, 9, spacing=3.1), parameters, 4)[1] for seed in range(10)}
    met |= {plain(random_agents(seed, 9, spacing=8.0), parameters, 4)[1] for seed in range(10)}
    assert met == {True, False}


def test_hybrid_obstacle_by_hand():
    """Velocity a little to the left: the left side is that of the RVO, the right side that of the VO."""
    apart, v_a, v_b = (2.0, 0.0), (1.0, 0.1), (-1.0, 0.0)
    apex, left, right = map(np.array, core.hybrid_obstacle(apart, v_a, v_b, 1.0, 0.25))
    root = math.sqrt(3) / 2
    assert left == pytest.approx([root, 0.5])
    assert right == pytest.approx([root, -0.5])
    mean = np.array([0.0, 0.05])
    assert np.linalg.det([left, apex - mean]) == pytest.approx(0, abs=1e-12)
    assert np.linalg.det([right, apex - np.array(v_b)]) == pytest.approx(0, abs=1e-12)
    other, _, _ = map(np.array, core.hybrid_obstacle(apart, (1.0, -0.1), v_b, 1.0, 0.25))
    assert other == pytest.approx(apex * [1, -1])
    whole, _, _ = core.hybrid_obstacle(apart, v_a, v_b, 1.0, 0.25, 1.0)
    assert whole == pytest.approx(v_b)


@pytest.mark.long
@given(seed=st.integers(0, 10**6))
@settings(max_examples=25)
def test_hybrid_velocities_are_the_nearest_outside_all_obstacles(seed):
    """Where robots have room nobody chooses within an obstacle, and no sample outside all is nearer to the wanted."""
    agents = random_agents(seed, 9, spacing=9.0)
    found = Hrvo().velocities(agents)
    random = np.random.default_rng(seed)
    for i in range(9):
        others = [k for k in range(9) if 0 < np.linalg.norm(agents.positions[k] - agents.positions[i]) <= 15]
        cones = [
            core.hybrid_obstacle(
                tuple(agents.positions[k] - agents.positions[i]),
                tuple(agents.velocities[i]),
                tuple(agents.velocities[k]),
                3.0,
                0.25,
            )
            for k in others
        ]
        angles, speeds = random.uniform(0, 2 * np.pi, 400), 2 * np.sqrt(random.uniform(0, 1, 400))
        samples = np.stack([speeds * np.cos(angles), speeds * np.sin(angles)], axis=1)
        free = [v for v in samples if not any(deep(cone, v) > 0 for cone in cones)]
        if free:
            nearest = min(math.dist(v, agents.preferred[i]) for v in free)
            assert math.dist(found[i], agents.preferred[i]) <= nearest + 1e-9
            assert not any(deep(cone, found[i]) > 1e-6 for cone in cones)


def deep(cone, v):
    apex, left, right = map(np.array, cone)
    d = v - apex
    return min(d[0] * left[1] - d[1] * left[0], right[0] * d[1] - right[1] * d[0])


@pytest.mark.parametrize("method", [Rvo(), Hrvo()], ids=lambda method: method.name)
def test_walls_are_not_touched(method):
    walls = Obstacles(walls=np.array([[(3, -4), (3, 4)]], dtype=float))
    robot = Crowd(
        starts=np.array([[0.0, 1.0]]),
        goals=np.array([[6.0, 0.0]]),
        radii=np.array([0.3]),
        max_speeds=np.array([1.0]),
    )
    ways = run(robot, method, dt=0.25, until_s=40, arrival_m=0.1, obstacles=walls)
    x, y = ways.positions[:, 0].T
    away = np.hypot(np.maximum(0, np.abs(y) - 4), x - 3)
    assert away.min() >= 0.3 - 1e-9
    assert x.max() > 2.0


@pytest.mark.parametrize("method", [Rvo(), Hrvo()], ids=lambda method: method.name)
def test_the_lower_priority_gives_way(method):
    robots = Crowd(
        starts=np.array([[-4.0, 0.0], [4.0, 0.1]]),
        goals=np.array([[4.0, 0.0], [-4.0, 0.1]]),
        radii=np.array([0.5, 0.5]),
        max_speeds=np.array([1.0, 1.0]),
        priorities=np.array([1.0, 0.0]),
    )
    ways = run(robots, method, dt=0.1, until_s=30, arrival_m=0.05)
    assert ways.all_arrived
    assert ways.contacts == ()
    assert (ways.positions[:, 0, 1] == 0).all()


@pytest.mark.parametrize("method", [Rvo(), Hrvo()], ids=lambda method: method.name)
def test_threads_make_no_difference(method):
    agents = random_agents(3, 40)
    threaded = type(method)(type(method.params)(threads=3))
    assert (threaded.velocities(agents) == method.velocities(agents)).all()


@pytest.mark.parametrize("method", [Rvo(), Hrvo()], ids=lambda method: method.name)
def test_refuses_space(method):
    with pytest.raises(ParameterError, match=r"positions: shape \(8, 3\); expected \(n, 2\)"):
        method.velocities(random_agents(0, 8, 3))


def test_refuses_parameters():
    with pytest.raises(ParameterError, match="n_rad: 0; expected"):
        Parameters(n_rad=0)
    with pytest.raises(ParameterError, match="magnitudes: 0"):
        Parameters(magnitudes=0)
