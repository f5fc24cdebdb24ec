"""Robots that decide for themselves begin together what several must do at once, whatever happens to them."""

from dataclasses import replace
from random import Random

import pytest
from tests.muster_team.runs.joint_work import MOMENT_S, check_nobody_was_alone, deeds
from tests.muster_team.runs.simulated_team import SimulatedTeam

from muster import Mission, Robot, Task
from muster.mission.model import TeamPart
from muster_team.knowledge.joint_statements import Presence, attempt_of
from muster_team.knowledge.messages import Fact

LONG_S = 600.0


def place(random):
    return random.uniform(0, 30), random.uniform(0, 30)


def lifting(seed=0, robots=5, tasks=6):
    """Tasks for one, for two or three robots, and pairs that begin together; some wait for others."""
    random = Random(seed)
    made = []
    for k in range(tasks):
        sort = random.choice(
            (
                {},
                {"robots_needed": random.choice((2, 3))},
                {"team": (TeamPart(), TeamPart(requires=("grip",)))},
                {"needs": {"kg": 3.0}},
            )
        )
        before = (str(random.randrange(k)),) if k > 2 and random.random() < 0.3 else ()
        made.append(Task(id=str(k), position=place(random), duration_s=5.0, prerequisites=before, **sort))
    made += [
        Task(id="x", position=place(random), duration_s=3.0),
        Task(id="y", position=place(random), duration_s=6.0, starts_with=("x",)),
    ]
    crew = tuple(
        Robot(id=f"r_{k}", position=place(random), speed_mps=2.0, skills=("grip",), abilities={"kg": 1.0 + k % 2})
        for k in range(robots)
    )
    return Mission(robots=crew, tasks=tuple(made))


def check_each_was_done_once(team):
    assert all(len(teams) == 1 for teams in deeds(team).values()), deeds(team)
    assert not any(node.twice for node in team.net.nodes.values())


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
def test_all_of_a_team_begin_and_end_at_one_moment_however_much_is_lost(seed):
    team = SimulatedTeam(lifting(seed), seed=seed, loss=0.1 * seed, delay_s=0.05, jitter_s=0.1, duplication=0.1)
    assert team.run(LONG_S, lambda: team.rests)
    check_nobody_was_alone(team)
    check_each_was_done_once(team)
    done = deeds(team)
    assert done.keys() == {task.id for task in team.problem.tasks}
    assert done["x"].keys() != done["y"].keys()
    (x,), (y,) = done["x"].values(), done["y"].values()
    assert abs(x - y) <= MOMENT_S


@pytest.mark.long
@pytest.mark.parametrize("seed", range(12))
def test_a_member_that_fails_at_any_moment_frees_the_task_and_nothing_is_done_by_fewer_or_twice(seed):
    random = Random(seed)
    team = SimulatedTeam(lifting(seed), seed=seed, loss=0.2, delay_s=0.05, jitter_s=0.05)
    for robot in random.sample(team.robots, 2):
        team.run(team.world.time_s + random.uniform(1, 20))
        team.crash(robot)
    if random.random() < 0.5:
        team.run(team.world.time_s + random.uniform(0, 15))
        team.restart(robot, remembers=random.random() < 0.5)
    assert team.run(team.world.time_s + LONG_S, lambda: team.rests)
    check_nobody_was_alone(team)
    assert not any(node.twice for node in team.net.nodes.values())


def pair(*, robots=3, **keys):
    """Robots on a line, and a task for two of them."""
    return Mission(
        robots=tuple(Robot(id=f"r_{k}", position=(10.0 * k, 0.0)) for k in range(robots)),
        tasks=(Task(id="lift", position=(0.0, 5.0), **{"robots_needed": 2, "duration_s": 10.0, **keys}),),
    )


def words(team, kind):
    return [(robot, data) for _, robot, said, data in team.told if said == kind]


def test_a_robot_that_waits_for_its_team_says_so():
    team = SimulatedTeam(pair())
    assert team.run(LONG_S, lambda: team.rests)
    ((robot, data),) = words(team, "waits")
    assert (robot, data["cause"], data["words"]) == ("r_0", "team", "waits for team: r_1")


def begun(team):
    return {robot for robot, data in words(team, "starts") if data["task"] == "lift"}


@pytest.mark.parametrize("how", ["crash", "cut"])
def test_a_member_lost_in_mid_work_stops_the_others_and_the_task_is_done_by_a_new_team(how):
    team = SimulatedTeam(pair())
    assert team.run(LONG_S, lambda: begun(team) == {"r_0", "r_1"})
    if how == "crash":
        team.crash("r_1")
    else:
        team.net.cut(["r_1"], ["r_0", "r_2"])
    assert team.run(LONG_S, lambda: "lift" in deeds(team))
    assert ("r_0", {"task": "lift", "robot": "r_0"}) in words(team, "work_broken_off")
    assert (how == "cut") == ("r_1" in {robot for robot, _ in words(team, "work_broken_off")})
    check_nobody_was_alone(team)
    assert list(deeds(team)["lift"]) == [("r_0", "r_2")]


def test_a_member_lost_before_it_comes_frees_the_others():
    team = SimulatedTeam(pair(robots=2))
    assert team.run(LONG_S, lambda: bool(words(team, "waits")))
    team.crash("r_1")
    assert team.run(LONG_S, lambda: team.rests)
    assert not words(team, "starts")


def test_a_team_begins_when_its_window_opens():
    team = SimulatedTeam(pair(window_s=((40.0, 40.5),)))
    assert team.run(LONG_S, lambda: team.rests)
    assert deeds(team)["lift"] == {("r_0", "r_1"): 40.0}


def test_a_member_that_restarts_in_mid_work_makes_both_begin_again():
    team = SimulatedTeam(pair(robots=2))
    assert team.run(LONG_S, lambda: begun(team) == {"r_0", "r_1"})
    team.crash("r_1")
    team.run(team.world.time_s + 1.0)
    team.restart("r_1")
    assert team.run(LONG_S, lambda: team.rests)
    check_nobody_was_alone(team)
    check_each_was_done_once(team)
    assert team.times("starts")["lift"] == 4


def test_two_statements_of_a_robot_that_has_forgotten_the_first_one_count_for_nothing():
    """Others would compute other begins of them, by what they have heard."""
    members = (("a", "lift"), ("b", "lift"))
    said = {
        Fact("lift", robot, "ready", order, Presence(0, from_s, 5.0, members).content)
        for order, (robot, from_s) in enumerate((("a", 10.0), ("b", 12.0)))
    }
    assert attempt_of(said, ("lift",)) == 0
    assert attempt_of({*said, replace(min(said, key=lambda fact: fact.order), order=7)}, ("lift",)) == 0
    again = Fact("lift", "a", "ready", 7, Presence(0, 20.0, 5.0, members).content)
    assert attempt_of({*said, again}, ("lift",)) == 1
