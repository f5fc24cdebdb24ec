"""Two runs never command the same real robots."""

import asyncio

import pytest
from tests.server.runs.store import ADA, planned, settings_of

import muster
from muster.exchange.mission_control import ConflictError
from muster.server.runs.robot_claims import claims_of
from muster.server.services.runs import Runs

HERE, THERE = {"r_0": "udp:127.0.0.1:14550", "r_1": "udpout:10.0.0.2:14550"}, {"r_0": "udp:0.0.0.0:14550#2"}


def over(*endpoints):
    return "mavlink", {"endpoints": {f"r_{k}": endpoint for k, endpoint in enumerate(endpoints)}}


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (over("udp:0.0.0.0:14550"), over("serial:/dev/ttyUSB0", "udpin:127.0.0.1:14550#2")),
        (over("udpout:drone:14550#1"), over("udpout:Drone:14550")),
        (over("serial:/dev/ttyUSB0:57600"), over("serial:/dev/../dev/ttyUSB0")),
        (("ros1", {}), ("ros1", {"master": "http://other:11311", "namespace": "/"})),
        (("ros2", {"namespace": "team"}), ("ros2", {"namespace": "/team/", "domain": 0})),
    ],
)
def test_the_same_robots_are_known_by_other_words(monkeypatch, one, other):
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    assert claims_of(*one) & claims_of(*other)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (over("udp:0.0.0.0:14550"), over("udp:0.0.0.0:14560")),
        (over("udpout:10.0.0.1:14550"), over("udpout:10.0.0.2:14550")),
        (("ros1", {"namespace": "a"}), ("ros1", {"namespace": "b"})),
        (("ros2", {}), ("ros2", {"domain": 7})),
        (("ros1", {}), ("ros2", {})),
        (("kinematic", {}), ("kinematic", {})),
    ],
)
def test_others_are_others(monkeypatch, one, other):
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    assert not claims_of(*one) & claims_of(*other)


def test_a_second_run_of_the_same_robots_is_refused_however_soon_it_is_asked_for(store):
    plan = planned(store, muster.load("6T-2R"))

    async def story():
        runs = Runs(store, settings_of(store, bridges=("mavlink", "ros1")))
        both = (runs.start(ADA, plan, "mavlink", endpoints=ends, arm=True) for ends in (HERE, THERE))
        run, at_once = await asyncio.gather(*both, return_exceptions=True)
        assert isinstance(at_once, ConflictError)
        words = f"run {run.id} commands robots on UDP port 14550; expected others, or that it is over"
        with pytest.raises(ConflictError, match=words):
            await runs.start(ADA, plan, "mavlink", endpoints=THERE, arm=True)
        others = await runs.start(ADA, plan, "ros1", namespace="team")
        await runs.close()
        assert [one.id for one in store.runs.list()] == [others.id, run.id]

    asyncio.run(story())


def test_of_two_runs_that_a_server_left_the_later_one_has_the_robots(store):
    plan = store.plans.get(planned(store, muster.load("6T-2R")))
    left = (plan.mission, plan.mission_version, plan.id, "mavlink")
    first, later = (store.runs.add(*left, {"endpoints": ends, "arm": True}, 1.0, "ada").id for ends in (HERE, THERE))

    async def story():
        runs = Runs(store, settings_of(store, bridges=("mavlink",)))
        await runs.start_up()
        assert runs.under_way == 1
        with pytest.raises(ConflictError, match=f"run {later} commands robots on UDP port 14550"):
            await runs.start(ADA, plan.id, "mavlink", endpoints=HERE, arm=True)
        await runs.close()

    asyncio.run(story())
    found = store.runs.get(first)
    assert (found.state, found.remark) == ("failed", f"run {later}, which began later, commands its robots")
