"""The rest of a mission, planned again."""

from dataclasses import replace

import pytest
from tests.execution.world import World
from tests.random_missions import random_mission, with_travel_tables

import muster
from muster.allocation import fixed
from muster.allocation.algorithms import greedy
from muster.allocation.fixed import admissible_part
from muster.execution.executor import Executor
from muster.execution.replanning.reallocation import Reallocation, reasons_in_one_line
from muster.execution.replanning.remaining_problem import remaining_problem
from muster.execution.replanning.travel import travel_of, way_of
from muster.generation.uniform import large_mission
from muster.mission.model import Action, Event, Map, Mission, Robot, Rules, Task, Zone
from muster.mission.plan import Reason
from muster.model.problem import Problem


class Kept(Reallocation):
    """Remembers what it was asked."""

    def __call__(self, rest):
        asked.append(rest)
        return super().__call__(rest)


asked = []


def under_way(mission, *, seed=0, share=0.4, step=0.25, **options):
    """An executor part of the way through a greedy plan, and its world."""
    plan = muster.solve(mission, "greedy")
    world, travel = World(mission), travel_of(mission)
    executor = Executor(mission, plan, world.ports, travel=travel, replan=Kept(travel=travel, seed=seed, **options))
    executor.tick(0.0)
    while world.now < share * plan.makespan_s:
        world.step(step)
        executor.tick(world.now)
    asked.clear()
    return executor, world


def busiest(executor):
    return max(executor.crew, key=lambda name: len(executor.crew[name].route))


def after_a_failure(mission, **options):
    executor, world = under_way(mission, **options)
    out = busiest(executor)
    before = {name: robot for robot, state in executor.crew.items() for name in state.route}
    executor.report(Event(at_s=0, robot_fails=out))
    executor.tick(world.now)
    return executor, out, before


def test_greedy_plans_all_that_is_left_afresh():
    executor, out, _ = after_a_failure(muster.load("31T-6R50"), allocator=greedy.GREEDY, parameters=greedy.Parameters())
    problem = remaining_problem(asked[-1], travel_of(executor.mission)).problem.ready()
    beginnings = [problem.beginning(i) for i in range(len(problem.robots))]
    afresh = greedy.completed(problem, [list(beginning) for beginning in beginnings])
    names = {
        robot.id: tuple(problem.tasks[j].id for j in route[len(beginning) :])
        for robot, route, beginning in zip(problem.robots, afresh, beginnings, strict=True)
    }
    assert out not in names
    assert executor.revisions[-1].routes == names


def figures(problem, revision):
    routes = [
        [*problem.beginning(i), *(problem.task_index[name] for name in revision.routes[robot.id])]
        for i, robot in enumerate(problem.robots)
    ]
    return problem.value(routes)


def test_a_failure_among_20_robots_and_100_tasks_is_answered_better_than_by_greedy():
    mission = large_mission(100, 20)
    executor, out, before = after_a_failure(mission, step=2.0)
    problem = remaining_problem(asked[0], travel_of(mission)).problem
    weight, value = figures(problem, executor.revisions[0])
    by_greedy = problem.value(greedy.completed(problem, [list(route) for route in problem.fixed]))
    still = [
        [*problem.beginning(i), *(problem.task_index[name] for name in asked[0].routes[robot.id])]
        for i, robot in enumerate(problem.robots)
    ]
    by_insertion = problem.value(greedy.completed(problem, still))
    assert weight == by_greedy[0] == by_insertion[0]
    assert value < min(by_greedy[1], by_insertion[1])
    freed = {name for name, robot in before.items() if robot == out}
    assert len(freed) > 3
    assert {name: pair[0] for name, pair in executor.revisions[0].moved.items() if name in freed} == dict.fromkeys(
        freed, out
    )


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("stability", [0, 1, 3])
def test_no_more_tasks_change_robot_than_the_rules_let(stability):
    """The plan is made badly before, so that a free search would move much more."""
    mission = large_mission(30, 4)
    plan = muster.solve(mission, "greedy")
    names = [task.id for task in mission.tasks]
    bad = replace(plan, routes=tuple(replace(r, tasks=tuple(names[k::4])) for k, r in enumerate(plan.routes)))
    moved = {}
    for rule in (stability, None):
        ruled = replace(mission, rules=replace(mission.rules, stability=rule))
        world = World(ruled)
        executor = Executor(ruled, bad, world.ports)
        executor.tick(0.0)
        executor.report(Event(at_s=0, cancel_task=names[0]))
        executor.tick(0.0)
        moved[rule] = executor.revisions[0].moved
        assert not executor.revisions[0].forced
    assert len(moved[stability]) == stability
    assert len(moved[None]) > 10


@pytest.mark.long
def test_usages_of_the_rest_are_those_of_the_whole_mission():
    """What was used and what is left make up the plan's usage: nothing has changed, so it can only become less."""
    judged = 0
    for seed in range(60):
        mission = random_mission(seed, tasks=8, robots=3, objective="total", usage="distance")
        mission = replace(mission, tasks=tuple(replace(task, entry=None, exit=None) for task in mission.tasks))
        executor, world = under_way(mission, share=0.1 * (seed % 9))
        revision = executor._replan(executor._rest())
        if revision.added or revision.dropped:
            continue
        works = {name: state.activity.value == "working" for name, state in executor.crew.items()}
        used = {n: h.used_after(world.now) if works[n] else h.used for n, h in executor.crew.items()}
        total = sum(used[name] + revision.ahead[name][""] for name in executor.crew)
        assert total <= sum(executor.usage_planned.values()) + 1e-6
        assert total >= 0.5 * sum(executor.usage_planned.values())
        judged += 1
    assert judged > 30


def test_the_same_rest_gives_the_same_plan():
    mission = large_mission(40, 5)
    first, second = (after_a_failure(mission, step=2.0, seed=7)[0] for _ in range(2))
    assert first.revisions == second.revisions


@pytest.mark.parametrize("seed", range(15))
def test_travel_tables_hold_from_where_robots_are(seed):
    mission = with_travel_tables(random_mission(seed, tasks=7, robots=3), seed)
    executor, _, _ = after_a_failure(mission, share=0.3)
    if asked and asked[0].crew:
        problem = remaining_problem(asked[0], travel_of(mission)).problem
        for snapshot in asked[0].crew:
            i, table = problem.robot_index[snapshot.robot.id], mission.travel_tables[snapshot.robot.type]
            row = table.metres[table.places.index(snapshot.spot.name)]
            for j, task in enumerate(problem.tasks):
                if task.id in table.places and snapshot.task != task.id:
                    speed = snapshot.robot.speed_mps if problem.in_time else 1
                    assert problem.legs(i, [problem.start(i)], [j])[0, 0] == row[table.places.index(task.id)] / speed
    assert set(executor.ledger.ends_s) | set(executor.lost()) | {
        name for state in executor.crew.values() for name in state.route
    } == {task.id for task in mission.tasks}


@pytest.mark.long
@pytest.mark.parametrize("name", ["floor", "yard"])
def test_over_a_map_a_failed_robots_work_is_done_by_the_others(name):
    mission = muster.load(name)
    executor, out, before = after_a_failure(mission)
    problem = remaining_problem(asked[0], executor._travel).problem
    straight = [snapshot.spot.point for snapshot in asked[0].crew]
    assert all(len(point) == 3 for point in straight)
    assert problem.travel[0].size > 0
    moved = executor.revisions[0].moved
    assert {task for task, robot in before.items() if robot == out} <= set(moved) | set(executor.lost())


@pytest.mark.parametrize("seed", range(20))
def test_the_admissible_part_of_routes_is_admissible_and_in_order(seed):
    mission = random_mission(seed, tasks=12, robots=3)
    problem = Problem.compile(mission)
    routes = [list(range(i, 12, 3)) for i in range(3)]
    part = admissible_part(problem, routes)
    plan = muster.Plan(
        routes=tuple(
            muster.Route(r.id, tuple(problem.tasks[j].id for j in route))
            for r, route in zip(problem.robots, part, strict=True)
        )
    )
    assert not [v for v in muster.verify(mission, plan).violations if v.kind not in ("unassigned", "figure")]
    for whole, kept in zip(routes, part, strict=True):
        assert [j for j in whole if j in kept] == kept


@pytest.mark.parametrize("deadline_s", [None, 5000.0, 40.0])
@pytest.mark.parametrize("after", [(), ("t2",)])
def test_routes_that_fit_are_kept_without_looking_at_each_task(monkeypatch, deadline_s, after):
    mission = Mission(
        robots=tuple(Robot(id=f"r{k}", position=(5.0 * k, 0.0)) for k in range(2)),
        tasks=tuple(
            Task(
                id=f"t{k}",
                position=(7.0 * k % 20, 3.0 * k % 11),
                deadline_s=deadline_s,
                prerequisites=after if k == 5 else (),
            )
            for k in range(8)
        ),
        rules=Rules(objective="lateness"),
    )
    problem = Problem.compile(mission)
    routes = [[0, 2, 4, 6], [7, 5, 3, 1]]
    part = admissible_part(problem, routes)
    assert sum(map(len, part)) == 8 or deadline_s == 40.0
    monkeypatch.setattr(fixed, "_is_untied", lambda problem: False)
    assert admissible_part(problem, routes) == part


def test_of_routes_with_goods_who_picks_up_still_delivers():
    (mission,) = muster.generate("transports", transports=6, seed=2)
    problem = Problem.compile(mission).ready()
    plan = muster.solve(mission, "search", iterations=300, seed=1)
    routes = [[problem.task_index[name] for name in route.tasks] for route in plan.routes]
    assert plan.tasks_completed == plan.tasks_total
    assert admissible_part(problem, routes) == routes


def test_reasons_are_given_together():
    reasons = (Reason("a", "skill", "lacks x"), Reason("b", "lock", "only c"), Reason("c", "skill", "lacks x"))
    assert reasons_in_one_line(reasons) == "skill: lacks x (a, c); lock: only c (b)"


def walled_rest(*tasks, delays=(), **rules):
    """The problem of a robot of 1 m/s after 1 s beside a wall from y = 4 to 16; and the whole mission's."""
    wall = Zone(polygon=((14, 4), (15, 4), (15, 16), (14, 16)))
    arena = Map(boundary=((0, 0), (30, 0), (30, 20), (0, 20)), zones=(wall,))
    mission = muster.Mission(
        robots=(muster.Robot(id="r", position=(3.0, 3.0), radius_m=0.3, efficiency=0.5),),
        tasks=(muster.Task(id="first", position=(3.0, 10.0)), *tasks),
        map=arena,
        rules=muster.Rules(**rules),
    )
    world, travel = World(mission), travel_of(mission)
    plan = muster.Plan(routes=(muster.Route("r", tuple(task.id for task in mission.tasks)),))
    executor = Executor(mission, plan, world.ports, travel=travel, way=way_of(mission))
    executor.tick(0.0)
    world.step(1.0)
    executor.tick(1.0)
    for name, by_s in delays:
        executor.ledger.delay(name, by_s)
    return remaining_problem(executor._rest(), travel).problem, Problem.compile(mission)


PATROL = muster.Task(id="x", position=(14.5, 10), action=Action(name="ground-patrol", side_m=8))
PARCEL = muster.Task(id="x", position=(20, 10), action=Action(name="delivery", pickup=(10, 10)), duration_s=50)
PROBE = muster.Task(id="x", position=(20, 10), action=Action(name="sensor-activation", duration_s=8))
PLAIN = muster.Task(id="x", position=(20, 10), actuation_cost=5)


@pytest.mark.parametrize("task", [PATROL, PARCEL, PROBE, PLAIN], ids=lambda task: str(task.action and task.action.name))
@pytest.mark.parametrize("usage", ["distance", "time"])
def test_the_rest_has_the_ways_and_times_of_actions_over_the_map(task, usage):
    """As the whole mission has them, and a delay on top of the time."""
    rest, whole = walled_rest(task, usage=usage)
    a, b = rest.task_index["x"], whole.task_index["x"]
    assert rest.work_usage(0)[a] == pytest.approx(whole.work_usage(0)[b])
    first = [problem.task_index["first"] for problem in (rest, whole)]
    assert rest.legs(0, first[:1], [a]) == pytest.approx(whole.legs(0, first[1:], [b]))
    assert rest.legs(0, [a], [rest.end(0)]).shape == (1, 1)
    late, _ = walled_rest(task, usage=usage, delays=[("x", 12)])
    assert late.work_seconds(0)[a] == pytest.approx(whole.work_seconds(0)[b] + 12)
    assert late.measured.costs[0, a] == rest.measured.costs[0, a]


def test_a_part_of_the_rest_has_its_ways():
    rest, _ = walled_rest(PARCEL)
    parted = rest.part([0], range(len(rest.tasks)))
    assert (parted.travel[0] == rest.travel[0]).all()
    assert (parted.measured.costs == rest.measured.costs).all()
