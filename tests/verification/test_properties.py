"""The judge against a second, slower judge that walks the routes step by step; and what must hold of every verdict."""

import json
import math
from dataclasses import dataclass, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.ignorable_rules import IGNORABLE
from muster.mission.model import OBJECTIVES, Mission, Robot, Rules, Task, TravelTable
from muster.mission.plan import Plan, Route, Unassigned
from muster.mission.reading.plan_reader import read_plan
from muster.verification import Verdict, verify

NEAR = {"rel_tol": 1e-9, "abs_tol": 1e-9}


# --- random missions and plans ---------------------------------------------------------------------------------------

points = st.tuples(*[st.integers(-5, 5)] * 2)
maybe_points = st.none() | points


@st.composite
def missions(draw) -> Mission:
    """Small missions in which every rule is now and then at work."""
    by_table = draw(st.booleans())
    places = st.none() if by_table else maybe_points
    robots = draw(st.lists(robot_keys(places), min_size=1, max_size=4))
    tasks = draw(st.lists(task_keys(places), min_size=2, max_size=7))
    robots = tuple(Robot(id=f"r_{k}", **keys) for k, keys in enumerate(robots))
    tasks = tuple(draw(linked(Task(id=str(k), **keys), k, len(robots))) for k, keys in enumerate(tasks))
    suitability = {"beta": {"D": 0.6, "E": 0.7}, "tau": {"D": 0.9}} if draw(st.booleans()) else None
    rules = Rules(
        objective=draw(st.sampled_from(OBJECTIVES)),
        usage=draw(st.sampled_from(["distance", "time"])),
        return_to_start=draw(st.booleans()),
        travel="matrix" if by_table else None,
        capacity_reserve=draw(st.sampled_from([0, 0.25])),
    )
    names = [place.id for place in (*robots, *tasks)]
    tables = (
        {kind: TravelTable(tuple(names), draw(distances(len(names)))) for kind in ("beta", "tau")} if by_table else {}
    )
    files = {kind: f"{kind}.csv" for kind in tables} or None
    return Mission(rules=rules, suitability=suitability, robots=robots, tasks=tasks, travel=files, travel_tables=tables)


def robot_keys(places):
    return st.fixed_dictionaries(
        {"position": points, "type": st.sampled_from(["beta", "tau"]), "end_position": places},
        optional={
            "work_capacity": st.integers(0, 40),
            "skills": st.just(("gripper",)),
            "speed_mps": st.sampled_from([0.5, 2]),
            "efficiency": st.sampled_from([0.5, 0.8]),
            "return_to_start": st.booleans(),
            "available_from_s": st.integers(0, 9),
        },
    )


def task_keys(places):
    return st.fixed_dictionaries(
        {"position": points, "type": st.sampled_from("DE"), "entry": places, "exit": places},
        optional={
            "actuation_cost": st.integers(0, 5),
            "duration_s": st.integers(0, 5),
            "priority": st.integers(1, 3),
            "requires": st.just(("gripper",)),
        },
    )


@st.composite
def linked(draw, task: Task, k: int, robots: int) -> Task:
    """The task with prerequisites among those made before it, and now and then a lock."""
    earlier = [str(p) for p in range(k)]
    before = draw(st.lists(st.sampled_from(earlier), unique=True, max_size=2)) if earlier else []
    lock = draw(st.none() | st.none() | st.sampled_from([(f"r_{r}",) for r in range(robots)]))
    return replace(task, prerequisites=tuple(before), only_robots=lock)


def distances(size: int):
    length = st.integers(0, 9) | st.integers(0, 9) | st.integers(0, 9) | st.just(math.inf)
    row = st.tuples(*[length] * size)
    return st.tuples(*[row] * size)


@st.composite
def questions(draw) -> tuple[Mission, Plan]:
    """A mission and a plan from elsewhere: each task in one of the routes or left out."""
    mission = draw(missions())
    routes: dict[str, list[str]] = {robot.id: [] for robot in mission.robots}
    # Half the plans keep the order of the prerequisites, else nearly every plan would deadlock.
    order = list(mission.tasks) if draw(st.booleans()) else draw(st.permutations(mission.tasks))
    for task in order:
        robot = draw(st.sampled_from([*routes, *routes, None]))
        if robot is not None:
            routes[robot].append(task.id)
    ignored = tuple(rule for rule in IGNORABLE if draw(st.integers(0, 4)) == 0)
    return mission, Plan(ignored=ignored, routes=tuple(Route(name, tuple(tasks)) for name, tasks in routes.items()))


# --- the slow judge --------------------------------------------------------------------------------------------------


@dataclass
class Walker:
    """A robot that walks its route, one task at a time."""

    robot: Robot
    left: list[Task]
    at: tuple[float, ...]
    place: str
    clock: float
    travel: float = 0
    work: float = 0
    now_at: str | None = None


class SlowJudge:
    """Lets the robots walk: whoever may begin its next task does; when none may, there is a deadlock."""

    def __init__(self, mission: Mission, plan: Plan) -> None:
        self.mission, self.plan = mission, plan
        self.tasks = {task.id: task for task in mission.tasks}
        self.planned = {name for route in plan.routes for name in route.tasks}
        self.walkers = [
            Walker(robot, [self.tasks[name] for name in route.tasks], robot.position, robot.id, robot.available_from_s)
            for robot, route in zip(mission.robots, plan.routes, strict=True)
        ]
        self.found: set[tuple[str, str | None, str | None]] = set()
        self.ended: dict[str, float] = {}
        self.arrivals: list[float] = []
        self.backs: dict[str, float] = {}
        self.walk()
        self.judge_pairs()

    def walk(self) -> None:
        while any(walker.left for walker in self.walkers):
            free = [
                walker for walker in self.walkers if walker.left and self.awaited(walker.left[0]) <= set(self.ended)
            ]
            if not free:
                self.found.add(("deadlock", None, None))
                # to know the usages of the rest, go on as if there were nothing to wait for
                free = [walker for walker in self.walkers if walker.left]
            for walker in free:
                self.do(walker, walker.left.pop(0))
        for walker in self.walkers:
            self.end(walker)

    def awaited(self, task: Task) -> set[str]:
        return set() if "prerequisite" in self.plan.ignored else set(task.prerequisites) & self.planned

    def do(self, walker: Walker, task: Task) -> None:
        self.go(walker, task.entry or task.position, task.id, task.id)
        self.arrivals.append(walker.travel + walker.work)
        walker.clock = max([walker.clock, *(self.ended.get(name, 0) for name in self.awaited(task))])
        robot = walker.robot
        takes = task.actuation_cost / robot.speed_mps if task.duration_s is None else task.duration_s / robot.efficiency
        walker.clock += takes
        walker.work += takes if self.mission.rules.usage == "time" else task.actuation_cost
        walker.at, walker.now_at = task.exit or task.position, task.id
        self.ended[task.id] = walker.clock

    def go(self, walker: Walker, point: tuple[float, ...], place: str, task: str | None) -> None:
        length = math.sqrt(sum((a - b) ** 2 for a, b in zip(walker.at, point, strict=True)))
        if self.mission.rules.travel == "matrix":
            table = self.mission.travel_tables[walker.robot.type]
            length = table.metres[table.places.index(walker.place)][table.places.index(place)]
        if length == math.inf:
            self.found.add(("unreachable", walker.robot.id, task))
            length = 0
        seconds = length / walker.robot.speed_mps
        walker.clock += seconds
        walker.travel += seconds if self.mission.rules.usage == "time" else length
        walker.at, walker.place = point, place

    def end(self, walker: Walker) -> None:
        robot, rules = walker.robot, self.mission.rules
        returns = rules.return_to_start if robot.return_to_start is None else robot.return_to_start
        if walker.now_at is not None and (robot.end_position is not None or returns):
            self.go(walker, robot.end_position or robot.position, robot.id, None)
            self.backs[robot.id] = walker.clock
        limit = robot.work_capacity
        if limit is not None and "capacity" not in self.plan.ignored:
            most = limit * (1 - rules.capacity_reserve)
            if walker.travel + walker.work > most and not math.isclose(walker.travel + walker.work, most, rel_tol=1e-9):
                self.found.add(("capacity", robot.id, None))

    def judge_pairs(self) -> None:
        for route in self.plan.routes:
            robot = next(robot for robot in self.mission.robots if robot.id == route.robot)
            for task in (self.tasks[name] for name in route.tasks):
                broken = {
                    "skill": not set(task.requires) <= set(robot.skills) and "skill" not in self.plan.ignored,
                    "lock": bool(task.only_robots)
                    and robot.id not in task.only_robots
                    and "lock" not in self.plan.ignored,
                    "suitability": self.score(robot, task) < 0.65 and "suitability" not in self.plan.ignored,
                    "prerequisite": not set(task.prerequisites) <= self.planned
                    and "prerequisite" not in self.plan.ignored,
                }
                self.found |= {(kind, robot.id, task.id) for kind, is_broken in broken.items() if is_broken}

    def score(self, robot: Robot, task: Task) -> float:
        return 1 if self.mission.suitability is None else self.mission.suitability[robot.type].get(task.type, 0)

    def gini(self) -> float:
        """Half the relative mean absolute difference: the definition, which (3.29) is a shorter way to compute."""
        usages = [walker.travel + walker.work for walker in self.walkers]
        if sum(usages) == 0:
            return 0
        return sum(abs(u - v) for u in usages for v in usages) / (2 * len(usages) * sum(usages))


@pytest.mark.long
@given(questions())
def test_the_slow_judge_finds_the_same(question):
    mission, plan = question
    verdict, slow = verify(mission, plan, plan.ignored), SlowJudge(mission, plan)
    assert {(v.kind, v.robot, v.task) for v in verdict.violations} == slow.found
    for route, walker in zip(verdict.routes, slow.walkers, strict=True):
        assert math.isclose(route.travel, walker.travel, **NEAR)
        assert math.isclose(route.work, walker.work, **NEAR)
    usages = [walker.travel + walker.work for walker in slow.walkers]
    assert math.isclose(verdict.total_cost, sum(usages), **NEAR)
    assert math.isclose(verdict.max_usage, max(usages), **NEAR)
    assert math.isclose(verdict.average, sum(slow.arrivals) / max(1, len(slow.arrivals)), **NEAR)
    assert math.isclose(verdict.equality_index, 1 - slow.gini(), **NEAR)
    assert verdict.weight_completed == sum(task.priority for task in mission.tasks if task.id in slow.planned)
    if ("deadlock", None, None) in slow.found:
        assert verdict.makespan_s is None
        return
    ends = {visit.task: visit.ends_s for route in verdict.routes for visit in route.visits}
    assert ends.keys() == slow.ended.keys()
    assert all(math.isclose(ends[task], slow.ended[task], **NEAR) for task in ends)
    assert math.isclose(verdict.makespan_s, max(slow.ended.values(), default=0), **NEAR)
    assert {route.robot for route in verdict.routes if route.back_s is not None} == slow.backs.keys()
    assert all(math.isclose(r.back_s, slow.backs[r.robot], **NEAR) for r in verdict.routes if r.back_s is not None)


# --- what must hold of every verdict ---------------------------------------------------------------------------------


def summary(verdict: Verdict) -> tuple[list[tuple[str, str, str]], list[float]]:
    """What does not depend on the order of robots: violations, sorted, and figures."""
    found = sorted((v.kind, v.robot or "", v.task or "") for v in verdict.violations)
    figures = [verdict.value(name) for name in OBJECTIVES] + [verdict.equality_index, verdict.weight_completed]
    return found, [-1 if figure is None else figure for figure in figures]


@pytest.mark.long
@given(questions(), st.randoms(use_true_random=False))
def test_the_order_of_robots_tasks_and_routes_changes_nothing(question, random):
    mission, plan = question
    robots, tasks, routes = list(mission.robots), list(mission.tasks), list(plan.routes)
    for items in (robots, tasks, routes):
        random.shuffle(items)
    found, figures = summary(verify(mission, plan, plan.ignored))
    mixed = verify(
        replace(mission, robots=tuple(robots), tasks=tuple(tasks)), replace(plan, routes=tuple(routes)), plan.ignored
    )
    found_mixed, figures_mixed = summary(mixed)
    assert found == found_mixed
    assert all(math.isclose(a, b, **NEAR) for a, b in zip(figures, figures_mixed, strict=True))
    assert [route.robot for route in mixed.routes] == [robot.id for robot in robots]


def stating(mission: Mission, plan: Plan, verdict: Verdict) -> Plan:
    """The plan with all the figures of the verdict, and the list of what it leaves out."""
    usages = {route.robot: route.usage for route in verdict.routes}
    done = {task for route in plan.routes for task in route.tasks}
    return replace(
        plan,
        objective=verdict.objective_name,
        objective_value=verdict.value(),
        usage_unit=verdict.usage_unit,
        total_cost=verdict.total_cost,
        max_usage=verdict.max_usage,
        makespan_s=verdict.makespan_s,
        equality_index=verdict.equality_index,
        tasks_completed=verdict.tasks_completed,
        tasks_total=verdict.tasks_total,
        weight_completed=verdict.weight_completed,
        lower_bound=verdict.value(),
        routes=tuple(replace(route, usage=usages[route.robot]) for route in plan.routes),
        unassigned=tuple(Unassigned(task.id, ()) for task in mission.tasks if task.id not in done),
    )


@given(questions())
def test_a_plan_that_states_what_the_judge_found_states_nothing_false(question):
    mission, plan = question
    verdict = verify(mission, plan, plan.ignored)
    assert verify(mission, stating(mission, plan, verdict), plan.ignored) == verdict


@given(questions(), st.data())
def test_any_figure_that_is_changed_is_found(question, data):
    mission, plan = question
    verdict = verify(mission, plan, plan.ignored)
    honest = stating(mission, plan, verdict)
    names = ("total_cost", "max_usage", "makespan_s", "equality_index", "weight_completed", "tasks_completed")
    name = data.draw(st.sampled_from(names))
    stated = (getattr(honest, name) or 0) + data.draw(st.sampled_from([-1, 1, 100]))
    (false,) = set(verify(mission, replace(honest, **{name: stated}), plan.ignored).violations) - set(
        verdict.violations
    )
    assert false.kind == "figure"
    assert false.detail.startswith(f"{name}: ")


@pytest.mark.long
@given(questions())
def test_a_verdict_is_json_without_infinities(question):
    data = verify(*question).as_dict()
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    assert data.keys() >= {"valid", "violations", "objective", "total_cost", "max_usage", "makespan_s"}


@given(questions())
def test_bounds_between_figures(question):
    mission, plan = question
    verdict = verify(mission, plan, plan.ignored)
    slack = 1 + 1e-9
    assert verdict.max_usage <= verdict.total_cost * slack
    assert verdict.total_cost <= verdict.max_usage * len(mission.robots) * slack
    assert verdict.average <= verdict.max_usage * slack
    assert 1 / len(mission.robots) - 1e-9 <= verdict.equality_index <= 1 + 1e-9
    for route in verdict.routes:
        for visit in route.visits:
            assert route.leaves_s <= visit.arrives_s <= visit.starts_s <= visit.ends_s <= verdict.makespan_s


@given(questions())
def test_ignoring_rules_adds_no_violation(question):
    mission, plan = question
    strict = set(verify(mission, plan).violations)
    lax = set(verify(mission, plan, IGNORABLE).violations)
    assert lax <= strict
    assert {violation.kind for violation in lax} <= {"unreachable"}


@given(questions(), st.sampled_from(["r_0", "ghost"]), st.sampled_from(["0", "nothing"]))
def test_what_does_not_exist_or_repeats_is_named_and_left_out(question, robot, task):
    mission, plan = question
    spoilt = replace(plan, routes=(*plan.routes, Route(robot, (task,))))
    before, after = verify(mission, plan, plan.ignored), verify(mission, spoilt, plan.ignored)
    kind = "unknown-robot" if robot == "ghost" else "repeated-robot"
    assert {(v.kind, v.robot) for v in set(after.violations) - set(before.violations)} == {(kind, robot)}
    assert after.routes == before.routes


def test_a_random_plan_survives_its_file(tmp_path):
    @given(questions())
    def survives(question):
        mission, plan = question
        honest = stating(mission, plan, verify(mission, plan, plan.ignored))
        honest.save(tmp_path / "plan.json")
        assert verify(mission, read_plan(tmp_path / "plan.json")) == verify(mission, honest)

    survives()
