"""How long one robot of a team stays, and what it has then."""

import threading

import pytest

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from tests.muster_team.network.test_udp import transports
from tests.muster_team.teams import Team

from muster_team.membership.members import Timeouts
from muster_team.processes.one_robot import StayLimits, take_part

HASTY = Timeouts(suspect_s=0.5, bid_s=1.0, exclusion_s=1.0)


def test_what_all_have_agreed_on_holds_for_those_that_stay_when_others_have_left():
    team = Team("auction-2", timeouts=HASTY)
    made, found = transports(team.robots), {}

    def be(robot, linger_s):
        with team.node(robot, made[robot]) as node:
            limits = StayLimits(wait_s=30.0, linger_s=linger_s, limit_s=30.0)
            found[robot] = take_part(node, limits, lambda status: None)[0]
            found[robot, "members"] = node.negotiator.epoch.own.members

    threads = [threading.Thread(target=be, args=(r, 0.3 if k else 3.0)) for k, r in enumerate(team.robots)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    first, *others = team.robots
    assert found[first, "members"] == (first,)  # it has noticed that the others are gone
    central = {robot: tuple(tasks) for robot, tasks in team.central_routes().items() if tasks}
    assert found[first].routes == central
    assert all(found[robot].routes == found[first].routes for robot in others)
