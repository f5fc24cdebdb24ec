"""What two rules say of one thing holds together."""

import math

import numpy as np

from muster.model.parts import NEVER, Meter, Parts
from muster.model.plan_model import PlanModel


def test_what_is_in_both_domains_is_left():
    parts = Parts(robots=1, tasks=2)
    parts.opens(0, [(5, 10), (20, None)])
    parts.opens(0, [(8, 30)])
    assert parts.openings == {0: [(8, 10), (20, 30)]}
    parts.opens(0, [(40, 50)])
    assert parts.openings == {0: NEVER}


def test_what_may_never_begin_is_done_in_no_plan():
    parts = Parts(robots=1, tasks=1)
    parts.opens(0, [(5, 10)])
    parts.opens(0, [(20, 30)])
    model = PlanModel(parts, np.full(1, math.inf))
    assert model.next_begin(0, np.array([0.0, 7.0, 40.0])).tolist() == [math.inf] * 3


def test_the_narrower_limit_holds():
    parts = Parts(robots=1, tasks=2)
    for latest_s in (30, 20, 25):
        parts.ends(0, latest_s)
        parts.is_over(0, latest_s)
        parts.uses(0, latest_s)
    assert parts.ends_by == parts.over_by == parts.capacity == {0: 20}


def test_gaps_narrow_each_other():
    parts = Parts(robots=1, tasks=2)
    parts.follows(1, 0, least_s=2)
    parts.follows(1, 0, most_s=9)
    parts.follows(1, 0, least_s=1, most_s=math.inf)
    assert parts.gaps == {1: {0: (2, 9)}}


def test_a_count_is_what_no_station_takes_off():
    count = Meter.count("tasks", np.ones(3), [2, math.inf])
    assert count.pending.tolist() == count.change.tolist() == [1, 1, 1]
    assert count.at_start.tolist() == count.pending_at_start.tolist() == [0, 0]
