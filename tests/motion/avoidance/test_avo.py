"""AVO: its discs are what proportional control does, its limit is kept, and what it promises of crowds."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.motion.avoidance.scenes import random_agents

from muster import core
from muster.mission.errors import ParameterError
from muster.motion.avoidance import Avo, Crowd, perturbed, run, towards
from muster.motion.avoidance.avo import Parameters

part = st.floats(-3, 3)


@given(
    apart=st.tuples(part, part),
    v=st.tuples(part, part),
    w=st.tuples(part, part),
    time=st.floats(0.2, 6),
    response=st.floats(0.2, 2),
)
def test_a_disc_holds_the_choices_that_touch_then(apart, v, w, time, response):
    """Where the relative motion is after a time, by small steps of the control law v' = (w - v) / delta."""
    x, y, radius = core.avo_disc(apart, v, 0.5, response, time)
    steps = 500
    dt = time / steps
    velocity, place = np.array(v), np.zeros(2)
    for _ in range(steps):
        middle = velocity + dt / 2 * (np.array(w) - velocity) / response
        place, velocity = place + dt * middle, velocity + dt * (np.array(w) - middle) / response
    distance = math.dist(place, apart)
    assume(abs(distance - 0.5) > 1e-3)
    assert (distance < 0.5) == (math.dist(w, (x, y)) < radius)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10**6), limit=st.floats(0.1, 3), dt=st.floats(0.05, 0.5))
def test_no_robot_accelerates_beyond_its_limit(seed, limit, dt):
    agents = random_agents(seed, 40)
    chosen = Avo(Parameters(acceleration_mps2=limit)).velocities(agents, dt=dt)
    change = np.linalg.norm(chosen - agents.velocities, axis=1) / dt
    assert change.max() <= limit + 1e-9


@pytest.mark.parametrize("count", [8, 24])
def test_a_circle_crosses_without_contact(count):
    angles = 2 * np.pi * np.arange(count) / count
    starts = 0.9 * count * np.column_stack([np.cos(angles), np.sin(angles)])
    crowd = Crowd(starts=starts, goals=-starts, radii=np.full(count, 1.0), max_speeds=np.full(count, 2.0))
    wanted = perturbed(towards(crowd.goals, crowd.max_speeds, 0.25), share=0.8, seed=3, hold=20)
    ways = run(crowd, Avo(Parameters(horizon_s=2.0)), dt=0.25, until_s=400, arrival_m=0.1, preference=wanted)
    assert ways.all_arrived
    assert ways.contacts == ()
    changes = np.linalg.norm(np.diff(ways.velocities, axis=0), axis=2) / 0.25
    assert changes.max() <= 1.0 + 1e-9


def test_a_pair_mirrors_each_other():
    crowd = Crowd(
        starts=np.array([[-3.0, 0.1], [3.0, -0.1]]),
        goals=np.array([[3.0, 0], [-3.0, 0]]),
        radii=np.full(2, 0.5),
        max_speeds=np.full(2, 1.0),
    )
    ways = run(crowd, Avo(), dt=0.1, until_s=3, arrival_m=0.05)
    np.testing.assert_allclose(ways.positions[:, 0], -ways.positions[:, 1], atol=1e-6)


def test_a_longer_horizon_turns_aside_earlier():
    def first_aside(horizon):
        crowd = Crowd(
            starts=np.array([[-6.0, 0.1], [6.0, 0.0]]),
            goals=np.array([[6.0, 0.1], [-6.0, 0]]),
            radii=np.full(2, 0.5),
            max_speeds=np.full(2, 1.0),
        )
        ways = run(crowd, Avo(Parameters(horizon_s=horizon)), dt=0.1, until_s=30, arrival_m=0.1)
        return int(np.argmax(np.abs(ways.velocities[:, 0, 1]) > 0.02))

    assert first_aside(6.0) < first_aside(2.0)


@pytest.mark.parametrize("wrong", [{"acceleration_mps2": 0.0}, {"response_s": math.inf}, {"horizon_s": -1.0}])
def test_parameters_check_themselves(wrong):
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        Parameters(**wrong)
