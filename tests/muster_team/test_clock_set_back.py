"""A robot that starts again without memory, with a lower incarnation than before: its clock was set back."""

import pytest
from tests.muster_team.networks import agree, line_mission, owners, settled_team

from muster_team.knowledge.effects import Notice
from muster_team.knowledge.messages import Heartbeat, Message, Stage
from muster_team.processes.memory_file import Kept, keeper, kept_in

TEAM = {"r_0", "r_1", "r_2"}


def restarted_with_a_lower_incarnation(away_s, **conditions):
    """A team of which r_0, at its ninth incarnation, crashes, stays away, and starts again as its third."""
    net = settled_team(line_mission(tasks=8), **conditions)
    net.crash("r_0")
    net.start(["r_0"], incarnation=9)
    agree(net)
    net.crash("r_0")
    net.run(net.now + away_s)
    net.start(["r_0"], incarnation=3)
    return net


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("away_s", [0.1, 1.0, 20.0])
def test_it_takes_part_again_under_a_higher_incarnation_and_owns_nothing_twice(away_s, seed):
    net = restarted_with_a_lower_incarnation(away_s, seed=seed, loss=0.3 if seed else 0.0, jitter_s=0.05)
    net.run(net.now + 0.01)
    assert net.nodes["r_0"].route == ()
    agree(net)
    assert set(net.nodes["r_0"].epoch.own.members) == TEAM
    assert all(len(robots) == 1 for robots in owners(net).values())
    assert len(owners(net)) == 8
    assert net.nodes["r_0"].incarnation == 10
    assert Notice("renumbered", ("r_0",)) in net.nodes["r_0"].notices
    assert not net.nodes["r_0"].superseded


def test_a_later_start_has_a_higher_incarnation_than_the_one_that_was_taken():
    net = restarted_with_a_lower_incarnation(1.0)
    agree(net)
    net.crash("r_0")
    net.start(["r_0"], incarnation=4)
    agree(net)
    assert net.nodes["r_0"].incarnation == 11


def test_where_the_others_hear_it_and_it_does_not_hear_them_it_owns_nothing():
    net = settled_team(line_mission())
    net.crash("r_0")
    net.start(["r_0"], incarnation=9)
    agree(net)
    net.crash("r_0")
    net.block({("r_1", "r_0"), ("r_2", "r_0")})
    net.start(["r_0"], incarnation=3)
    net.run(net.now + 1.0)
    assert net.nodes["r_0"].route == ()
    net.heal()
    agree(net)
    assert net.nodes["r_0"].incarnation == 10


@pytest.mark.parametrize("seed", range(4))
def test_it_is_corrected_through_robots_that_accept_it_where_not_all_hear_each_other(seed):
    chain = {("r_0", "r_1"), ("r_1", "r_2"), ("r_2", "r_3")}
    links = {*chain, *((b, a) for a, b in chain)}
    net = settled_team(line_mission(robots=4), seed=seed, jitter_s=0.1, links=lambda a, b: (a, b) in links)
    net.crash("r_0")
    net.start(["r_0"], incarnation=9)
    agree(net)
    net.crash("r_0")
    net.crash("r_1")
    net.run(net.now + 15)
    net.start(["r_1"])
    net.start(["r_0"], incarnation=3)
    agree(net, 60)
    assert net.nodes["r_0"].incarnation == 10
    assert all(len(robots) == 1 for robots in owners(net).values())


def test_a_process_of_this_name_that_lives_is_not_outdone():
    net = settled_team(line_mission())
    net.crash("r_0")
    net.start(["r_0"], incarnation=3)
    node = net.nodes["r_0"]
    node.handle(Message("r_0", 9, 5, Stage(1)), net.now)
    assert node.superseded
    assert node.incarnation == 3


def heartbeats_of_r_1(net, *heartbeats):
    """A message of r_1 with these heartbeats."""
    return Message("r_1", 1, 10**6, net.nodes["r_1"].stage, heartbeats=heartbeats)


def test_a_robot_that_the_others_have_accepted_refutes_a_later_start_that_it_has_not_made_a_few_times():
    net = settled_team(line_mission(), loss=0.1)
    for robot in ("r_0", "r_2"):
        heard = heartbeats_of_r_1(net, Heartbeat("r_1", 1, 10**6), Heartbeat("r_0", 7, 1))
        net._send(robot, net.nodes[robot].handle(heard, net.now))
    node = net.nodes["r_0"]
    assert (node.superseded, node.incarnation) == (False, 8)
    agree(net)
    assert len(owners(net)) == 6
    assert all(len(robots) == 1 for robots in owners(net).values())
    for number in (20, 30, 40):
        assert not node.superseded
        node.handle(heartbeats_of_r_1(net, Heartbeat("r_1", 1, 10**7 + number), Heartbeat("r_0", number, 1)), net.now)
    assert node.superseded


@pytest.mark.parametrize("robot", ["r_0", "r_2"])
def test_a_start_in_a_thousand_years_is_not_believed(robot):
    net = settled_team(line_mission())
    node = net.nodes[robot]
    node.handle(heartbeats_of_r_1(net, Heartbeat("r_1", 1, 10**6), Heartbeat("r_0", 2**53, 1)), net.now)
    assert (node.superseded, node.incarnation) == (False, 1)
    assert net.nodes["r_2"].members.incarnation("r_0") == 1


@pytest.mark.parametrize("seed", range(6))
def test_of_two_processes_that_do_not_hear_each_other_the_later_one_keeps_the_name(seed):
    net = settled_team(line_mission(), seed=seed, loss=0.2 * (seed % 2))
    first = net.nodes["r_0"]
    net.start(["r_0"], incarnation=3)
    second = net.nodes["r_0"]
    for _ in range(200):  # what the first one says reaches the others, and what they say both
        net.nodes["r_0"] = second
        net.run(net.now + 0.05)
        for robot in ("r_1", "r_2"):
            other = net.nodes[robot]
            for said in first.tick(net.now):
                net._send(robot, other.handle(said.message, net.now))
            for said in other.tick(net.now):
                net._send("r_0", second.handle(said.message, net.now))
                first.handle(said.message, net.now)
    assert first.superseded
    assert not second.superseded
    agree(net)
    assert all(len(robots) == 1 for robots in owners(net).values())


def test_a_robot_that_some_have_accepted_rises_when_another_tells_that_the_later_process_is_silent():
    net = settled_team(line_mission())
    node = net.nodes["r_0"]
    node.handle(heartbeats_of_r_1(net, Heartbeat("r_1", 1, 10**6), Heartbeat("r_0", 7, 0)), net.now)
    assert not node.superseded
    assert node.incarnation == 8
    agree(net)
    assert all(len(robots) == 1 for robots in owners(net).values())


def test_a_sender_of_a_past_life_is_told_nothing_while_the_later_process_is_heard():
    net = settled_team(line_mission())
    net.crash("r_0")
    net.start(["r_0"], incarnation=9)
    agree(net)
    old = Message("r_0", 3, 5, Stage(1), heartbeats=(Heartbeat("r_0", 3, 5),))
    assert net.nodes["r_1"].handle(old, net.now) == []
    (answer,) = net.nodes["r_1"].handle(old, net.now + 3.0)
    assert answer.to == "r_0"
    assert answer.message.heartbeats == (Heartbeat("r_0", 9, 0),)


def test_what_it_keeps_on_disk_holds_the_incarnation_that_it_took(tmp_path):
    net = restarted_with_a_lower_incarnation(1.0)
    agree(net)
    file = tmp_path / "r_0.json"
    keeper(file, Kept(auction="00", robot="r_0", incarnation=3), net.nodes["r_0"])()
    assert kept_in(file, "00", "r_0").incarnation == 10
