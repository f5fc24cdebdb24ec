"""Plans with time windows, deadlines, lags, shifts, teams and relations, carried out; and what goes wrong with them."""

from dataclasses import replace

import pytest
from tests.execution.test_executor import carried_out, plan_of
from tests.execution.world import World, carry_out

from muster import Mission, Robot, Rules, Task
from muster.execution.executor import Executor
from muster.execution.replanning.reallocation import Revision
from muster.execution.replanning.remaining_problem import remaining_problem
from muster.execution.replanning.travel import travel_of
from muster.execution.reports.report import report_of
from muster.execution.status import status_of
from muster.mission.errors import ParameterError
from muster.mission.model import DelayedTask, Event, Lag, TeamPart
from muster.mission.plan import Reason, Unassigned
from muster.model.under_way import UnderWay
from muster.state import MissionState
from muster.state.run_events import PlanAdopted
from muster.state.task_events import Ends

NEAR = 0.25


def mission_of(*tasks, robots=2, events=(), **robot):
    crew = tuple(Robot(id=f"r_{k}", position=(0.0, float(k)), **robot) for k in range(robots))
    return Mission(robots=crew, tasks=tasks, events=tuple(events))


def task(name, x=1.0, **keys):
    return Task(id=name, position=(x, 0.0), **{"duration_s": 10.0, **keys})


def keeping(rest):
    """A new plan: what robots still can do of theirs. It is no search, so that the executor alone is tested."""
    crew = {s.robot.id: s.robot for s in rest.crew}
    routes = {name: rest.routes[name] for name in crew}
    for one in rest.tasks:
        able = [
            robot
            for name, robot in crew.items()
            if one.id in routes[name] and name not in rest.refusals.get(one.id, {})
        ]
        if one.id in rest.expired or UnderWay(rest.mission, ()).lacking(one, able):
            able = []
        for name, route in routes.items():
            routes[name] = tuple(other for other in route if other != one.id or crew[name] in able)
    there = {name for route in routes.values() for name in route}
    left_out = {
        one.id: rest.expired.get(one.id, ", ".join(rest.refusals.get(one.id, {}).values()))
        for one in rest.tasks
        if one.id not in there
    }
    return Revision(
        routes=routes,
        ahead={name: {} for name in crew},
        moved={},
        forced=frozenset(),
        added={},
        dropped=tuple(name for name in left_out if name in rest.former),
        left_out=left_out,
    )


def words_of(executor):
    return {(e.data["robot"], e.data["words"]) for e in executor.events if e.kind == "waits"}


def test_a_robot_waits_for_its_window_and_says_so():
    mission = mission_of(task("a", window_s=((30.0, 60.0),)), robots=1)
    executor = carried_out(mission, plan_of(r_0=["a"]), replan=keeping)
    report = report_of(executor.account)
    assert report.starts_s["a"] == pytest.approx(30, abs=NEAR)
    assert report.waiting_by_cause_s == {"window": pytest.approx(29, abs=NEAR)}
    assert words_of(executor) == {("r_0", "waits for window: opens at 30 s")}


def test_status_says_for_whom_a_team_waits():
    mission = mission_of(task("lift", robots_needed=2), task("far", x=20.0))
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["lift"], r_1=["far", "lift"]), world.ports, replan=keeping)
    carry_out(executor, world, until=5)
    status = status_of(executor)
    assert status.robots["r_0"].waits == "waits for team: r_1"
    assert (status.robots["r_0"].team, status.robots["r_1"].team) == (("r_0", "r_1"), ())
    carry_out(executor, world)
    report = report_of(executor.account)
    there = report.ends_s["far"] + 19
    assert report.starts_s["lift"] == pytest.approx(there, abs=NEAR)
    assert report.tasks_done.count("lift") == 1
    assert report.tasks[-1].team == ("r_0", "r_1")
    assert report.waiting_by_cause_s["team"] == pytest.approx(there - 1, abs=2 * NEAR)


def test_a_team_ends_for_all_when_the_slowest_ends():
    mission = mission_of(task("lift", robots_needed=2))
    slow = replace(mission.robots[1], efficiency=0.5)
    mission = replace(mission, robots=(mission.robots[0], slow))
    report = report_of(carried_out(mission, plan_of(r_0=["lift"], r_1=["lift"]), replan=keeping).account)
    assert report.ends_s["lift"] - report.starts_s["lift"] == pytest.approx(20, abs=NEAR)


def test_a_team_begins_only_when_it_is_enough():
    """A plan from elsewhere sends one robot too few: nothing is counted as done."""
    for needed in ({"robots_needed": 2}, {"team": (TeamPart(count=2),)}, {"needs": {"lift_kg": 30.0}}):
        mission = mission_of(task("lift", **needed), abilities={"lift_kg": 20.0})
        executor = carried_out(mission, plan_of(r_0=["lift"]), replan=keeping)
        assert "starts" not in {e.kind for e in executor.events}
        assert not executor.ledger.ends_s


def test_a_part_of_a_team_takes_the_robot_that_fits_it():
    team = (TeamPart(count=1), TeamPart(count=1, requires=("camera",)))
    mission = mission_of(task("look", team=team))
    seeing = replace(mission, robots=(replace(mission.robots[0], skills=("camera",)), mission.robots[1]))
    for given, done in ((mission, []), (seeing, ["look"])):
        executor = carried_out(given, plan_of(r_0=["look"], r_1=["look"]), replan=keeping)
        assert list(executor.ledger.ends_s) == done


def test_tasks_begin_together():
    mission = mission_of(task("a", starts_with=("b",)), task("b", x=30.0, duration_s=3.0))
    report = report_of(carried_out(mission, plan_of(r_0=["a"], r_1=["b"]), replan=keeping).account)
    assert report.starts_s["a"] == report.starts_s["b"] == pytest.approx(30, abs=NEAR)
    assert report.ends_s["b"] < report.ends_s["a"]


@pytest.mark.parametrize(
    ("rule", "latest_s"),
    [({"starts_with": ("c",)}, 0.0), ({"prerequisites": ("c",), "lags": {"c": Lag(within_s=15)}}, 25.0)],
)
def test_a_robot_on_the_way_to_a_task_waits_for_what_is_ordered_meanwhile(rule, latest_s):
    """Its order held the work, as nothing kept the task from beginning at once."""
    order = Event(at_s=2.0, new_task=task("order", x=100.0, **rule))
    mission = mission_of(task("c", x=10.0), events=[order])
    executor = carried_out(mission, plan_of(r_0=["c"], r_1=[]))
    report = report_of(executor.account)
    assert not executor.lost()
    assert 0.0 <= report.starts_s["order"] - report.starts_s["c"] <= latest_s
    assert report.starts_s["order"] == pytest.approx(102, abs=2.0)


@pytest.mark.parametrize(
    ("at_s", "over"), [(5.0, "which has begun"), (15.0, "which is done"), (17.0, "which is cancelled")]
)
def test_an_order_that_comes_too_late_to_begin_with_another_task_is_lost_and_nothing_else(at_s, over):
    """Neither the team's task, nor one that the order would begin with too."""
    partner = "gone" if over == "which is cancelled" else "c"
    events = [
        Event(at_s=1.0, cancel_task="gone"),
        Event(at_s=at_s, new_task=task("order", x=3.0, starts_with=(partner, "later"))),
    ]
    lift, later = task("lift", x=30.0, robots_needed=2), task("later", x=40.0)
    mission = mission_of(task("c"), task("gone"), lift, later, events=events)
    executor = carried_out(mission, plan_of(r_0=["c", "gone", "lift", "later"], r_1=["lift"]))
    why = f"relation: begins with {partner}, {over}"
    assert executor.ledger.ends_s.keys() == {"c", "lift", "later"}
    assert [revision.left_out for revision in executor.revisions] == [{}, {"order": why}]


def test_what_was_too_late_to_begin_with_another_task_is_so_when_the_mission_goes_on():
    mission = mission_of(task("c"), task("order", x=3.0, starts_with=("c",)), task("lift", x=9.0, robots_needed=2))
    plan = PlanAdopted(time_s=0.0, routes={"r_0": ("c", "order", "lift"), "r_1": ("lift",)})
    state = MissionState.after(mission, [plan, Ends(time_s=11.0, task="c", robot="r_0", usage=(1.0, 1.0))])
    executor = carried_out(mission, plan_of(r_0=["c", "order", "lift"], r_1=["lift"]), state=state)
    assert executor.lost() == {"order": "relation: begins with c, which is done"}


def test_work_begins_a_while_after_the_prerequisite_has_ended():
    mission = mission_of(task("a"), task("b", x=2.0, prerequisites=("a",), lags={"a": Lag(after_s=15)}))
    executor = carried_out(mission, plan_of(r_0=["a"], r_1=["b"]), replan=keeping)
    report = report_of(executor.account)
    assert report.starts_s["b"] == pytest.approx(report.ends_s["a"] + 15, abs=NEAR)
    assert report.waiting_by_cause_s["lag"] == pytest.approx(15, abs=NEAR)


@pytest.mark.parametrize("within", [2.0, 20.0])
def test_a_prerequisite_begins_so_late_that_its_dependant_can_follow_in_time(within):
    mission = mission_of(task("a"), task("b", x=100.0, prerequisites=("a",), lags={"a": Lag(within_s=within)}))
    executor = carried_out(mission, plan_of(r_0=["a"], r_1=["b"]), replan=keeping)
    report = report_of(executor.account)
    assert report.starts_s["b"] <= report.ends_s["a"] + within + 1e-6
    assert report.starts_s["a"] == pytest.approx(90 - within, abs=within)
    assert report.waiting_by_cause_s["dependant"] > 50
    assert not report.within_exceeded_s
    assert not report.missed


def test_a_window_that_is_missed_is_reported_as_the_reason():
    mission = mission_of(task("first"), task("a", window_s=((12.0, 30.0),)), robots=1)
    late = replace(mission, tasks=(replace(mission.tasks[0], duration_s=40.0), mission.tasks[1]))
    report = report_of(carried_out(late, plan_of(r_0=["first", "a"]), replan=keeping).account)
    assert report.tasks_lost == (("a", "window: closed at 30 s"),)
    assert [(one.task, one.reason, one.next_s) for one in report.missed] == [("a", "window: closed at 30 s", None)]


def test_a_robot_that_misses_a_window_waits_for_the_next():
    tasks = (task("first"), task("a", window_s=((12.0, 30.0), (80.0, 90.0))))
    mission = mission_of(*tasks, robots=1, events=[Event(at_s=2, delay_task=DelayedTask(task="first", by_s=40))])
    executor = carried_out(mission, plan_of(r_0=["first", "a"]), replan=keeping)
    report = report_of(executor.account)
    assert report.starts_s["a"] == pytest.approx(80, abs=NEAR)


def test_a_deadline_that_cannot_be_kept_is_not_begun():
    mission = mission_of(task("a", x=10.0, deadline_s=15.0), robots=1)
    report = report_of(carried_out(mission, plan_of(r_0=["a"]), replan=keeping).account)
    assert not report.tasks_done
    assert "deadline" in dict(report.tasks_lost)["a"]


def test_a_robot_begins_nothing_after_which_it_is_late_for_the_end_of_its_shift():
    mission = mission_of(task("a"), task("b", x=20.0), robots=1, available_until_s=35.0, return_to_start=True)
    executor = carried_out(mission, plan_of(r_0=["a", "b"]), replan=keeping)
    assert list(executor.ledger.ends_s) == ["a"]
    assert executor.ledger.refusals["b"]["r_0"].startswith("shift: would be back at")


def test_ignored_rules_do_not_hold():
    mission = mission_of(task("a", robots_needed=2, window_s=((500.0, 600.0),), deadline_s=3.0), robots=1)
    plan = replace(plan_of(r_0=["a"]), ignored=("window", "team", "deadline"))
    assert list(carried_out(mission, plan, replan=keeping).ledger.ends_s) == ["a"]


def test_tasks_follow_soon_in_what_is_left_even_where_windows_are_ignored():
    after = {"prerequisites": ("a",), "lags": {"a": Lag(after_s=5.0, within_s=50.0)}}
    mission = mission_of(task("a", window_s=((500.0, 600.0),)), task("b", x=90.0, **after), robots=1)
    for ignored, bound in ((("window",), True), (("window", "prerequisite"), False)):
        world = World(mission)
        executor = Executor(mission, replace(plan_of(r_0=["a", "b"]), ignored=ignored), world.ports, replan=keeping)
        carry_out(executor, world, until=20)
        ended_s = executor.ledger.ends_s["a"]
        problem = remaining_problem(executor._rest(), travel_of(mission)).problem
        openings = problem.model.openings[problem.task_index["b"]]
        assert openings == ([(ended_s + 5, ended_s + 50)] if bound else [])


def test_a_part_that_asks_for_a_skill_takes_any_robot_where_skills_are_ignored():
    mission = mission_of(task("look", team=(TeamPart(count=2, requires=("camera",)),)))
    for ignored, done in (((), []), (("skill",), ["look"])):
        plan = replace(plan_of(r_0=["look"], r_1=["look"]), ignored=ignored)
        assert list(carried_out(mission, plan, replan=keeping).ledger.ends_s) == done


def test_a_new_task_that_begins_with_one_tied_to_a_task_that_is_cancelled_can_never_begin():
    events = [
        Event(at_s=1.0, cancel_task="a"),
        Event(at_s=2.0, new_task=task("c", starts_with=("b",))),
    ]
    mission = mission_of(task("a", x=9.0), task("b", x=9.0, starts_with=("a",)), robots=2, events=events)
    executor = carried_out(mission, plan_of(r_0=["a"], r_1=["b"]), replan=keeping)
    assert executor.lost()["c"] == "relation: begins with a, which is cancelled"
    assert executor.ledger.unit("c") == ("c",)


def test_a_task_of_one_robot_stands_in_one_route():
    with pytest.raises(ParameterError, match="at most once"):
        carried_out(mission_of(task("a")), plan_of(r_0=["a"], r_1=["a"]), replan=keeping)


def test_work_is_broken_off_for_all_when_a_member_fails():
    """The members that are left do not go on alone; nothing is counted as done by fewer than needed."""
    mission = mission_of(task("lift", robots_needed=2), events=[Event(at_s=6, robot_fails="r_1")])
    executor = carried_out(mission, plan_of(r_0=["lift"], r_1=["lift"]), replan=keeping)
    assert "work_broken_off" in {e.kind for e in executor.events}
    assert not executor.ledger.ends_s
    assert "lift" in executor.lost()


def test_due_times_make_lateness():
    mission = mission_of(task("a", due_s=5.0, priority=2.0), robots=1)
    report = report_of(carried_out(mission, replace(plan_of(r_0=["a"]), objective="lateness"), replan=keeping).account)
    assert report.lateness_s == report.tasks[0].lateness_s == pytest.approx(6, abs=NEAR)
    assert report.objective.flown == pytest.approx(12, abs=2 * NEAR)


def test_a_shift_that_is_over_leaves_the_robot_without_tasks_and_the_plan_whole():
    late = task("late", x=30.0)
    events = [Event(at_s=45.0, new_task=Task(id="new", position=(1.0, 0.0), duration_s=1.0))]
    mission = mission_of(task("a"), late, robots=1, events=events)
    mission = replace(mission, robots=(replace(mission.robots[0], available_until_s=40.0),))
    executor = carried_out(mission, plan_of(r_0=["a"]))
    assert executor.ledger.ends_s.keys() == {"a"}
    assert "shift: would be back at 45.0 s, after 40 s, even without it" in executor.lost()["new"]


def test_the_same_robots_as_before_must_be_enough():
    lift = task("lift", x=5.0, needs={"lift_kg": 30.0}, same_robot_as=("a",))
    events = [Event(at_s=20.0, new_task=Task(id="new", position=(1.0, 0.0), duration_s=1.0))]
    mission = mission_of(task("a"), lift, robots=2, events=events, abilities={"lift_kg": 20.0})
    executor = carried_out(mission, plan_of(r_0=["a"]))
    assert executor.lost() == {"lift": "relation: same robot as a (r_0), who have 20 of 30 lift_kg"}


def test_the_same_robots_as_two_different_ones_are_nobody():
    tasks = [task("a"), task("b", same_robot_as=("a",)), task("c", same_robot_as=("b",))]
    events = [Event(at_s=30.0, new_task=Task(id="new", position=(1.0, 0.0), duration_s=1.0))]
    executor = carried_out(mission_of(*tasks, events=events), plan_of(r_0=["a"], r_1=["c"]))
    assert executor.lost() == {"b": "relation: same robot as a (r_0), same robot as c (r_1)"}


def test_what_was_left_out_is_planned_once_more_when_robots_are_free():
    """The second window of `b` opens when `a` is over; the plan has a reason why it left `b` out."""
    mission = mission_of(task("a"), task("b", x=2.0), robots=1)
    reason = Unassigned("b", (Reason("r_0", "not-chosen", "..."),))
    plan = replace(plan_of(r_0=["a"]), unassigned=(reason,))
    executor = carried_out(mission, plan)
    assert executor.ledger.ends_s.keys() == {"a", "b"}
    (again,) = [event for event in executor.events if event.kind == "robots_free"]
    assert again.data == {"left_out": ["b"]}


def test_what_a_plan_leaves_out_without_a_reason_stays_undone():
    executor = carried_out(mission_of(task("a"), task("b", x=2.0), robots=1), plan_of(r_0=["a"]))
    assert executor.lost() == {"b": "left out by the plan"}


def test_a_team_that_breaks_takes_no_other_task_from_its_robot():
    """`watch` begins with the lift; a free search gives it to another robot."""
    lift, watch = task("lift", x=20.0, robots_needed=2), task("watch", x=5.0, starts_with=("lift",))
    events = [Event(at_s=0.25, robot_fails="r_1")]
    for stability, stays in ((0, True), (None, False)):
        rules = Rules(stability=stability, objective="total")
        mission = replace(mission_of(lift, watch, robots=4, events=events), rules=rules)
        executor = carried_out(mission, plan_of(r_0=["lift"], r_1=["lift"], r_3=["watch"]))
        (revision,) = executor.revisions
        assert "lift" in revision.forced
        assert ("watch" not in revision.moved) == stays


def times_of(executor, kind, robot="r_0"):
    return [e.time_s for e in executor.events if e.kind == kind and e.data.get("robot") == robot]


def test_a_robot_neither_drives_nor_works_into_a_break():
    """10 s of work do not fit before the first break, nor 8 m of way before the second."""
    shifts = ((0.0, 9.0), (14.0, 30.0), (40.0, None))
    mission = mission_of(task("a"), task("b", 9.0), robots=1, shifts_s=shifts)
    executor = carried_out(mission, plan_of(r_0=["a", "b"]), replan=keeping)
    assert report_of(executor.account).starts_s == {"a": pytest.approx(14, abs=NEAR), "b": pytest.approx(48, abs=NEAR)}
    assert times_of(executor, "sets_out") == [0, pytest.approx(40, abs=NEAR)]
    assert words_of(executor) == {("r_0", "waits for shift: r_0 works from 14 s on")}


def test_a_team_begins_when_each_of_it_works_through():
    mission = mission_of(task("a", robots_needed=2))
    resting = replace(mission.robots[1], shifts_s=((0.0, 5.0), (20.0, None)))
    mission = replace(mission, robots=(mission.robots[0], resting))
    executor = carried_out(mission, plan_of(r_0=["a"], r_1=["a"]), replan=keeping)
    assert report_of(executor.account).starts_s["a"] == pytest.approx(20, abs=NEAR)
    assert ("r_0", "waits for shift: r_1 works from 20 s on") in words_of(executor)


def test_a_robot_goes_home_after_its_break():
    mission = mission_of(task("a", 8.0), robots=1, shifts_s=((0.0, 20.0), (30.0, 60.0)), return_to_start=True)
    executor = carried_out(mission, plan_of(r_0=["a"]), replan=keeping)
    assert times_of(executor, "returns") == [pytest.approx(30, abs=NEAR)]


def test_a_robot_leaves_late_for_a_short_duty():
    mission = mission_of(task("a", window_s=((50.0, 60.0),)), robots=1, longest_duty_s=20.0, return_to_start=True)
    executor = carried_out(mission, plan_of(r_0=["a"]), replan=keeping)
    (leaves,), (back,) = times_of(executor, "sets_out"), times_of(executor, "robot_at_end")
    assert 40 < leaves < 50 < back <= leaves + 20


def test_what_would_make_a_duty_too_long_is_not_begun():
    delay = Event(at_s=5, delay_task=DelayedTask(task="a", by_s=12))
    mission = mission_of(task("a"), task("b", 2.0), robots=1, longest_duty_s=30.0, events=[delay])
    executor = carried_out(mission, plan_of(r_0=["a", "b"]), replan=keeping)
    assert report_of(executor.account).tasks_done == ("a",)
    refused = [e.data["reason"] for e in executor.events if e.kind == "task_refused"]
    assert [reason.split(":")[0] for reason in refused] == ["duty"]


def test_a_robot_that_has_left_has_what_is_left_of_its_duty():
    mission = mission_of(task("a"), task("b", 2.0), robots=1, longest_duty_s=100.0)
    rests = []

    def kept(rest):
        rests.append(rest)
        return keeping(rest)

    late = replace(mission, events=(Event(at_s=5, new_task=task("c", 3.0)),))
    carried_out(late, plan_of(r_0=["a", "b"]), replan=kept)
    (snapshot,) = rests[-1].crew
    assert snapshot.left_s == pytest.approx(0, abs=NEAR)
