"""ORCA: what it promises of pairs, walls and crowds, and that it agrees with RVO2."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.motion.avoidance.scenes import random_agents

from muster.mission.errors import ParameterError
from muster.motion.avoidance import Agents, Crowd, Obstacles, Orca, run, towards
from muster.motion.avoidance.orca import Parameters


def pair(start_a, start_b, goal_a, goal_b, **kwargs):
    return Crowd(
        starts=np.array([start_a, start_b], dtype=float),
        goals=np.array([goal_a, goal_b], dtype=float),
        radii=np.array([0.5, 0.5]),
        max_speeds=np.array([1.0, 1.0]),
        **kwargs,
    )


@pytest.mark.parametrize("seed", range(6))
def test_agrees_with_rvo2(seed):
    """RVO2 computes in single precision."""
    pyrvo = pytest.importorskip("pyrvo", reason="needs the extra bench")

    agents = random_agents(seed, 100, spacing=5.0)
    simulator = pyrvo.RVOSimulator(0.25, 15.0, 10, 5.0, 5.0, 1.5, 2.0)
    for position, velocity, preferred in zip(agents.positions, agents.velocities, agents.preferred, strict=True):
        k = simulator.add_agent(tuple(position))
        simulator.set_agent_velocity(k, tuple(velocity))
        simulator.set_agent_pref_velocity(k, tuple(preferred))
    simulator.do_step()
    found = [simulator.get_agent_velocity(k) for k in range(100)]
    theirs = np.array([(v.x, v.y) for v in found])
    ours = Orca(Parameters(horizon_s=5.0, keep_apart=False)).velocities(agents, dt=0.25)
    assert np.abs(ours - theirs).max() < 2e-3


@given(seed=st.integers(0, 10**6))
@settings(max_examples=30)
def test_two_drones_head_on_pass_without_touching(seed):
    """Also exactly head on, where both have to choose a side of their own accord."""
    random = np.random.default_rng(seed)
    direction = random.normal(size=3)
    direction *= 5 / np.linalg.norm(direction)
    aside = 0.05 * random.normal(size=3) * (seed % 2)
    drones = pair(direction, -direction + aside, -direction, direction)
    method = Orca(Parameters(horizon_s=2.0))
    wanted = towards(drones.goals, drones.max_speeds, 0.1)
    slanted = lambda places, step: wanted(places, step) + 0.02 * np.array([0.0, 0.0, 1.0])  # noqa: E731
    ways = run(drones, method, dt=0.1, until_s=60, arrival_m=0.1, preference=slanted if seed % 2 else wanted)
    assert ways.contacts == ()
    assert ways.least_gaps_m.min() >= -1e-9


def test_a_pair_mirrors_each_other():
    for dimensions in (2, 3):
        ahead = np.eye(dimensions)[0]
        agents = Agents(
            positions=np.array([-3 * ahead, 3 * ahead]),
            velocities=np.array([ahead, -ahead]),
            preferred=np.array([ahead, -ahead]),
            radii=np.array([0.5, 0.5]),
            max_speeds=np.array([1.0, 1.0]),
        )
        first, second = Orca().velocities(agents)
        assert first == pytest.approx(-second)
        assert np.linalg.norm(first - ahead) > 0.01


@given(seed=st.integers(0, 10**6), dimensions=st.sampled_from([2, 3]))
@settings(max_examples=25)
def test_numbering_and_threads_make_no_difference(seed, dimensions):
    agents = random_agents(seed, 60, dimensions, spacing=4.0)
    order = np.random.default_rng(seed).permutation(60)
    shuffled = Agents(
        positions=agents.positions[order],
        velocities=agents.velocities[order],
        preferred=agents.preferred[order],
        radii=agents.radii,
        max_speeds=agents.max_speeds,
    )
    found = Orca().velocities(agents)
    assert (Orca().velocities(shuffled) == found[order]).all()
    assert (Orca(Parameters(threads=3)).velocities(agents) == found).all()
    assert (np.linalg.norm(found, axis=1) <= 2.0 + 1e-9).all()


@pytest.mark.long
@given(seed=st.integers(0, 10**6), dimensions=st.sampled_from([2, 3]), ranked=st.booleans())
@settings(max_examples=25)
def test_a_crowd_never_touches(seed, dimensions, ranked):
    """Whatever the priorities, and however dense: goals are dealt out at random."""
    random = np.random.default_rng(seed)
    agents = random_agents(seed, 27, dimensions, spacing=3.4)
    crowd = Crowd(
        starts=agents.positions,
        goals=random.permutation(agents.positions),
        radii=agents.radii,
        max_speeds=agents.max_speeds,
        priorities=random.integers(0, 3, 27).astype(float) if ranked else None,
    )
    ways = run(crowd, Orca(), dt=0.25, until_s=20, arrival_m=0.1)
    assert ways.contacts == ()


@pytest.mark.long
@given(seed=st.integers(0, 10**6))
@settings(max_examples=25)
def test_walls_are_never_touched(seed):
    """A room with a wall across it; all want to be on the other side of something."""
    random = np.random.default_rng(seed)
    room = Obstacles.from_polygons([[(0, 0), (20, 0), (20, 20), (0, 20)], [(8, 5), (12, 5), (12, 15), (8, 15)]])
    starts = np.array([(x, y) for x in (2.0, 5.0, 15.0, 18.0) for y in (4.0, 10.0, 16.0)])
    crowd = Crowd(
        starts=starts,
        goals=random.uniform(-10, 30, starts.shape),
        radii=np.full(12, 0.5),
        max_speeds=np.full(12, 1.5),
    )
    ways = run(crowd, Orca(Parameters(wall_horizon_s=1.0)), dt=0.2, until_s=30, arrival_m=0.1, obstacles=room)
    assert ways.contacts == ()
    for a, b in room.walls:
        share = np.clip(((ways.positions - a) @ (b - a)) / ((b - a) @ (b - a)), 0, 1)
        away = np.linalg.norm(ways.positions - (a + share[..., None] * (b - a)), axis=-1)
        assert away.min() >= 0.5 - 1e-9


def test_a_drone_keeps_off_a_box_and_flies_over_it():
    box = Obstacles(boxes=np.array([[(4, -5, 0), (6, 5, 3)]], dtype=float))
    drone = Crowd(
        starts=np.array([[0.0, 0.0, 2.5]]),
        goals=np.array([[10.0, 0.0, 6.0]]),
        radii=np.array([0.5]),
        max_speeds=np.array([2.0]),
    )
    ways = run(drone, Orca(Parameters(wall_horizon_s=1.0)), dt=0.1, until_s=60, arrival_m=0.1, obstacles=box)
    places = ways.positions[:, 0]
    nearest = np.clip(places, *box.boxes[0])
    assert np.linalg.norm(places - nearest, axis=1).min() >= 0.5 - 1e-9
    assert ways.all_arrived


def test_the_lower_priority_gives_way():
    """The other one goes straight on at full speed."""
    robots = pair((-4, 0), (4, 0.1), (4, 0), (-4, 0.1), priorities=np.array([1.0, 0.0]))
    ways = run(robots, Orca(Parameters(horizon_s=3.0)), dt=0.1, until_s=30, arrival_m=0.05)
    assert ways.all_arrived
    assert ways.contacts == ()
    assert np.abs(ways.positions[:, 0, 1]).max() < 1e-9
    assert ways.arrivals_s[0] == pytest.approx(8.0, abs=0.11)
    assert np.abs(ways.positions[:, 1, 1]).max() > 0.5


def test_robots_that_overlap_part():
    agents = Agents(
        positions=np.array([[0.0, 0.0], [0.5, 0.0]]),
        velocities=np.zeros((2, 2)),
        preferred=np.zeros((2, 2)),
        radii=np.array([0.5, 0.5]),
        max_speeds=np.array([5.0, 5.0]),
    )
    after = agents.positions + 0.25 * Orca().velocities(agents, dt=0.25)
    assert np.linalg.norm(after[1] - after[0]) == pytest.approx(1.0)


def test_refuses():
    with pytest.raises(ParameterError, match="horizon_s: 0; expected a finite number above 0"):
        Parameters(horizon_s=0)
    with pytest.raises(ParameterError, match="threads: 0"):
        Parameters(threads=0)
    with pytest.raises(ParameterError, match="dt: -1"):
        Orca().velocities(random_agents(0, 4), dt=-1)
