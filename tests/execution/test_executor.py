"""Plans carried out in a world without surprises, and what the executor does about changes."""

from dataclasses import replace

import pytest
from tests.execution.world import World, carry_out

import muster
from muster import Mission, Robot, Rules, Task
from muster.execution.executor import Executor
from muster.execution.replanning.travel import OverMap, way_of
from muster.execution.reports.report import report_of
from muster.execution.robots.monitor import Limits
from muster.execution.robots.robot_state import Activity
from muster.library import mission_names
from muster.mission.errors import ParameterError
from muster.mission.model import Action, DelayedTask, Event, MovedTask
from muster.mission.plan import Plan, Route
from muster.motion import actions
from muster.motion.actions import Impossible
from muster.motion.paths.robot_paths import RobotPaths
from muster.motion.port import Waypoint
from muster.state.robot_events import RobotFails, RobotSilent, RobotStuck

SHIPPED = [name for name in mission_names() if name not in ("berlin52", "eil51", "eil76")]


def plan_of(**routes):
    return Plan(routes=tuple(Route(robot, tuple(tasks)) for robot, tasks in routes.items()))


def line(*places, robots=1, events=(), rules=None, **task):
    """Robots at the origin and tasks along the x axis, all of 1 m/s."""
    return Mission(
        name="line",
        rules=rules or Rules(),
        robots=tuple(Robot(id=f"r_{k}", position=(0.0, float(k))) for k in range(robots)),
        tasks=tuple(Task(id=str(k), position=(x, 0.0), **task) for k, x in enumerate(places)),
        events=tuple(events),
    )


def carried_out(mission, plan, **options):
    world = World(mission)
    return carry_out(Executor(mission, plan, world.ports, **options), world, until=1000)


def kinds(executor):
    return [event.kind for event in executor.events]


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_missions_are_carried_out_as_planned(name):
    """Every task, in order, after its prerequisites, for the usage and in the time that the judge finds; no events."""
    mission = replace(muster.load(name), events=())
    mission = replace(mission, rules=replace(mission.rules, timing="constant"))  # as the robots of this world drive
    plan = muster.solve(mission, "greedy")
    verdict = muster.verify(mission, plan)
    world, step = World(mission), verdict.makespan_s / 500
    robot_paths = None if mission.map is None else RobotPaths.of(mission)
    travel = None if robot_paths is None else OverMap(robot_paths)
    executor = Executor(mission, plan, world.ports, way=way_of(mission, robot_paths), travel=travel)
    carry_out(executor, world, step=step, until=3 * verdict.makespan_s + 100)
    ledger = executor.ledger
    assert executor.done
    assert set(ledger.ends_s) == {stop.task for route in plan.routes for stop in route.stops} - {None}
    assert set(executor.lost()) == {item.task for item in plan.unassigned}
    assert not executor.revisions
    for task in mission.tasks:
        if task.id in ledger.starts_s:
            assert all(ledger.ends_s[before] <= ledger.starts_s[task.id] for before in task.prerequisites)
    seen = step * (2 + 2 * len(ledger.ends_s)) if mission.rules.usage == "time" else 0.0  # time is counted in steps
    exact = 1e-2 if name == "depot" else 1e-6  # ways through the air are sampled
    for route, figures in zip(plan.routes, verdict.routes, strict=True):
        assert executor.crew[route.robot].done == [stop.task for stop in route.stops if not stop.is_station]
        assert executor.crew[route.robot].used == pytest.approx(route.usage, rel=exact, abs=1e-9 + seen)
        assert executor.usage_planned[route.robot] == pytest.approx(figures.usage, rel=exact)
    late = max(ledger.ends_s.values()) - verdict.makespan_s
    assert (
        -1e-6 <= late <= step * (2 + len(ledger.ends_s))
    )  # a step at most for each task that is noticed to have ended


def test_a_robot_waits_at_a_task_for_prerequisites_of_others():
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(10, 0))),
        tasks=(
            Task(id="first", position=(0, 20)),
            Task(id="then", position=(10, 1), prerequisites=("first",), actuation_cost=3),
        ),
    )
    executor = carried_out(mission, plan_of(a=["first"], b=["then"]))
    assert executor.ledger.arrivals_s["then"] == pytest.approx(1, abs=0.11)
    assert executor.ledger.starts_s["then"] == pytest.approx(20, abs=0.11)
    assert executor.ledger.ends_s["then"] == pytest.approx(23, abs=0.31)
    assert executor.ledger.waiting_s == pytest.approx(19, abs=0.21)
    ignoring = Plan(routes=plan_of(a=["first"], b=["then"]).routes, ignored=("prerequisites",))
    assert carried_out(mission, ignoring).ledger.ends_s["then"] == pytest.approx(4, abs=0.31)


def test_a_robot_is_available_when_it_has_nothing_to_do():
    mission = line(5.0, duration_s=4.0)
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0"]), world.ports)
    assert executor.crew["r_0"].available
    seen = []
    carry_out(executor, world, each=lambda world, executor: seen.append(executor.crew["r_0"].available))
    assert not any(seen[:85])
    assert executor.crew["r_0"].available


def test_it_goes_where_its_route_ends():
    mission = line(5.0, rules=Rules(return_to_start=True))
    executor = carried_out(mission, plan_of(r_0=["0"]))
    assert executor.crew["r_0"].position == (0, 0, 0)
    assert executor.state.ended_s == pytest.approx(10, abs=0.31)
    assert executor.crew["r_0"].used == pytest.approx(10)


def test_a_failed_robots_tasks_are_done_by_another():
    mission = line(5.0, 9.0, robots=2, events=[Event(at_s=6, robot_fails="r_0")], duration_s=3.0)
    executor = carried_out(mission, plan_of(r_0=["0", "1"]))
    assert executor.crew["r_0"].out == RobotFails.kind
    assert executor.crew["r_1"].done == ["0", "1"]  # also the work under way
    assert executor.ledger.starts_s["0"] > 6
    assert executor.revisions[0].moved == {"0": ("r_0", "r_1"), "1": ("r_0", "r_1")}
    assert executor.lost() == {}


def test_what_only_the_failed_robot_could_do_is_lost_with_that_reason():
    mission = line(5.0, robots=2, events=[Event(at_s=1, robot_fails="r_0")], only_robots=("r_0",))
    executor = carried_out(mission, plan_of(r_0=["0"]))
    lost = "lock: only r_0 may do it, and takes no part any more; no longer taking part: r_0 (failed at 1.1 s)"
    assert executor.lost() == {"0": lost}
    alone = line(5.0, events=[Event(at_s=1, robot_fails="r_0")])
    assert carried_out(alone, plan_of(r_0=["0"])).lost() == {
        "0": "no robot takes part any more; no longer taking part: r_0 (failed at 1.1 s)"
    }


def test_a_new_task_that_nobody_can_do_is_told_once_with_the_reason():
    wanted = Task(id="new", position=(1, 0), only_robots=("r_1",))
    events = [
        Event(at_s=1, robot_fails="r_1"),
        Event(at_s=2, new_task=wanted),
        Event(at_s=3, delay_task=DelayedTask(task="0", by_s=1)),
    ]
    executor = carried_out(line(9.0, robots=2, events=events), plan_of(r_0=["0"]))
    told = [entry.data["left_out"] for entry in executor.events if entry.kind == "replanned"]
    assert told == [{}, {"new": "lock: only r_1 may do it, and takes no part any more"}, {}]


def test_a_failed_robot_that_returns_goes_on():
    mission = line(5.0, events=[Event(at_s=1, robot_fails="r_0"), Event(at_s=50, robot_returns="r_0")])
    executor = carried_out(mission, plan_of(r_0=["0"]))
    assert executor.ledger.ends_s["0"] == pytest.approx(54, abs=0.3)
    assert executor.crew["r_0"].used == pytest.approx(5)


def test_a_robot_that_returns_and_did_nothing_stays_where_it_is():
    events = [Event(at_s=1, robot_fails="r_1"), Event(at_s=2, robot_returns="r_1")]
    mission = line(5.0, robots=2, events=events)
    away = Mission(
        robots=(mission.robots[0], Robot(id="r_1", position=(50, 0), end_position=(0, 90))),
        tasks=mission.tasks,
        events=mission.events,
    )
    assert carried_out(away, plan_of(r_0=["0"])).crew["r_1"].used == 0


def test_a_silent_robot_is_noticed_and_is_back_when_it_is_heard():
    events = [Event(at_s=2, robot_silent="r_0"), Event(at_s=20, robot_returns="r_0")]
    mission = line(40.0, 60.0, robots=2, events=events)
    executor = carried_out(mission, plan_of(r_0=["0", "1"]), limits=Limits(silent_after_s=5))
    noticed = next(h.time_s for h in executor.events if h.kind == RobotSilent.kind)
    assert noticed == pytest.approx(7, abs=0.21)
    assert "robot_returns" in kinds(executor)
    assert sorted(executor.ledger.ends_s) == ["0", "1"]
    assert kinds(executor).count("ends") == 2


def test_a_robot_that_does_not_get_on_is_sent_again_and_then_out():
    mission = line(40.0, robots=2)
    world = World(mission)
    world.ports["r_0"].broken = True  # it talks, and does not move
    executor = Executor(mission, plan_of(r_0=["0"]), world.ports, limits=Limits(stuck_after_s=10))
    carry_out(executor, world)
    assert executor.crew["r_0"].out == RobotStuck.kind
    assert [h.time_s for h in executor.events if h.kind == "robot_sent_again"] == [pytest.approx(10.5, abs=0.6)]
    assert executor.crew["r_1"].done == ["0"]


def refusing(mission, plan, place, **options):
    world = World(mission)
    world.ports["r_0"].refuses = (place,)
    return carry_out(Executor(mission, plan, world.ports, **options), world, until=1000)


def test_a_task_to_which_a_robot_says_it_will_not_get_is_done_by_another():
    executor = refusing(line(5, 9, robots=2), plan_of(r_0=["0", "1"], r_1=[]), (5.0, 0.0, 0.0))
    done = {row.task: row.robot for row in report_of(executor.account, contacts=0, min_distance_m=None).tasks}
    assert done["0"] == "r_1"
    assert set(done) == {"0", "1"}
    refused = [event.data for event in executor.events if event.kind == "task_refused"]
    assert refused == [{"task": "0", "robot": "r_0", "reason": "no way, it says"}]
    assert not executor.crew["r_0"].out


def test_one_that_nobody_gets_to_is_lost_with_what_the_robot_says():
    executor = refusing(line(5, 9), plan_of(r_0=["0", "1"]), (5.0, 0.0, 0.0))
    assert list(executor.lost()) == ["0"]
    assert "no way, it says" in executor.lost()["0"]


def test_a_robot_that_will_not_get_to_its_end_ends_where_it_is():
    executor = refusing(line(5, rules=Rules(return_to_start=True)), plan_of(r_0=["0"]), (0.0, 0.0, 0.0))
    assert executor.done
    assert kinds(executor).count("no_way_to_end") == 1


def test_work_that_takes_far_too_long_is_stuck_too():
    mission = line(5.0, robots=2, duration_s=3.0)
    world = World(mission)

    def breaks(world, executor):
        world.ports["r_0"].broken = executor.crew["r_0"].activity is Activity.WORKING

    executor = carry_out(
        Executor(mission, plan_of(r_0=["0"]), world.ports, limits=Limits(stuck_after_s=4)), world, each=breaks
    )
    assert executor.crew["r_0"].out == RobotStuck.kind
    assert executor.crew["r_1"].done == ["0"]


class Detours(World):
    """Robots whose odometry runs on: they go 30 % more than the way."""

    def step(self, dt):
        before = {name: point.odometry for name, point in self.ports.items()}
        super().step(dt)
        for name, point in self.ports.items():
            point.odometry += 0.3 * (point.odometry - before[name])
            point.step(0.0)


def test_what_no_longer_fits_after_detours_goes_to_another_or_is_lost():
    """30 m of capacity: 20 m are 26 with detours, and 8 m more would be 36."""
    robots = (Robot(id="r_0", position=(0, 0), work_capacity=30), Robot(id="r_1", position=(0, 50), work_capacity=100))
    tasks = (Task(id="0", position=(20, 0)), Task(id="1", position=(28, 0)))
    mission = Mission(rules=Rules(stability=0), robots=robots, tasks=tasks)
    world = Detours(mission)
    executor = carry_out(Executor(mission, plan_of(r_0=["0", "1"]), world.ports), world)
    assert executor.crew["r_0"].done == ["0"]
    assert executor.crew["r_1"].done == ["1"]
    assert "robot_runs_low" in kinds(executor)
    alone = Mission(robots=robots[:1], tasks=tasks)
    world = Detours(alone)
    executor = carry_out(Executor(alone, plan_of(r_0=["0", "1"]), world.ports), world)
    assert executor.crew["r_0"].used <= 30
    assert list(executor.lost()) == ["1"]
    assert "capacity" in executor.lost()["1"]


def test_ignored_capacity_is_not_watched():
    robots = (Robot(id="r_0", position=(0, 0), work_capacity=3),)
    mission = Mission(robots=robots, tasks=(Task(id="0", position=(20, 0)),))
    plan = Plan(routes=plan_of(r_0=["0"]).routes, ignored=("capacity",))
    assert carried_out(mission, plan).crew["r_0"].done == ["0"]


def test_a_new_task_is_done_when_it_appears():
    event = Event(at_s=30, new_task=Task(id="9", position=(7, 0), prerequisites=("0",)))
    mission = line(5.0, events=[event])
    executor = carried_out(mission, plan_of(r_0=["0"]))
    assert executor.ledger.ends_s["9"] == pytest.approx(32, abs=0.3)
    assert executor.revisions[0].added == {"9": "r_0"}


def test_a_cancelled_task_is_left_even_while_it_is_done():
    mission = line(5.0, 9.0, events=[Event(at_s=7, cancel_task="0")], actuation_cost=10.0)
    executor = carried_out(mission, plan_of(r_0=["0", "1"]))
    assert executor.ledger.ends_s == {"1": pytest.approx(21, abs=0.4)}
    assert executor.lost()["0"].startswith("cancelled at 7")
    assert executor.crew["r_0"].used == pytest.approx(9 + 10 + 2, abs=0.2)  # two seconds of ten had been worked


def test_what_waits_for_a_cancelled_task_is_lost():
    mission = Mission(
        robots=(Robot(id="r_0", position=(0, 0)),),
        tasks=(Task(id="0", position=(9, 0)), Task(id="1", position=(12, 0), prerequisites=("0",))),
        events=(Event(at_s=2, cancel_task="0"),),
    )
    lost = carried_out(mission, plan_of(r_0=["0", "1"])).lost()
    assert lost["1"] == "prerequisite: 0 comes before it and is not going to be done"


def test_a_task_that_moves_is_done_where_it_is_then():
    mission = line(9.0, events=[Event(at_s=2, move_task=MovedTask(task="0", position=(2.0, 6.0)))])
    executor = carried_out(mission, plan_of(r_0=["0"]))
    assert executor.crew["r_0"].position == (2, 6, 0)
    assert executor.ledger.ends_s["0"] == pytest.approx(8, abs=0.3)


@pytest.mark.parametrize("at_s", [1, 7])
def test_a_delay_counts_also_while_the_work_is_under_way(at_s):
    mission = line(5.0, events=[Event(at_s=at_s, delay_task=DelayedTask(task="0", by_s=6))], duration_s=4.0)
    executor = carried_out(mission, plan_of(r_0=["0"]))
    assert executor.ledger.ends_s["0"] == pytest.approx(15, abs=0.4)


def test_a_robot_that_joins_takes_work():
    robot = Robot(id="new", position=(50, 0), speed_mps=2)
    mission = line(40.0, 45.0, events=[Event(at_s=3, robot_joins=robot)])
    executor = carried_out(mission, plan_of(r_0=["0", "1"]))
    assert sorted(executor.crew["new"].done) == ["0", "1"]
    assert report_of(executor.account, contacts=0, min_distance_m=1.0).robots[1].usage_planned == 0


def test_what_a_robot_cannot_do_goes_to_another():
    mission = line(5.0, robots=2)

    def plan_motion(task, robot):
        return Impossible("no camera") if robot.id == "r_0" else actions.plan(task, robot)

    executor = carried_out(mission, plan_of(r_0=["0"]), plan_motion=plan_motion)
    assert executor.crew["r_1"].done == ["0"]
    lost = carried_out(line(5.0), plan_of(r_0=["0"]), plan_motion=plan_motion).lost()
    assert lost == {"0": "no camera (r_0)"}


def test_robots_that_wait_for_each_other_get_a_new_plan():
    mission = Mission(
        robots=(Robot(id="a", position=(0, 0)), Robot(id="b", position=(10, 0))),
        tasks=(
            Task(id="0", position=(0, 5)),
            Task(id="1", position=(10, 5), prerequisites=("0",)),
            Task(id="2", position=(10, 9)),
            Task(id="3", position=(0, 9), prerequisites=("2",)),
        ),
    )
    executor = carried_out(mission, plan_of(a=["3", "0"], b=["1", "2"]))
    assert "standstill" in kinds(executor)
    assert len(executor.ledger.ends_s) == 4


def test_events_from_outside():
    mission = line(5.0)
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0"]), world.ports)
    executor.tick(0.0)
    executor.report(Event(at_s=0, new_task=Task(id="7", position=(1, 0))))
    carry_out(executor, world)
    assert sorted(executor.ledger.ends_s) == ["0", "7"]
    with pytest.raises(ParameterError, match='new_task: "7"; expected an id that no task has'):
        executor.report(Event(at_s=0, new_task=Task(id="7", position=(1, 0))))
    with pytest.raises(ParameterError, match='robot: "x"; expected r_0'):
        executor.report(Event(at_s=0, robot_fails="x"))


def test_what_does_not_fit_is_refused():
    mission = line(5.0)
    world = World(mission)
    with pytest.raises(ParameterError, match='plan: task "x"; expected each task'):
        Executor(mission, plan_of(r_0=["x"]), world.ports)
    with pytest.raises(ParameterError, match='plan: robot "x"; expected each robot'):
        Executor(mission, plan_of(x=["0"]), world.ports)
    with pytest.raises(ParameterError, match='ports: no port for robot "r_0"'):
        Executor(mission, plan_of(r_0=["0"]), {})
    executor = Executor(mission, plan_of(r_0=["0"]), world.ports, now=5.0)
    with pytest.raises(ParameterError, match="time does not go back"):
        executor.tick(4.0)


def with_a_breakdown_at_work(*events):
    """r_0 breaks down on task 0."""
    return Mission(
        robots=(Robot(id="r_0", position=(0, 0), radius_m=0.5), Robot(id="r_1", position=(0, 5), radius_m=0.5)),
        tasks=(Task(id="0", position=(10, 0), duration_s=20), Task(id="1", position=(30, 0))),
        events=(Event(at_s=12, robot_fails="r_0"), *events),
    )


def test_a_task_at_which_a_broken_robot_stands_is_given_up_and_the_robot_goes_on():
    """r_0 breaks down on task 0; r_1 cannot get there, gives it up, and does task 1."""
    mission = with_a_breakdown_at_work()
    simulation = muster.Simulation(mission, plan_of(r_0=["0"], r_1=["1"]))
    while not simulation.done:
        simulation.advance(1000)
    report = simulation.result()
    assert report.tasks_done == ("1",)
    ((task, reason),) = report.tasks_lost
    assert task == "0"
    assert "r_0 stands there" in reason
    assert "no longer taking part: r_0" in reason


def test_a_task_is_tried_again_when_the_broken_robot_returns():
    mission = with_a_breakdown_at_work(Event(at_s=200, robot_returns="r_0"))
    report = muster.simulate(mission, plan_of(r_0=["0"], r_1=["1"]))
    assert sorted(report.tasks_done) == ["0", "1"]
    assert report.contacts == 0


def delivering(to, at_s, moved_to, **task):
    """A robot that brings a load from (6, 0) to a place, which moves meanwhile, and what becomes of that."""
    action = Action(name="delivery", pickup=(6.0, 0.0))
    return Mission(
        robots=(Robot(id="r_0", position=(0.0, 0.0)),),
        tasks=(Task(id="0", position=to, action=action, **task),),
        events=(Event(at_s=at_s, move_task=MovedTask(task="0", position=moved_to)),),
    )


@pytest.mark.parametrize(("at_s", "driven_m"), [(2, 14), (9, 9 + 73**0.5)])
def test_a_load_under_way_is_brought_to_where_its_delivery_has_moved(at_s, driven_m):
    """Before the pickup the way there is unchanged, after it the robot turns from where it is, three metres on."""
    executor = carried_out(delivering((16.0, 0.0), at_s, (6.0, 8.0), duration_s=12.0), plan_of(r_0=["0"]))
    state = executor.crew["r_0"]
    assert state.position == pytest.approx((6, 8, 0), abs=1e-6)
    unloads_s = 12 - 8 if at_s == 2 else 12 - 10  # what the way leaves of the duration when it sets out
    assert executor.ledger.ends_s["0"] == pytest.approx(driven_m + unloads_s, abs=0.4)
    assert state.used == pytest.approx(driven_m, abs=0.3)
    assert [event.kind for event in executor.events].count("starts") == 1
    assert executor.state.tasks["0"].position == (6.0, 8.0)
    assert executor.state.tasks["0"].action.pickup == (6.0, 0.0)


def test_a_load_that_is_being_put_down_stays_where_it_is():
    executor = carried_out(delivering((9.0, 0.0), 11, (6.0, 8.0), duration_s=9.0), plan_of(r_0=["0"]))
    assert executor.crew["r_0"].position == pytest.approx((9, 0, 0), abs=1e-6)
    assert executor.ledger.ends_s["0"] == pytest.approx(15, abs=0.4)
    assert executor.state.tasks["0"].position == (9.0, 0.0)


def test_a_load_under_way_leaves_where_the_exit_has_moved_with_its_delivery():
    mission = delivering((16.0, 0.0), 9, (6.0, 8.0), entry=(5.0, 0.0), exit=(17.0, 0.0))
    executor = carried_out(mission, plan_of(r_0=["0"]))
    assert executor.crew["r_0"].position == pytest.approx((7, 8, 0), abs=1e-6)
    assert executor.crew["r_0"].used == pytest.approx(9 + 73**0.5 + 1, abs=0.3)


def test_work_that_carries_nothing_goes_on_where_it_began():
    mission = line(5.0, events=[Event(at_s=7, move_task=MovedTask(task="0", position=(2.0, 6.0)))], duration_s=4.0)
    executor = carried_out(mission, plan_of(r_0=["0"]))
    assert executor.crew["r_0"].position == pytest.approx((5, 0, 0), abs=1e-6)
    assert executor.ledger.ends_s["0"] == pytest.approx(9, abs=0.4)


def test_a_load_goes_where_it_was_to_go_where_no_way_leads_to_the_new_place():
    def way(robot, start, goal, *, at_work=False):
        return None if goal[1] > 5 else (Waypoint(goal),)

    executor = carried_out(delivering((16.0, 0.0), 9, (6.0, 8.0)), plan_of(r_0=["0"]), way=way)
    assert executor.crew["r_0"].position == pytest.approx((16, 0, 0), abs=1e-6)
    assert executor.ledger.ends_s["0"] == pytest.approx(16, abs=0.4)
