"""Runners that die again and again are not followed by others for ever."""

import pytest

from muster_control.runs.crash_history import MOST_CRASHES, MOST_KILLS, CrashHistory


class Clock:
    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


@pytest.mark.parametrize(("killed", "most"), [(False, MOST_CRASHES), (True, MOST_KILLS)])
def test_without_getting_further(killed, most):
    crashes = CrashHistory(real=False)
    assert [crashes.too_often(5.0, killed=killed) for _ in range(most)] == [False] * (most - 1) + [True]


def test_a_simulated_world_gets_further_by_its_clock():
    crashes = CrashHistory(real=False)
    for k in range(1, 10 * MOST_CRASHES):
        assert not crashes.too_often(0.1 * k, killed=False)
        assert not crashes.too_often(0.1 * k, killed=False)
        assert crashes.count == 2


def test_of_real_robots_it_counts_how_long_each_has_lived():
    clock = Clock()
    crashes = CrashHistory(real=True, clock=clock)

    def dies_after(seconds, at):
        crashes.started()
        clock.now += seconds
        return crashes.too_often(at, killed=False)

    assert [dies_after(90.0, 90.0 * k) for k in range(1, 10)] == [False] * 9
    assert [dies_after(2.0, 900.0 + k) for k in range(MOST_CRASHES - 1)] == [False, True]
