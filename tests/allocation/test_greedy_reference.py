"""Greedy in the core chooses as Algorithm 1 read literally does, where robots have many tasks with dependants ahead."""

import math
from random import Random

import pytest

from muster.allocation.algorithms import greedy
from muster.mission.model import Mission, Robot, Rules, Task
from muster.model.problem import Problem


def mission_of(seed, objective):
    random = Random(seed)

    def point():
        return random.uniform(0, 100), random.uniform(0, 100)

    tasks = [
        Task(
            id=str(k),
            position=point(),
            actuation_cost=random.choice((0.0, 3.0)),
            prerequisites=(str(random.randrange(k)),) if k > 70 else (),
        )
        for k in range(160)
    ]
    robots = [Robot(id=f"r{k}", position=point(), work_capacity=random.choice((None, 250.0))) for k in range(5)]
    return Mission(name="reference", robots=tuple(robots), tasks=tuple(tasks), rules=Rules(objective=objective))


class Reference:
    """Algorithm 1 of [tcf-thesis], 3.2.1, without anything kept from one step to the next."""

    def __init__(self, problem):
        self.problem = problem
        self.at = [robot.position for robot in problem.robots]
        self.used = [0.0] * len(problem.robots)
        self.left = list(range(len(problem.tasks)))
        self.routes = [[] for _ in problem.robots]

    def coefficient(self, j):
        dependants = self.problem.dependants[j]
        if not dependants:
            return 1.0
        if len(dependants) == len(self.left) - 1:
            return 0.0
        place = self.problem.tasks[j].position
        near, far = (
            sum(math.dist(place, self.problem.tasks[k].position) for k in some) / len(some)
            for some in (dependants, [k for k in self.left if k != j])
        )
        return 1.0 - len(dependants) / len(self.left) * (1.0 - near / (near + far))

    def step(self):
        ready = [j for j in self.left if not set(self.problem.prerequisites[j]) & set(self.left)]
        coefficients = {j: self.coefficient(j) for j in ready}
        balanced, best = self.problem.objective != "total", None
        for i, place in enumerate(self.at):
            debits = []
            for j in ready:
                task = self.problem.tasks[j]
                cost = math.dist(place, task.position) + task.actuation_cost
                if self.used[i] + cost <= self.problem.capacity[i]:
                    debits.append((coefficients[j] * cost, j, cost))
            if debits:
                _, j, cost = min(debits)
                offer = cost + (self.used[i] if balanced else 0.0), j, i, cost
                best = offer if best is None else min(best, offer)
        if best is None:
            return False
        _, j, i, cost = best
        self.at[i] = self.problem.tasks[j].position
        self.used[i] += cost
        self.left.remove(j)
        self.routes[i].append(j)
        return True


@pytest.mark.parametrize("objective", ["max", "total"])
@pytest.mark.parametrize("seed", range(4))
def test_the_core_chooses_as_the_published_algorithm(seed, objective):
    problem = Problem.compile(mission_of(seed, objective))
    reference = Reference(problem)
    while reference.step():
        pass
    assert greedy.completed(problem) == reference.routes
