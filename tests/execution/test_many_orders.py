"""Orders among many: planned with few robots, as well as with all; and changes of robots that are worth it."""

from dataclasses import replace

import pytest
from tests.execution.world import World, carry_out

import muster
from muster.execution import Executor, Standing, travel_of
from muster.execution.replanning import worthwhile as gains
from muster.execution.replanning.insertion import Insertion
from muster.execution.replanning.near_robots import ORDER_ROBOTS, PART_ROBOTS, PART_TASKS, NearRobots
from muster.execution.replanning.worthwhile import Heading, worthwhile
from muster.mission.model import Event, Mission, Robot, Rules, Task
from muster.mission.plan import Plan
from muster.model.problem import Problem


def fleet(robots=20, objective="lateness", **more):
    crew = tuple(Robot(id=f"r_{k}", position=(10.0 * (k % 5), 10.0 * (k // 5)), **more) for k in range(robots))
    return Mission(robots=crew, tasks=(), rules=Rules(objective=objective))


def orders(count, at_s=0.0, **more):
    places = ((float(37 * k % 60), float(61 * k % 40)) for k in range(count))
    return [
        Event(at_s=at_s, new_task=Task(id=f"o{at_s:g}-{k}", position=at, duration_s=5, **more))
        for k, at in enumerate(places)
    ]


class Counted(Insertion):
    """Counts the tasks of each problem that is planned, and the robots."""

    def __call__(self, rest):
        planned.append(len(rest.tasks))
        crews.append(len(rest.crew))
        return super().__call__(rest)


planned = []
crews = []


def executor_of(mission, stream):
    planned.clear()
    crews.clear()
    world = World(mission)
    standing = Standing(until_s=None, orders=stream, improver=None)
    replan = Counted(travel_of(mission))
    return Executor(mission, Plan(routes=()), world.ports, replan=replan, standing=standing), world


def go_on(executor, until_s):
    for tenth in range(1 + round(10 * until_s)):
        executor.tick(tenth / 10)


@pytest.mark.parametrize("objective", ["lateness", "makespan", "total"])
def test_an_order_among_many_is_planned_with_few_and_no_other_task_changes_robot(objective):
    late = [*orders(1, 2.0), *orders(1, 3.0)]
    executor, _ = executor_of(fleet(objective=objective), [*orders(400), *late])
    go_on(executor, 3.5)
    assert planned[0] == 400
    assert all(few <= 3 * PART_TASKS for few in planned[1:])
    assert len(planned) == 3
    routed = [task for state in executor.crew.values() for task in state.route]
    assert len(routed) == len(set(routed)) == 402
    assert not [event for event in executor.events if event.kind == "replanned" and event.data["moved"]]
    assert executor.state.routes == {name: tuple(s.route) for name, s in executor.crew.items() if s.route}


@pytest.mark.long
def test_of_many_orders_all_are_done_once():
    executor, world = executor_of(fleet(), [*orders(200), *(one for k in range(1, 40) for one in orders(1, float(k)))])
    carry_out(executor, world)
    assert executor.orders.done == 239
    assert min(planned) < 100
    assert len([event for event in executor.events if event.kind == "starts"]) == 239


def test_what_robots_near_by_may_not_do_goes_to_one_that_may():
    mission = fleet()
    far = replace(mission.robots[-1], skills=("gripper",))
    order = Event(at_s=2.0, new_task=Task(id="grip", position=(0, 0), requires=("gripper",)))
    executor, _ = executor_of(mission.at_once(robots=(*mission.robots[:-1], far)), [*orders(400), order])
    go_on(executor, 2.5)
    assert "grip" in executor.crew[far.id].route


@pytest.mark.parametrize("more", [{"prerequisites": ("o0-7",)}, {"starts_with": ("o0-7",)}, {"robots_needed": 2}])
def test_an_order_that_concerns_others_is_planned_with_all(more):
    order = Event(at_s=2.0, new_task=Task(id="tied", position=(3, 3), **more))
    executor, _ = executor_of(fleet(), [*orders(200), order])
    go_on(executor, 2.5)
    assert planned[-1] > 190
    assert any("tied" in state.route for state in executor.crew.values())


def test_what_nobody_can_do_is_planned_with_all_once_and_said():
    order = Event(at_s=2.0, new_task=Task(id="never", position=(3, 3), requires=("wings",)))
    executor, _ = executor_of(fleet(), [*orders(400), order, *orders(1, 3.0)])
    go_on(executor, 3.5)
    assert "skill" in executor.state.left_out["never"]
    assert planned[-1] <= 3 * PART_TASKS


@pytest.mark.parametrize("open_tasks", [0, 5, 60])
def test_an_order_to_many_robots_is_planned_with_few_however_many_tasks_they_have(open_tasks):
    late = [*orders(1, 2.0), *orders(1, 3.0), *orders(5, 4.0)]
    executor, _ = executor_of(fleet(5 * PART_ROBOTS), [*orders(open_tasks), *late])
    go_on(executor, 4.5)
    assert crews[-3:-1] == [PART_ROBOTS, PART_ROBOTS]
    assert ORDER_ROBOTS <= crews[-1] <= 5 * ORDER_ROBOTS
    begun = {task for state in executor.crew.values() for task in (*state.route, *state.done)}
    assert len(begun) == open_tasks + 7
    assert not [event for event in executor.events if event.kind == "replanned" and event.data["moved"]]


def test_a_fleet_of_few_robots_with_few_tasks_is_planned_as_a_whole():
    executor, _ = executor_of(fleet(2 * PART_ROBOTS - 1), [*orders(10), *orders(1, 2.0)])
    go_on(executor, 2.5)
    assert crews[-1] == 2 * PART_ROBOTS - 1


def test_few_tasks_are_planned_as_a_whole():
    executor, _ = executor_of(fleet(), orders(4 * PART_TASKS - 1))
    go_on(executor, 0.5)
    assert NearRobots(executor.ledger, executor.crew).part(["o0-0"]) is None


def line(*places, robots=((0.0, 0.0), (100.0, 0.0)), objective="total"):
    tasks = tuple(Task(id=f"t{k}", position=(float(x), 0.0)) for k, x in enumerate(places))
    crew = tuple(Robot(id=f"r_{k}", position=at) for k, at in enumerate(robots))
    return Problem.compile(Mission(robots=crew, tasks=tasks, rules=Rules(objective=objective)))


@pytest.mark.parametrize(("gain", "changes"), [(0.0, True), (0.09, True), (0.11, False)])
def test_a_task_changes_robots_for_a_gain_alone(monkeypatch, gain, changes):
    monkeypatch.setattr(gains, "SWITCH_GAIN", gain)
    problem = line(10, 49, 90)
    now, better = [[0], [2, 1]], [[0, 1], [2]]  # 61 m, of which a task costs a third, and 59 m
    assert worthwhile(problem, now, better, {}) == (better if changes else now)


@pytest.mark.parametrize(("heading", "changes"), [(None, True), ("far", False), ("near", False)])
def test_a_task_that_its_robot_is_on_the_way_to_changes_for_more(monkeypatch, heading, changes):
    monkeypatch.setattr(gains, "SWITCH_GAIN_UNDER_WAY", 0.2)
    problem = line(10, 49, 90)
    now, better = [[0], [1, 2]], [[0, 1], [2]]  # 102 m, and 59 m
    headings = {} if heading is None else {"r_1": Heading("t1", heading == "near")}
    assert worthwhile(problem, now, better, headings) == (now if heading == "near" else better)
    monkeypatch.setattr(gains, "SWITCH_GAIN_UNDER_WAY", 1.5)
    assert worthwhile(problem, now, better, headings) == (better if changes else now)


@pytest.mark.parametrize("better", [[[0, 1], [3, 2]], [[0, 1, 2], [3]]], ids=["later", "by another"])
def test_a_robot_that_is_nearly_at_a_task_does_it_first_and_the_rest_of_a_change_holds(better):
    problem = line(10, 20, 49, 90)
    now = [[0, 3], [2, 1]]  # 170 m
    assert worthwhile(problem, now, better, {"r_1": Heading("t2", True)}) == [[0, 1], [2, 3]]  # 112 m


def test_a_burst_of_orders_is_improved_while_robots_are_nearly_at_their_first_ones():
    """Some robot of ten nearly always is: that must not keep all others from better routes."""
    mission = fleet(10, speed_mps=2.0)
    standing = Standing(orders=orders(60), until_s=2.0)
    plan = muster.solve(mission, "greedy")
    report = muster.simulate(mission, plan, standing=standing)
    assert len(report.tasks_done) == 60
    assert report.orders.improved > 0


def test_exchanges_that_do_not_pay_are_left_though_others_do():
    robots = ((0.0, 0.0), (10.0, 0.0), (1000.0, 0.0), (1010.0, 0.0))
    problem = line(1, 9, 1004.9, 1005.1, robots=robots)
    now, then = [[1], [0], [3], [2]], [[0], [1], [2], [3]]
    assert worthwhile(problem, now, then, {}) == [[0], [1], [3], [2]]
    assert worthwhile(problem, now, then, {}, most=1) == now


def test_what_completes_more_is_taken_over_whatever_it_costs():
    problem = line(10, 90)
    assert worthwhile(problem, [[0], []], [[], [0, 1]], {}) == [[], [0, 1]]
