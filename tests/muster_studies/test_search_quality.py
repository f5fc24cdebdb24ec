"""The cases of `muster bench --only search`, in short."""

from dataclasses import replace

import pytest

from muster_studies.benches.search_quality import CASES, Case, Quality, quality


@pytest.mark.long
@pytest.mark.parametrize("case", [c for c in CASES if c.mission == "16T-3R"], ids=lambda case: case.name)
def test_the_best_known_plans_of_a_small_mission_are_found(case):
    found = quality(case, seeds=2, iterations=20_000)
    assert found.reached == 2
    assert found.gaps == pytest.approx([0, 0], abs=0.01)


@pytest.mark.long
def test_what_the_best_known_plan_leaves_out_may_be_left_out():
    case = next(case for case in CASES if case.mission == "flood")
    assert quality(case, seeds=1, iterations=120_000).reached == 1
    assert quality(replace(case, weight=125.0), seeds=1, iterations=100).values == (float("inf"),)


def test_no_two_cases_are_the_same():
    assert len({case.name for case in CASES}) == len(CASES) == 35


def test_a_plan_that_leaves_something_out_reaches_nothing():
    found = Quality(Case("16T-3R", "total+max", 100.0, 1.0), (100.0, float("inf"), 101.0))
    assert found.reached == 1
    assert found.gaps == pytest.approx([0.0, float("inf"), 1.0])
