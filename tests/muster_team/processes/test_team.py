"""A whole team on this machine: its processes agree, through deaths, and none outlives the one that started them."""

import os
import signal
import subprocess
import sys
import time
from random import Random

import pytest

from muster import verify
from muster.allocation.auctions.auction import AUCTION, Parameters
from muster.allocation.stop import Stop
from muster.generation.uniform import uniform_mission
from muster.mission.errors import MusterError
from muster.model.problem import Problem
from muster_team.negotiators.participation import plan_of_view
from muster_team.network.keys import new_key
from muster_team.network.transport import TRANSPORTS
from muster_team.processes.process_reports import TeamSetup
from muster_team.processes.team import Team, timeouts_for

GUARD_S = 60.0


def problem_of(robots, tasks, seed=1):
    return Problem.compile(uniform_mission(Random(seed), robots=robots, tasks=tasks)).ready()


def team_of(problem, **others):
    others = {"terms": Parameters(), "key": new_key(), "timeouts": timeouts_for(len(problem.robots))} | others
    return Team(TeamSetup(problem=problem, **others))


def until(team, true):
    """Let the team go on until something is true."""
    guard_s = time.monotonic() + GUARD_S
    while not (result := true()):
        assert time.monotonic() < guard_s
        team.poll(0.05)
    return result


def assert_agreed(problem, views):
    routes = [view.routes for view in views.values()]
    assert all(others == routes[0] for others in routes)
    done = [task for tasks in routes[0].values() for task in tasks]
    assert sorted(done) == sorted(task.id for task in problem.tasks)
    assert routes[0].keys() <= views.keys()
    plan = plan_of_view(problem, Parameters(), next(iter(views.values())))
    verdict = verify(problem.mission, plan)
    assert verdict.valid, verdict.violations


def exists(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.long
@pytest.mark.parametrize(
    ("transport", "robots", "tasks", "victims"),
    [
        ("udp", 5, 40, ("r_0",)),
        *(pytest.param(each, 20, 50, ("r_0", "r_7", "r_13"), marks=pytest.mark.long) for each in TRANSPORTS),
    ],
)
def test_when_some_are_killed_in_the_middle_the_others_do_it_all(transport, robots, tasks, victims):
    problem = problem_of(robots, tasks)
    with team_of(problem, transport=transport) as team:
        until(team, lambda: any(news.status.round >= 10 for news in team.progress.values()))
        pids = set(team.pids.values())
        for robot in victims:
            os.kill(team.pids[robot], signal.SIGKILL)
        views = until(team, team.agreement)
        assert team.ended.keys() == set(victims)
        assert set(team.ended.values()) == {"killed by SIGKILL"}
    assert len(views) == robots - len(victims)
    assert_agreed(problem, views)
    assert len(pids) == robots
    assert not any(exists(pid) for pid in pids)


@pytest.mark.long
def test_without_faults_it_is_the_plan_of_the_auction_in_one_process():
    problem = problem_of(4, 12)
    with team_of(problem) as team:
        views = until(team, team.agreement)
    central = AUCTION.solve(problem, Stop(), params=Parameters())
    for view in views.values():
        assert plan_of_view(problem, Parameters(), view).routes == central.routes


def agreement_of(team, when_begun=lambda team: None):
    with team:
        until(team, lambda: team.began_s)
        when_begun(team)
        return until(team, team.agreement)


@pytest.mark.long
def test_a_robot_that_cannot_take_part_is_named():
    team = team_of(problem_of(2, 2), method="dance")
    with pytest.raises(MusterError, match=r"^r_[01]: method: dance; expected auction"):
        agreement_of(team)


def test_when_all_are_killed_there_is_nothing_to_wait_for():
    def kill_all(team):
        for pid in team.pids.values():
            os.kill(pid, signal.SIGKILL)

    team = team_of(problem_of(2, 2))
    with pytest.raises(MusterError, match="no robot is left: r_1 killed by SIGKILL"):
        agreement_of(team, kill_all)


STARTER = """
import sys, time
from tests.muster_team.processes.test_team import problem_of, team_of, until

with team_of(problem_of(4, 400)) as team:
    until(team, lambda: team.began_s)
    print(*team.pids.values(), team._factory.pid, flush=True)
    while True:
        team.poll(1.0)
"""


@pytest.mark.long
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_robots_end_with_the_one_that_started_them(how):
    starter = subprocess.Popen(
        [sys.executable, "-c", STARTER], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    pids = [int(word) for word in starter.stdout.readline().split()]
    assert len(pids) == 5
    starter.send_signal(how)
    starter.communicate(timeout=GUARD_S)
    guard_s = time.monotonic() + GUARD_S
    while any(exists(pid) for pid in pids):
        assert time.monotonic() < guard_s
        time.sleep(0.05)


@pytest.mark.long
def test_a_robot_that_stands_still_holds_up_nobody_who_sends_to_it():
    """Far more is sent than a pipe holds; of what is enough once the latest waits, of the rest all."""
    with team_of(problem_of(2, 4)) as team:
        until(team, lambda: len(team.progress) == 2)
        os.kill(team.pids["r_0"], signal.SIGSTOP)
        for k in range(200):
            team.send("r_0", b"x" * 10_000, latest=True)
            team.send("r_0", {"number": k, "filler": "x" * 10_000})
        kinds = [type(word) for word in team._waiting["r_0"]]
        assert kinds.count(bytes) == 1
        assert kinds.count(dict) > 100
        assert team.views(["r_1"]).keys() == {"r_1"}
        os.kill(team.pids["r_0"], signal.SIGCONT)
        until(team, lambda: not team._waiting["r_0"])
