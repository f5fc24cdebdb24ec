"""A run is a function of what was asked and when: killed anywhere and resumed it goes on as if nothing had been."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.disturbances.missions import disturbed_mission
from tests.server.runs.stage import Kept, performed, performed_with_crashes, require_same

import muster
from muster.execution import Status
from muster.server.runs.log_recorder import DivergedError, LogRecorder
from muster.server.runs.run_loop import RunLoop

MOMENTS = st.floats(0, 60).map(lambda value: round(value, 2))


def requests(mission):
    robots, tasks = st.sampled_from([r.id for r in mission.robots]), st.sampled_from([t.id for t in mission.tasks])
    place = st.lists(st.integers(-9, 9), min_size=mission.dimensions, max_size=mission.dimensions)
    events = st.one_of(
        robots.map(lambda robot: {"robot_fails": robot}),
        robots.map(lambda robot: {"robot_returns": robot}),
        tasks.map(lambda task: {"cancel_task": task}),
        st.tuples(tasks, place).map(lambda pair: {"move_task": {"task": pair[0], "position": pair[1]}}),
        st.tuples(st.sampled_from(["new", "other"]), place).map(
            lambda pair: {"new_task": {"id": pair[0], "position": pair[1], "type": "D"}}
        ),
        st.just({"robot_joins": {"id": "none", "position": [1.0]}}),
        st.just({"nonsense": "x"}),
    )
    verbs = st.one_of(
        events.map(lambda event: ("event", event)),
        st.just(("speed", {"speed": 1e6})),
        st.just(("pause", {})),
        st.just(("resume", {})),
    )
    asked = st.lists(st.tuples(MOMENTS, verbs).map(lambda pair: (pair[0], *pair[1])), max_size=6)
    return asked.map(lambda asked: [*sorted(asked, key=lambda one: one[0]), (1e9, "resume", {})])


@settings(max_examples=4)
@given(st.data())
def test_killed_anywhere_and_resumed_the_log_is_the_same(data):
    mission = disturbed_mission(data.draw(st.integers(0, 400), label="mission"))
    plan = muster.solve(mission, iterations=20)
    asked = data.draw(requests(mission), label="asked")
    whole = performed(mission, plan, asked)
    assert [entry["seq"] for entry in whole.log] == list(range(1, len(whole.log) + 1))
    crashes = sorted(data.draw(st.sets(st.integers(0, len(whole.log) - 1), max_size=3)))
    require_same(*performed_with_crashes(mission, plan, asked, crashes), whole)


def test_tasks_are_accounted_for_once_whatever_happens():
    for seed in range(3):
        mission = disturbed_mission(seed)
        plan = muster.solve(mission, iterations=20)
        kept = performed(mission, plan, [(seed / 2, "event", {"robot_fails": mission.robots[0].id})])
        report = kept.log[-1]["data"]
        new = [e["data"]["task"]["id"] for e in kept.log if e["kind"] == "new_task"]
        told = [*report["tasks_done"], *(lost["task"] for lost in report["tasks_lost"])]
        assert sorted(told) == sorted([*(task.id for task in mission.tasks), *new])


def test_who_cancels_gets_a_report_of_all_tasks():
    mission = muster.load("31T-6R50")
    plan = muster.solve(mission, iterations=20)
    kept = performed(mission, plan, [(60.0, "cancel", {})])
    assert [entry["kind"] for entry in kept.log[-2:]] == ["command", "report"]
    report = kept.log[-1]["data"]
    told = [*report["tasks_done"], *(lost["task"] for lost in report["tasks_lost"])]
    assert sorted(told) == sorted(task.id for task in mission.tasks)
    assert report["tasks_done"]
    assert "not done when the run was cancelled" in {lost["reason"] for lost in report["tasks_lost"]}
    assert [entry["data"] for entry in performed(mission, plan, log=kept.log[:-1]).log] == [report]


@pytest.mark.long
def test_a_crash_just_before_the_report_leaves_the_report_the_last_entry():
    mission = muster.load("31T-6R50")
    plan = muster.solve(mission, iterations=20)
    whole = performed(mission, plan).log
    assert [entry["kind"] for entry in performed(mission, plan, log=whole[:-1]).log] == ["report"]


def test_what_a_pause_holds_up_takes_effect_where_it_stands():
    mission = muster.load("31T-6R50")
    plan = muster.solve(mission, iterations=20)
    asked = [(10.0, "pause", {}), (99.0, "event", {"robot_fails": "r_0"}), (99.0, "pause", {}), (99.0, "resume", {})]
    kept = performed(mission, plan, asked)
    commands = [entry for entry in kept.log if entry["kind"] == "command"]
    assert {entry["time_s"] for entry in commands} == {10.0}
    assert [entry["data"]["outcome"] for entry in commands] == ["done", "done", "the run is paused already", "done"]
    after = kept.log[commands[1]["seq"]]
    assert (after["kind"], after["data"]["robot"], after["time_s"]) == ("robot_fails", "r_0", 10.0)


@pytest.mark.long
def test_a_log_that_does_not_come_about_again_is_refused():
    mission = muster.load("31T-6R50")
    plan = muster.solve(mission, iterations=20)
    log = performed(mission, plan).log[:20]
    log[15] = log[15] | {"data": {"robot": "r_9"}}
    with pytest.raises(DivergedError, match="entry 16 of the log"):
        performed(mission, plan, log=log)


class Drives:
    """A run of real robots that never come to an end by themselves."""

    real, done, time_s, next_s = True, False, 5.0, 5.0
    status = Status(robots={}, tasks={})

    def __init__(self):
        self.told = []

    def pause(self):
        self.told.append("pause")

    def break_off(self, reason):
        self.told.append(reason)

    def go_on(self):
        raise AssertionError("robots go on")


def test_a_cancel_before_a_crash_holds_for_real_robots_also_where_the_log_has_no_report():
    mission = muster.load("6T-2R")
    log = [
        {"seq": 1, "time_s": 3.0, "kind": "command", "data": {"action": 1, "verb": "pause", "outcome": "done"}},
        {"seq": 2, "time_s": 4.0, "kind": "command", "data": {"action": 2, "verb": "cancel", "outcome": "done"}},
    ]
    kept, world_run = Kept(), Drives()
    recorder = LogRecorder(mission, kept, log=log, again=False)
    run_loop = RunLoop(world_run, recorder, None, kept, speed=1.0, starts_at=None, ended=lambda: False)
    run_loop.recall(log)
    run_loop.run()
    assert world_run.told == ["not done when the run was cancelled"]
