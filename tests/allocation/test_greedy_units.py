"""Timed greedy chooses at each step as if it looked at every unit of work, and plans missions of any size."""

import math

import pytest
from tests.timed_missions.missions import OBJECTIVES, timed_mission

import muster
from muster import core
from muster.allocation.algorithms import greedy
from muster.allocation.working_roster import WorkingRoster
from muster.model.problem import Problem


class Reference:
    """Algorithm 1 of [tcf-thesis], 3.2.1, for units, without anything kept from one step to the next."""

    def __init__(self, problem):
        self.problem = problem
        self.roster = WorkingRoster(problem)

    def debit(self, insertion):
        if self.problem.objective in ("makespan", "lateness"):
            return insertion.score
        return insertion.growth + (self.roster.usage(insertion) if self.problem.objective != "total" else 0.0)

    def step(self, refused):
        best, least = None, math.inf
        for unit in self.roster.ready():
            insertion = None if unit in refused else self.roster.best(unit)
            if insertion is not None and insertion.unit not in refused and self.debit(insertion) < least:
                best, least = insertion, self.debit(insertion)
        return best

    def routes(self):
        refused = set()
        while (insertion := self.step(refused)) is not None:
            refused = set() if self.roster.put(insertion) else {*refused, insertion.unit}
        self.roster.finish()
        return self.roster.routes


def timed_problems(seeds, missions):
    for seed in seeds:
        for objective in OBJECTIVES:
            problem = Problem.compile(missions(seed), objective)
            if problem.core.is_timed and not any(robot.min_tasks > 1 for robot in problem.robots):
                yield problem


FAMILIES = {
    "timed": lambda seed: timed_mission(seed, tasks=14, robots=4),
    "logistics": lambda seed: muster.generate("logistics", seed=seed, tasks=40, robots=5)[0],
    "with relations": lambda seed: timed_mission(1000 + seed, tasks=9, robots=3),
    "transports": lambda seed: muster.generate("transports", seed=seed, transports=10)[0],
    "charging": lambda seed: muster.generate("charging", seed=seed, customers=10)[0],
}


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("family", FAMILIES)
def test_what_is_kept_from_step_to_step_changes_no_plan(family):
    problems = list(timed_problems(range(8), FAMILIES[family]))
    assert len(problems) > 10
    for problem in problems:
        assert greedy.completed(problem) == Reference(problem).routes(), (problem.mission.name, problem.objective)


@pytest.mark.long
@pytest.mark.parametrize("objective", ["total", "total+max", "makespan", "lateness"])
def test_a_run_that_is_not_thorough_plans_about_as_well(objective, monkeypatch):
    (mission,) = muster.generate("logistics", tasks=200, robots=10)
    thorough = muster.solve(mission, "greedy", objective=objective)
    monkeypatch.setattr(greedy, "MOST_TASKS_OF_A_THOROUGH_RUN", 100)
    near = muster.solve(mission, "greedy", objective=objective)
    assert muster.verify(mission, near, objective=objective).valid
    assert near.tasks_completed >= 0.97 * thorough.tasks_completed
    per_task = [plan.objective_value / plan.tasks_completed for plan in (near, thorough)]
    assert per_task[0] <= 1.15 * per_task[1] + 1e-9


def test_it_goes_on_until_nothing_fits():
    (mission,) = muster.generate("logistics", tasks=120, robots=3, teams=0.3)
    problem = Problem.compile(mission)
    for thorough in (True, False):
        roster = WorkingRoster(problem)
        run = core.UnitGreedy(roster.core, range(3), thorough=thorough)
        while run.append_one():
            pass
        assert not run.append_one()
        assert all(roster.best(unit) is None for unit in roster.ready())
        assert sum(map(len, roster.routes)) > 40


def test_only_the_chosen_robots_get_tasks():
    (mission,) = muster.generate("logistics", tasks=60, robots=5)
    roster = WorkingRoster(Problem.compile(mission))
    run = core.UnitGreedy(roster.core, [1, 3], thorough=True)
    while run.append_one():
        pass
    assert [bool(route) for route in roster.routes] == [False, True, False, True, False]


@pytest.mark.long
def test_ten_thousand_tasks_are_planned():
    (mission,) = muster.generate("logistics", tasks=10_000, robots=100)
    plan = muster.solve(mission, "greedy")
    assert muster.verify(mission, plan).valid
    assert plan.tasks_completed > 9_500
