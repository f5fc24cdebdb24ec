"""Plans annealed side by side: the better ones go on, and threads that would be idle work out children."""

from dataclasses import dataclass, field

import pytest

from muster.allocation.search.side_by_side import SideBySide


@dataclass
class Fake:
    """Finds a plan of this objective, whose only task is its number."""

    number: int
    best_objective: float
    best_weight_left_out: float = 0.0
    best_tie: float = 0.0
    steps: int = 0
    begun_from: list[list[list[int]]] = field(default_factory=list)

    @property
    def best(self) -> list[list[int]]:
        return [[self.number]]

    def anneal(self, steps: int, hot: float, cold: float) -> None:
        self.steps += steps

    def go_on_from(self, routes: list[list[int]]) -> None:
        self.begun_from.append(routes)


def children(routes: list[list[int]], other: list[list[int]]) -> list[list[int]]:
    return [*routes, *other]


def run(objectives: list[float], *, plans: int, busy: int = 1, steps: int = 1200, turns: int = 300):
    fakes = [Fake(k, objective) for k, objective in enumerate(objectives)]
    with SideBySide(lambda k: fakes[k], plans=plans, busy=busy, threads=2, cross=children) as searches:
        for turn in range(turns):
            searches.anneal(steps, 1.0)
            searches.go_on((turn + 1) / turns)
        return fakes, searches.best


def test_the_better_half_goes_on_and_has_the_steps_of_the_others():
    fakes, best = run([4.0, 2.0, 3.0, 1.0], plans=4)
    assert best is fakes[3]
    a_third = 100 * 1200
    assert [fake.steps for fake in fakes] == [a_third / 4, a_third * 3 / 4, a_third / 4, a_third * 7 / 4]
    assert not any(fake.begun_from for fake in fakes)


def test_a_plan_that_does_more_is_better():
    fakes = [Fake(0, 1.0, best_weight_left_out=2.0), Fake(1, 9.0)]
    with SideBySide(lambda k: fakes[k], plans=2, busy=1, threads=1, cross=children) as searches:
        searches.go_on(0.5)
        searches.anneal(10, 1.0)
    assert [fake.steps for fake in fakes] == [0, 10]


def test_idle_threads_work_out_children_and_at_last_the_best():
    fakes, _ = run([4.0, 2.0, 3.0, 1.0], plans=4, busy=2)
    assert [len(fake.begun_from) for fake in fakes] == [0, 1 + 6, 0, 0]
    assert fakes[1].begun_from[0] == [[3], [1]]  # of the best and the plan given up
    assert fakes[1].begun_from[1:] == [[[3]]] * 6


@pytest.mark.parametrize("busy", [1, 3])
def test_one_plan_is_never_given_up(busy):
    fakes, _ = run([1.0, 2.0, 3.0][:busy], plans=1, busy=busy)
    assert {fake.steps for fake in fakes} == {300 * 1200 / busy}


def test_more_threads_than_plans_have_a_search_each():
    fakes, _ = run([4.0, 2.0, 3.0, 1.0, 5.0], plans=2, busy=5)
    assert all(fake.steps for fake in fakes)
