"""The incremental schedule against one that is worked out from nothing."""

import json
import math
import random
from pathlib import Path

import pytest

import muster
from muster import core
from muster.mission.model import Mission, Robot
from muster.model.problem import Problem

_PLACES = 30.0


def random_mission(draw: random.Random, objective: str, folder: Path, *, resting: bool = False) -> Mission:
    """A small mission with every rule of time, team and relation; `resting`: with breaks and longest duties too."""
    robots = [
        {"id": f"r{i}", "position": _place(draw), "abilities": {"lift": draw.randint(1, 2)}} for i in range(4)
    ] + [{"id": "late", "position": _place(draw), "available_from_s": 20, "available_until_s": 400}]
    if resting:
        robots[0] |= {"shifts_s": [[5, 25], [40, 90], [100, None]], "end_position": _place(draw)}
        robots[1] |= {"longest_duty_s": draw.uniform(40, 120)}
        robots[2] |= {"shifts_s": [[0, 60], [70, 120], [130, 500]], "longest_duty_s": draw.uniform(60, 150)}
    tasks = [_task(draw, k) for k in range(10)]
    rules = {"objective": objective, "return_to_start": draw.random() < 0.5, "timing": "constant"}
    path = folder / "m.yaml"
    path.write_text(json.dumps({"schema": "muster/1", "name": "m", "rules": rules, "robots": robots, "tasks": tasks}))
    return muster.load(path)


def _place(draw: random.Random) -> list[float]:
    return [draw.uniform(0, _PLACES), draw.uniform(0, _PLACES)]


def _task(draw: random.Random, k: int) -> dict[str, object]:
    task: dict[str, object] = {"id": f"t{k}", "position": _place(draw), "duration_s": draw.uniform(1, 20)}
    if draw.random() < 0.4:
        opens = draw.uniform(0, 100)
        task["window_s"] = [[opens, opens + draw.uniform(5, 60)], [opens + 100, opens + 200]]
    if draw.random() < 0.2:
        task["deadline_s"] = draw.uniform(60, 300)
    if draw.random() < 0.3:
        task["due_s"] = draw.uniform(10, 100)
    if k >= 2 and draw.random() < 0.4:
        lag: dict[str, object] = {"task": f"t{draw.randrange(k - 1)}", "after_s": draw.choice([0, 5])}
        if draw.random() < 0.5:
            lag["within_s"] = draw.uniform(20, 80)
        task["prerequisites"] = [lag]
    kind = draw.random()
    if kind < 0.2:
        task["robots_needed"] = 2
    elif kind < 0.4:
        task["needs"] = {"lift": 3}
    elif kind < 0.5 and k:
        task["other_robot_than"] = f"t{k - 1}"
    return task


def least_schedule(problem: Problem, routes: list[list[int]]) -> dict[int, float] | None:
    """When each task begins, by raising all lower bounds until nothing moves; None if that never ends."""
    present = {j for route in routes for j in route}
    teams = {j: [i for i, route in enumerate(routes) if j in route] for j in present}
    work = {j: max(problem.work_seconds(i)[j] for i in team) for j, team in teams.items()}
    begin = dict.fromkeys(present, 0.0)
    for _ in range(300):
        bounds = {j: _raised(problem, routes, begin, work, j) for j in present}
        if bounds == begin:
            return begin
        begin = bounds
    return None


def _raised(
    problem: Problem, routes: list[list[int]], begin: dict[int, float], work: dict[int, float], j: int
) -> float:
    bound, task = begin[j], problem.tasks[j]
    for i, route in enumerate(routes):
        if j not in route:
            continue
        at, robot = route.index(j), problem.robots[i]
        place = problem.tasks[route[at - 1]].position if at else robot.position
        leaves = begin[route[at - 1]] + work[route[at - 1]] if at else _departure(problem, route, begin, work, i)
        way = math.dist(place, task.position) / robot.speed_mps
        bound = max(bound, _free(robot, leaves, way) + way)
        bound = max(bound, _free(robot, bound, work[j]))
    for k in problem.prerequisites[j]:
        bound = max(bound, begin[k] + work[k] + task.lag(problem.tasks[k].id).after_s)
    for k in problem.dependants[j]:
        within = problem.tasks[k].lag(task.id).within_s
        if k in begin and within is not None:
            bound = max(bound, begin[k] - within - work[j])
    for low, high in task.window_s:
        if high is None or bound <= high:
            return max(bound, low)
    return math.inf if task.window_s else bound


def _departure(problem: Problem, route: list[int], begin: dict[int, float], work: dict[int, float], i: int) -> float:
    """When a robot leaves its start, so that it is at its end soon enough after that."""
    robot, last = problem.robots[i], route[-1]
    end = robot.place_at_end(problem.mission.rules)
    way = 0.0 if end is None else math.dist(problem.tasks[last].position, end) / robot.speed_mps
    back = _free(robot, begin[last] + work[last], way) + way
    return max(robot.available_from_s, back - (robot.longest_duty_s or math.inf))


def _free(robot: Robot, time: float, seconds: float) -> float:
    """From when on a shift of a robot lasts so long."""
    begins = (max(time, first) for first, last in robot.shifts_s if max(time, first) + seconds <= (last or math.inf))
    return next(begins, math.inf) if robot.shifts_s else time


def _begins(roster: core.Roster) -> dict[int, float]:
    return {task: begin for row in roster.stops for task, _, begin, _ in row}


def _check(problem: Problem, roster: core.Roster) -> None:
    expected = least_schedule(problem, roster.routes)
    assert expected is not None
    assert _begins(roster) == pytest.approx(expected, abs=1e-6)
    fresh = core.Inspection(problem.core, roster.routes)
    assert fresh.admissible
    assert fresh.objective == pytest.approx(roster.objective)


@pytest.mark.long(keep=12)
@pytest.mark.parametrize("objective", ["total", "makespan", "lateness", "total+max"])
@pytest.mark.parametrize("resting", [False, True])
@pytest.mark.parametrize("seed", range(12))
def test_schedule_after_random_changes_is_the_earliest(
    seed: int, resting: bool, objective: str, tmp_path: Path
) -> None:
    draw = random.Random(seed)
    problem = Problem.compile(random_mission(draw, objective, tmp_path, resting=resting))
    roster = core.Roster(problem.core)
    assert roster.begin([[] for _ in problem.robots])
    for _ in range(60):
        before = roster.routes, _begins(roster), sorted(roster.absent)
        possible = all(_change(draw, problem, roster) for _ in range(draw.randint(1, 4)))
        if possible and draw.random() < 0.7:
            _check(problem, roster)
            roster.commit()
        else:
            roster.rollback()
            assert (roster.routes, _begins(roster), sorted(roster.absent)) == before


def _change(draw: random.Random, problem: Problem, roster: core.Roster) -> bool:
    """Take a task out with all that waits for it, or put one in; False where that leaves no schedule."""
    unit = draw.randrange(len(problem.tasks))
    if unit not in roster.absent:
        return _remove(problem, roster, unit)
    if not roster.ready(unit):
        return True
    insertion = roster.best_insertion(unit, append_only=draw.random() < 0.2)
    return insertion is None or roster.insert(insertion)


def _remove(problem: Problem, roster: core.Roster, unit: int) -> bool:
    waiting = [k for k in problem.dependants[unit] if k not in roster.absent]
    return all(_remove(problem, roster, k) for k in waiting if k not in roster.absent) and roster.remove(unit)


@pytest.mark.parametrize("resting", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_search_finds_admissible_plans(seed: int, resting: bool, tmp_path: Path) -> None:
    problem = Problem.compile(random_mission(random.Random(seed), "makespan", tmp_path, resting=resting))
    search = core.ScheduleSearch(
        problem.core,
        [[] for _ in problem.robots],
        seed,
        removed=5.0,
        longest_string=10,
        blink=0.01,
        greatest_share=0.8,
        near=12,
    )
    search.anneal(300, 10.0, 0.1)
    inspection = core.Inspection(problem.core, search.best)
    assert inspection.admissible
    assert inspection.objective == pytest.approx(search.best_objective)
    assert least_schedule(problem, search.best) is not None
