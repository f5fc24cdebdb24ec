"""Who asks when, and who answers: in large teams not all at once."""

import pytest
from tests.muster_team.networks import line_mission, network

from muster_team.negotiators.repairs import CROWD, HELPERS, Repairs

RETRY_S = 0.1
NAMES = [f"r_{k}" for k in range(200)]


def asked_s(members, number=1):
    return [Repairs(name, RETRY_S).asks_s(number, members) for name in NAMES]


def test_in_a_small_team_all_ask_at_once():
    assert set(asked_s(2)) == set(asked_s(CROWD)) == {RETRY_S}


def test_in_a_large_team_about_as_many_ask_in_each_moment():
    waits = asked_s(len(NAMES))
    assert RETRY_S <= min(waits) < max(waits) <= len(NAMES) / CROWD * RETRY_S
    early = sum(wait < 2 * RETRY_S for wait in waits)
    assert CROWD / 2 < early < 2 * CROWD
    assert waits != asked_s(len(NAMES), number=2)  # not always the same are late


@pytest.mark.long
def test_of_a_large_team_the_more_help():
    def helpers(robots):
        """Robots that answer the first heartbeat of one that heard no bids, one of the others being cut off."""
        names = NAMES[:robots]
        net = network(line_mission(robots=robots, tasks=2), delay_s=0.01)
        net.start()
        net.run(0.005)  # declarations are on their way; bids will be cut off
        net.cut(names[:1], names[1:-1], names[-1:])  # and no round ends
        net.run(0.1)
        (out,) = (out for out in net.nodes[names[0]].tick(10 * RETRY_S) if out.to is None)
        return sum(bool(net.nodes[name].handle(out.message, 0.2)) for name in names[1:-1])

    assert 0 < helpers(6) <= 2 * HELPERS
    assert 2 * HELPERS < helpers(60) < 6 * HELPERS
