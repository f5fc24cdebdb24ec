"""Crowds: contact between steps, arrival, perturbation; and that input is checked."""

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.motion.avoidance import Agents, Crowd, Obstacles, Orca, perturbed, run, towards


class Blind:
    """Everybody gets what it wants."""

    name = "blind"

    def velocities(self, agents, obstacles=None, dt=0.25):
        return agents.preferred


def crowd_of(starts, goals, radius=0.1, speed=10.0):
    count = len(starts)
    return Crowd(
        starts=np.array(starts, dtype=float),
        goals=np.array(goals, dtype=float),
        radii=np.full(count, radius),
        max_speeds=np.full(count, speed),
    )


@pytest.mark.parametrize("height", [[], [0.0]])
def test_contact_between_two_steps_is_seen(height):
    """They swap places within one step: apart before and after, in the same place in between."""
    crowd = crowd_of([[0, 0, *height], [1, 0, *height]], [[1, 0, *height], [0, 0, *height]])
    ways = run(crowd, Blind(), dt=0.25, until_s=5, arrival_m=0.01)
    assert len(ways.velocities) == 1
    assert ways.contacts == ((0, 1),)
    assert ways.least_distances_m == pytest.approx([0.0])
    assert ways.least_gaps_m == pytest.approx([-0.2])


def test_least_distance_by_hand():
    """One passes the other at 0.3 m, in the middle of a step."""
    crowd = crowd_of([[-1.0, 0.0], [0.0, 0.3]], [[1.0, 0.0], [0.0, 0.3]], speed=8.0)
    ways = run(crowd, Blind(), dt=0.25, until_s=5, arrival_m=0.01)
    assert ways.least_distances_m == pytest.approx([0.3])
    assert ways.least_gaps_m == pytest.approx([0.1])
    assert ways.contacts == ()
    assert list(ways.arrivals_s) == [0.25, 0.0]


def test_time_runs_out():
    ways = run(crowd_of([[0, 0]], [[100, 0]], speed=1.0), Blind(), dt=0.5, until_s=3.0, arrival_m=0.1)
    assert not ways.all_arrived
    assert ways.duration_s == 3.0
    assert ways.positions.shape == (7, 1, 2)


def test_two_with_one_goal_are_there_side_by_side():
    crowd = crowd_of([[0, 0], [5, 0], [9, 9]], [[2, 0], [2, 0], [9, 9]])
    places = np.array([[2.0, 0.0], [2.2, 0.0], [9.0, 9.0]])
    assert crowd.arrived(places, 0.01).all()
    places[:2, 0] = 1.9, 2.1
    assert crowd.arrived(places, 0.01).all()
    places[:2, 0] = 2.0, 2.3
    assert list(crowd.arrived(places, 0.01)) == [True, False, True]
    places[:2, 0] = 1.7, 1.9
    assert list(crowd.arrived(places, 0.01)) == [False, False, True]


def test_perturbation_is_seeded_held_and_bounded():
    goals = np.array([[3.0, 4.0], [0.0, 0.0]])
    plain = towards(goals, np.array([1.0, 1.0]), 0.25)
    places = np.zeros((2, 2))
    shifted = perturbed(plain, 0.5, seed=1, hold=4)
    assert (shifted(places, 0) == shifted(places, 3)).all()
    assert (shifted(places, 0) == perturbed(plain, 0.5, seed=1, hold=4)(places, 0)).all()
    assert (shifted(places, 0) != shifted(places, 4)).any()
    off = np.linalg.norm(shifted(places, 0) - plain(places, 0), axis=1)
    assert off == pytest.approx([0.5, 0.0])  # who is there stays there


def test_a_run_is_the_same_twice():
    crowd = crowd_of([[0, 0], [4, 0], [2, 3]], [[4, 0], [0, 0], [2, -3]], radius=0.4, speed=1.0)
    first, second = (run(crowd, Orca(), dt=0.2, until_s=20, arrival_m=0.1) for _ in range(2))
    assert (first.positions == second.positions).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"positions": np.zeros((2, 4))}, r"positions: shape \(2, 4\); expected \(n, 2\) or \(n, 3\)"),
        ({"velocities": np.zeros((3, 2))}, r"velocities: shape \(3, 2\); expected \(2, 2\)"),
        ({"preferred": np.full((2, 2), np.nan)}, "preferred: .*; expected finite numbers"),
        ({"radii": np.array([1.0, -0.5])}, r"radii: \[-0.5\]; expected at least 0"),
        ({"max_speeds": np.array([1.0])}, r"max_speeds: shape \(1,\); expected \(2,\)"),
    ],
)
def test_agents_refuse(change, message):
    right = {
        "positions": np.zeros((2, 2)),
        "velocities": np.zeros((2, 2)),
        "preferred": np.zeros((2, 2)),
        "radii": np.ones(2),
        "max_speeds": np.ones(2),
    }
    with pytest.raises(ParameterError, match=message):
        Agents(**{**right, **change})


def test_obstacles_refuse():
    with pytest.raises(ParameterError, match=r"walls: shape \(4, 2\)"):
        Obstacles(walls=np.zeros((4, 2)))
    with pytest.raises(ParameterError, match="boxes: a lowest corner above the highest"):
        Obstacles(boxes=np.array([[(1, 0, 0), (0, 1, 1)]], dtype=float))


def test_run_refuses_goals_of_another_shape():
    crowd = crowd_of([[0, 0], [1, 1]], [[0, 0]])
    with pytest.raises(ParameterError, match="goals: shape"):
        run(crowd, Orca(), dt=0.25, until_s=1, arrival_m=0.1)


def test_nobody():
    empty = np.empty((0, 2))
    nobody = Agents(positions=empty, velocities=empty, preferred=empty, radii=np.empty(0), max_speeds=np.empty(0))
    assert Orca().velocities(nobody).shape == (0, 2)
