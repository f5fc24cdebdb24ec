"""Lexicographic comparison, gaps, tests and profiles, against what is known or counted by hand."""

import math
from itertools import product

import pytest

from muster_studies.comparison.cells import pair_cells
from muster_studies.comparison.ranking import best_of, gap, order, ratio, typical
from muster_studies.comparison.run import FAILED, NOT_APPLICABLE, Run
from muster_studies.comparison.statistics import (
    holm,
    mean_with_interval,
    pairs_of,
    profiles_of,
    signed_rank,
    standings_of,
)


def run(allocator, value, weight=10.0, mission="m", seed=0, status="done"):
    return Run(
        mission=mission,
        allocator=allocator,
        seed=seed,
        status=status,
        value=value,
        weight_completed=weight,
        weight_total=10.0,
        elapsed_s=1.0,
    )


def test_more_weight_comes_before_a_lower_objective():
    much, cheap, none = run("a", 100.0), run("b", 1.0, weight=9.0), run("c", None, None, status=FAILED)
    assert order(much.rank, cheap.rank) == -1
    assert order(cheap.rank, none.rank) == -1
    assert order(none.rank, none.rank) == 0
    assert order(run("a", 1.0).rank, run("a", 1.0 + 1e-12).rank) == 0
    best = best_of([much, cheap, none])
    assert (best.weight, best.value) == (10.0, 100.0)
    assert [gap(one, best) for one in (much, run("a", 110.0), cheap, none)] == [0.0, pytest.approx(10.0), None, None]
    assert ratio(cheap, best) == math.inf
    assert best_of([none]) is None


def test_the_run_in_the_middle_favours_nobody():
    none = run("c", None, None, status=FAILED)
    assert typical([run("a", value) for value in (4.0, 1.0, 3.0)]) == (-10.0, 3.0)
    assert typical([run("a", value) for value in (4.0, 1.0, 3.0, 2.0)]) == (-10.0, 2.5)
    assert typical([run("a", 4.0), run("a", 1.0, weight=8.0)]) == (-9.0, 2.5)
    assert typical([run("a", 1.0), none]) == typical([run("a", 1.0), none, none]) == (math.inf, math.inf)
    steady = [run("a", 10.0, mission=f"m{k}", seed=seed) for k in range(6) for seed in range(2)]
    noisy = [run("b", value, mission=f"m{k}", seed=seed) for k in range(6) for seed, value in enumerate((9.0, 30.0))]
    (pair,) = pairs_of(steady + noisy, ("a", "b"))
    assert (pair.wins, pair.losses) == (6, 0)


def test_an_objective_of_0_is_no_division():
    best = best_of([run("a", 0.0), run("b", 5.0)])
    assert gap(run("a", 0.0), best) == 0.0
    assert gap(run("b", 5.0), best) == math.inf


def test_late_runs_beside_one_in_time_are_infinitely_worse():
    late = [(0.0, 28.1), (0.0, 43.7), (5.0, 5.5), (0.0, 0.0)]
    runs = [
        run(name, values[k], mission=f"m{j}") for j, values in enumerate(late) for k, name in enumerate(("good", "bad"))
    ]
    good, bad = standings_of(runs, ["good", "bad"])
    assert (good.gap_mean, good.gap_median) == (0.0, 0.0)
    assert (bad.gap_mean, bad.gap_low, bad.gap_high) == (math.inf, None, None)
    assert bad.gap_median == math.inf
    (pair,), (turned,) = pairs_of(runs, ["good", "bad"]), pairs_of(runs, ["bad", "good"])
    assert pair.difference == pytest.approx((-100 - 100 / 11) / 2)
    assert turned.difference == math.inf


def test_holm_is_that_of_the_textbook():
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.6, 0.9]) == [1.0, 1.0]
    assert holm([]) == []


@pytest.mark.parametrize(
    "differences", [[1, 2, 3, 4, 5, 6], [-1, 2, 3, -4, 5], [1, 1, 2, -2, 3], [2, 0, -3, 5, 0, 7, 7]]
)
def test_the_exact_test_counts_all_signs(differences):
    given = [d for d in differences if d]
    sizes = sorted(abs(d) for d in given)
    rank = {size: sum(k + 1 for k, one in enumerate(sizes) if one == size) / sizes.count(size) for size in sizes}
    plus = sum(rank[abs(d)] for d in given if d > 0)
    sums = [
        sum(rank[abs(d)] for d, sign in zip(given, signs, strict=True) if sign)
        for signs in product((0, 1), repeat=len(given))
    ]
    either = min(sum(one <= plus for one in sums), sum(one >= plus for one in sums)) / len(sums)
    assert signed_rank(differences) == (pytest.approx(min(1.0, 2 * either)), True)


def test_without_differences_there_is_none():
    assert signed_rank([0.0, 0.0]) == (1.0, True)
    assert signed_rank([]) == (1.0, True)


def test_many_differences_of_which_some_are_equal_have_an_approximation():
    p_value, exact = signed_rank([1.0] * 20 + [2.0] * 20)
    assert not exact
    assert p_value < 1e-6


def test_standings_count_missions():
    runs = [
        *(run("a", 10.0, mission=name) for name in "xyz"),
        *(run("b", value, mission=name) for name, value in zip("xyz", (11.0, 10.0, 9.0), strict=True)),
        run("c", 5.0, weight=9.0, mission="x"),
        run("c", None, None, mission="y", status=FAILED),
        run("c", None, None, mission="z", status=NOT_APPLICABLE),
    ]
    a, b, c = standings_of(runs, ("a", "b", "c"))
    assert [(one.wins, one.ties, one.losses) for one in (a, b, c)] == [(1, 1, 1), (1, 1, 1), (0, 0, 2)]
    assert (a.gap_mean, a.gap_median) == (pytest.approx(100 / 27), 0.0)
    assert (c.runs, c.failed, c.not_applicable, c.as_much, c.gap_mean) == (2, 1, 1, 0.0, None)
    assert a.gap_low <= a.gap_mean <= a.gap_high
    assert b.gap_mean == pytest.approx((10 + 0 + 0) / 3)
    pair = pairs_of(runs, ("a", "b", "c"), "a")
    assert [(one.allocator, one.other, one.wins, one.ties, one.losses) for one in pair] == [
        ("b", "a", 1, 1, 1),
        ("c", "a", 0, 0, 2),
    ]
    assert pair[0].difference == 0.0


def test_one_allocator_that_is_better_everywhere_is_found_better():
    runs = [run(name, value, mission=f"m{k}") for k in range(8) for name, value in (("a", 10.0), ("b", 11.0 + k))]
    (pair,) = pairs_of(runs, ("a", "b"))
    assert (pair.wins, pair.p_value, pair.exact, pair.units) == (8, pytest.approx(2 / 2**8), True, "missions")


def test_weights_differ_more_than_objectives():
    runs = [run("a", 1.0, mission=f"m{k}") for k in range(5)] + [run("b", 2.0 + k, mission=f"m{k}") for k in range(4)]
    (worse,) = pairs_of([*runs, run("b", 0.5, weight=9.0, mission="m4")], ("a", "b"))
    (better,) = pairs_of(
        [*runs[:4], run("a", 0.5, weight=9.0, mission="m4"), *runs[5:], run("b", 1.0, mission="m4")], ("a", "b")
    )
    assert worse.p_value == pytest.approx(2 / 32)
    assert better.p_value == pytest.approx(2 * 10 / 32)  # the greatest rank, 5, is against the other four, 10


def test_of_a_single_mission_seeds_are_paired():
    runs = [run(name, value + seed, seed=seed) for seed in range(6) for name, value in (("a", 1.0), ("b", 3.0))]
    (pair,) = pairs_of(runs, ("a", "b"))
    assert (pair.units, pair.wins, pair.p_value) == ("seeds", 6, pytest.approx(2 / 64))


def test_seeds_that_change_nothing_are_one_observation():
    runs = [
        run(name, value, seed=seed) for seed in range(10) for name, value in (("a", 1.0), ("b", 3.0), ("c", 2.0 + seed))
    ]
    same, *others = pairs_of(runs, ("a", "b", "c"))
    assert (same.wins, same.ties, same.losses) == (1, 0, 0)
    assert (same.difference, same.p_value, same.p_holm) == (pytest.approx(-200 / 3), None, None)
    assert pair_cells(same)[4:] == ("-", "-", "-")
    assert [sum((one.wins, one.ties, one.losses)) for one in others] == [10, 10]
    assert others[0].p_holm == pytest.approx(2 * 2 / 2**10)  # of two tests, not of three
    _, b, c = standings_of(runs, ("a", "b", "c"))
    assert (b.gap_mean, b.gap_low, b.gap_high) == (pytest.approx(200), None, None)
    assert c.gap_low < c.gap_mean < c.gap_high


def test_allocators_without_a_mission_in_common_are_not_tested():
    runs = [run(name, 1.0 + (name == "b"), mission=f"m{k}") for k in range(8) for name in "ab"]
    runs += [run("c", None, None, mission=f"m{k}", status=NOT_APPLICABLE) for k in range(8)]
    first, *others = pairs_of([*runs, run("c", 1.0, mission="own")], ("a", "b", "c"))
    assert first.p_holm == first.p_value == pytest.approx(2 / 2**8)
    assert [pair_cells(one)[2:] for one in others] == [("0 0 0", "-", "-", "-", "-")] * 2


def test_profiles_are_shares_of_runs_by_ratio():
    runs = [run("a", 10.0, seed=0), run("a", 12.0, seed=1), run("b", 15.0, seed=0), run("b", 1.0, weight=8.0, seed=1)]
    a, b = profiles_of(runs, ("a", "b"))
    assert (a.ratios.tolist(), a.shares.tolist()) == ([1.0, 1.2], [0.5, 1.0])
    assert (b.ratios.tolist(), b.shares.tolist()) == ([1.5], [0.5])


def test_intervals_hold_their_mean():
    mean, low, high = mean_with_interval([1.0, 2.0, 3.0, 4.0, 10.0])
    assert low < mean == 4.0 < high
    assert mean_with_interval([2.0, 2.0]) == (2.0, 2.0, 2.0)
    assert mean_with_interval([2.0]) == (2.0, None, None)
    assert mean_with_interval([]) == (None, None, None)
