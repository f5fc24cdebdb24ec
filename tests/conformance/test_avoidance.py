"""What every method of collision avoidance keeps."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.motion.avoidance.scenes import random_agents

from muster.mission.errors import ParameterError
from muster.motion.avoidance import Agents, Avo, Crowd, Hrvo, Obstacles, Orca, Rvo, perturbed, run, towards
from muster.motion.avoidance.orca import Parameters as OrcaParameters

METHODS = (Orca(OrcaParameters(horizon_s=5.0)), Rvo(), Hrvo(), Avo())
every_method = pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)


@every_method
@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_no_velocity_is_above_its_maximum_and_the_same_again(method, seed):
    agents = random_agents(seed, 40)
    once, again = method.velocities(agents), method.velocities(agents)
    assert np.linalg.norm(once, axis=1).max() <= 2.0 + 1e-9
    np.testing.assert_array_equal(once, again)


@every_method
@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_numbering_makes_no_difference(method, seed):
    agents = random_agents(seed, 30)
    order = np.random.default_rng(seed).permutation(30)
    names = ("positions", "velocities", "preferred", "radii", "max_speeds")
    shuffled = Agents(**{name: getattr(agents, name)[order] for name in names})
    np.testing.assert_allclose(method.velocities(shuffled), method.velocities(agents)[order], atol=1e-9)


@every_method
def test_who_is_alone_goes_as_it_would(method):
    alone = Agents(
        positions=np.zeros((1, 2)),
        velocities=np.array([[0.8, 0.0]]),
        preferred=np.array([[1.0, 0.0]]),
        radii=np.array([0.3]),
        max_speeds=np.array([1.0]),
    )
    for _ in range(40):
        velocities = method.velocities(alone)
        alone = Agents(
            **{name: getattr(alone, name) for name in ("positions", "preferred", "radii", "max_speeds")},
            velocities=velocities,
        )
    np.testing.assert_allclose(velocities, [[1.0, 0.0]], atol=1e-3)


@every_method
@pytest.mark.parametrize("angle", [60, 90, 150, 177])
def test_two_that_cross_pass_without_contact(method, angle):
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    starts = np.array([[-4.0, 0.0], [-4 * c, -4 * s]])
    crowd = Crowd(
        starts=starts, goals=-starts, radii=np.full(2, 0.3), max_speeds=np.full(2, 1.0), inflated_radii=np.full(2, 0.35)
    )
    wanted = perturbed(towards(crowd.goals, crowd.max_speeds, 0.25), share=0.1, seed=1, hold=20)
    ways = run(crowd, method, dt=0.25, until_s=60, arrival_m=0.05, preference=wanted)
    assert ways.all_arrived
    assert ways.contacts == ()


@every_method
def test_a_wall_stops(method):
    crowd = Crowd(
        starts=np.array([[0.0, 0.0]]), goals=np.array([[5.0, 0.0]]), radii=np.array([0.3]), max_speeds=np.array([1.0])
    )
    wall = Obstacles(walls=np.array([[[2.0, -9.0], [2.0, 9.0]]]))
    ways = run(crowd, method, dt=0.1, until_s=15, arrival_m=0.05, obstacles=wall)
    assert 1.3 < ways.positions[-1, 0, 0] <= 1.7 + 1e-6


@every_method
def test_the_lower_priority_gives_way(method):
    starts = np.array([[-3.0, 0.02], [3.0, 0.0]])
    crowd = Crowd(
        starts=starts, goals=-starts, radii=np.full(2, 0.3), max_speeds=np.full(2, 1.0), priorities=np.array([1.0, 0.0])
    )
    ways = run(crowd, method, dt=0.1, until_s=40, arrival_m=0.1)
    aside = np.abs(ways.positions[:, :, 1]).max(axis=0)
    assert ways.contacts == ()
    assert aside[0] < 0.2 < aside[1]


@every_method
def test_no_step_without_time(method):
    with pytest.raises(ParameterError, match="dt"):
        method.velocities(random_agents(1, 3), dt=0.0)
