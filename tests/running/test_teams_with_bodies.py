"""Teams whose robots have bodies, in the simulated world: one place has room for one of them."""

import muster
from muster.mission.events import Event
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.reading.plan_reader import plan_of


def test_a_team_stands_around_its_place_and_ends_in_time():
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 2.0 * k), radius_m=0.4) for k in range(3))
    tasks = (
        Task(id="lift", position=(10.0, 2.0), robots_needed=3, duration_s=20.0),
        Task(id="after", position=(12.0, 2.0), prerequisites=("lift",), duration_s=1.0),
    )
    mission = Mission(robots=robots, tasks=tasks, rules=Rules(objective="makespan"))
    plan = plan_of({"r_0": ["lift"], "r_1": ["lift"], "r_2": ["lift", "after"]})
    report = muster.simulate(mission, plan)
    assert len(report.tasks_done) == 2
    assert report.ends_s["lift"] - report.starts_s["lift"] <= 20.2
    assert report.contacts == 0


def test_the_rest_is_planned_again_while_a_team_is_at_work():
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 2.0 * k)) for k in range(3))
    tasks = (
        Task(id="lift", position=(5.0, 1.0), robots_needed=2, duration_s=40.0),
        Task(id="far", position=(60.0, 4.0)),
        Task(id="last", position=(5.0, 3.0), prerequisites=("lift",)),
    )
    plan = plan_of({"r_0": ["lift"], "r_1": ["lift", "last"], "r_2": ["far"]})
    fails = Event(at_s=20.0, robot_fails="r_2")
    report = muster.simulate(Mission(robots=robots, tasks=tasks, events=(fails,)), plan)
    assert report.reallocations == 1
    assert set(report.ends_s) == {"lift", "far", "last"}


def test_the_shipped_rescue_is_carried_out_as_planned():
    mission = muster.load("collapsed-building")
    plan = muster.solve(mission, seed=1, iterations=2000)
    report = muster.simulate(mission, plan)
    assert plan.complete
    assert len(report.tasks_done) == len(mission.tasks)
    assert not report.missed
    assert abs(max(report.ends_s.values()) - plan.makespan_s) <= 0.1 * plan.makespan_s
