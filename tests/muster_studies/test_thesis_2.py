"""The reviewed allocators beside Table 2.2."""

from types import SimpleNamespace

import pytest

import muster
from muster.allocation.registry import ALLOCATORS
from muster.model.problem import Problem
from muster_studies.effort import Effort
from muster_studies.registry import study_named
from muster_studies.runs import Case, perform
from muster_studies.thesis_2 import diversity, samples
from muster_studies.thesis_2.diversity import predecessors
from muster_studies.thesis_2.ranking import RANKS, _reached_s


@pytest.fixture(scope="module")
def report():
    return study_named("thesis-2").run(Effort(iterations=2, seeds=2, tables=("ranking", "2.2")))


@pytest.mark.long
def test_every_reviewed_allocator_is_ranked(report):
    rows = report.tables[0].records()
    assert [row[""] for row in rows] == list(range(1, len(rows) + 1))
    named = {row["allocator"] for row in rows}
    assert named == set(samples.ALLOCATORS) <= set(ALLOCATORS.shipped)
    assert {name for ranks in RANKS.values() for name in ranks} <= named


def test_excesses_are_the_judges(report):
    """Of the deterministic greedy, on the mission of the column `rescue`, from plans solved anew."""
    mission = muster.load("market-rescue-20")

    def value(name, seed):
        plan = muster.solve(mission, name, iterations=2 if ALLOCATORS[name].anytime else None, seed=seed)
        verdict = muster.verify(mission, plan)
        return -verdict.weight_completed, verdict.value(mission.rules.objective)

    best = min(value(name, seed) for name in samples.ALLOCATORS for seed in (0, 1))
    row = next(row for row in report.tables[0].records() if row["allocator"] == "greedy")
    assert row["rescue"] == pytest.approx(100 * (value("greedy", 0)[1] / best[1] - 1))


def test_verdicts_stand_beside_the_published_ones(report):
    rows = report.tables[1].records()
    for criterion, published in RANKS.items():
        own = [row for row in rows if row["criterion"] == criterion]
        assert tuple(row["published"] for row in own) == published
        assert [row["figure"] for row in own] == sorted(row["figure"] for row in own)
        for row in own:
            assert ("✓" in row["own"]) == (row["own"].split()[0] == row["published"])


def test_the_interval_is_that_of_a_bootstrap():
    from scipy.stats import bootstrap

    values = [1.0, 2.5, 2.0, 4.0, 3.5, 3.0, 2.2, 2.8, 1.9, 3.1, 2.6, 2.4, 3.3, 1.4, 2.9, 2.7]
    low, high = bootstrap((values,), lambda x, axis: x.mean(axis), rng=0).confidence_interval
    assert samples.half_interval(values) == pytest.approx((high - low) / 2, rel=0.15)
    assert samples.half_interval([1.0]) is None


def test_plans_that_do_less_have_no_excess():
    of = samples.Excesses({"a": (1.0, None), "b": (3.0, 5.0)})
    assert (of.fewer, of.mean(("a", "b")), of.worst()) == (0.25, 2.5, 3.0)


def test_when_a_goal_is_reached():
    run = SimpleNamespace(history=((0.1, 9.0), (0.2, 7.0), (0.3, 6.0)), cpu_s=0.5)
    assert [_reached_s(run, goal) for goal in (9.5, 7.0, 6.5, 5.0)] == [0.1, 0.2, 0.3, 0.5]


def test_diversity_falls_from_that_of_random_plans(monkeypatch):
    monkeypatch.setattr(diversity, "GENERATIONS", (0, 200))
    table = study_named("thesis-2").run(Effort(quick=True, tables=("diversity",))).tables[0]
    for row in table.records():
        assert 85 < row["after 0"] <= 100
        assert 0 <= row["after 200"] < row["after 0"]


def test_predecessors_are_places():
    problem = Problem.compile(muster.load("6T-2R"))
    assert predecessors(problem, [[2, 0], [5]]).tolist() == [2, -1, 6, -1, -1, 7]


def test_limits_of_processor_time_are_kept():
    outcome = perform(Case(mission="6T-2R", allocator="ipga", time_limit=0.05, processor_time=True), 0)
    assert 0.05 <= outcome.cpu_s < 0.5
    assert outcome.history[-1][1] == outcome.value


@pytest.mark.long
def test_path_planners_are_beside_the_shortest_path():
    pytest.importorskip("shapely")
    report = study_named("thesis-2").run(Effort(seeds=1, tables=("planners",)))
    rows = {row["planner"]: row for row in report.tables[0].records()}
    assert rows["shortest"]["longer %"] == pytest.approx(0.0, abs=1e-9)
    assert all(row["longer %"] >= -1e-6 for row in rows.values() if row["found"])
    incomplete = {name for name, row in rows.items() if row["found"] < row["searches"]}
    assert incomplete <= {"potential-field", "rrt", "dubins"}
    assert rows["dubins"]["sharpest turn"] < rows["a-star"]["sharpest turn"]
