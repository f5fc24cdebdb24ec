"""What metrics say of a database."""

import pytest

from muster_control.store.statistics import statistics


def plan_of(value, bound):
    return {"objective": {"name": "max", "value": value}, "lower_bound": bound, "routes": []}


def made(store, plan):
    job = store.jobs.add("plan", "Yard", 1, {}, "ann")
    store.jobs.begin(job.id)
    store.jobs.end_with_plan(job.id, plan, "", {"objective": 12.0, "bound": 6.0})  # how far it was when last heard of


def test_the_gap_is_that_of_plans_not_of_what_was_heard_on_the_way(filled):
    store = filled.store
    assert (statistics(store).gap, statistics(store).job_s) == (None, None)
    made(store, plan_of(10.0, 10.0))
    assert statistics(store).gap == 0.0
    made(store, plan_of(10.0, 8.0))
    made(store, plan_of(10.0, None))
    store.plans.add("Yard", 1, "uploaded", "ann", plan_of(10.0, 1.0))  # a bound that nobody here has proven
    assert statistics(store).gap == pytest.approx(0.1)
    assert statistics(store).job_s >= 0.0
    assert statistics(store).jobs == {"done": 3}
