"""The failure detector, rule by rule."""

import pytest

from muster_team.knowledge.messages import Heartbeat, Message, Stage
from muster_team.membership.members import FAR, Members, Timeouts

TIMEOUTS = Timeouts()


@pytest.fixture
def members():
    members = Members("a", TIMEOUTS)
    members.expect(["a", "b", "c"], 0.0)
    return members


def test_all_are_taken_for_alive_at_first(members):
    assert set(members.present(TIMEOUTS.suspect_s - 0.1)) == {"a", "b", "c"}


def test_silence_for_suspect_s_is_death_and_a_word_is_life(members):
    members.hear_from(Message("b", 1, 1, Stage(0)), 1.0)
    assert set(members.present(TIMEOUTS.suspect_s)) == {"a", "b"}
    assert set(members.present(1.0 + TIMEOUTS.suspect_s)) == {"a"}
    members.hear(Heartbeat("b", 1, 2), 9.0)
    assert set(members.present(9.0)) == {"a", "b"}


def test_who_is_heard_through_others_alone_has_more_time(members):
    members.hear(Heartbeat("b", 1, 1), 1.0)
    assert not members.is_far("b")  # it has just begun, and may speak up
    members.hear(Heartbeat("b", 1, 2), 3.0)
    assert members.is_far("b")
    assert not members.is_far("c")  # of which nothing was heard at all
    assert set(members.present(2.9 + FAR * TIMEOUTS.suspect_s)) == {"a", "b"}
    assert set(members.present(3.0 + FAR * TIMEOUTS.suspect_s)) == {"a"}
    members.hear_from(Message("b", 1, 3, Stage(0)), 12.0)
    assert not members.is_far("b")


@pytest.mark.parametrize("old", [Heartbeat("b", 2, 5), Heartbeat("b", 2, 4), Heartbeat("b", 1, 99)])
def test_old_news_do_not_count(members, old):
    members.hear_from(Message("b", 2, 5, Stage(0)), 1.0)
    members.hear(old, 4.9)
    assert "b" not in members.present(5.0)


def test_a_new_incarnation_is_noticed_once(members):
    assert not members.hear(Heartbeat("b", 3, 1), 0.0)
    assert members.hear(Heartbeat("b", 4, 1), 0.1)
    assert not members.hear(Heartbeat("b", 4, 2), 0.2)
    assert members.incarnation("b") == 4


def test_strangers_and_itself_are_not_heard(members):
    assert not members.hear(Heartbeat("x", 1, 1), 0.0)
    assert not members.hear(Heartbeat("a", 9, 9), 0.0)
    assert set(members.present(0.0)) == {"a", "b", "c"}
    assert members.incarnation("x") == -1


def test_who_keeps_others_waiting_is_out_for_longer_each_time_up_to_a_limit(members):
    away, now = [], 0.0
    for _ in range(6):
        members.exclude("b", now, bids=True)
        begin = now
        while "b" not in members.present(now):
            now += 0.5
            members.hear(Heartbeat("b", 1, int(2 * now)), now)
        away.append(now - begin)
    assert away == [5.0, 10.0, 20.0, 40.0, 40.0, 40.0]


def test_agreement_forgives(members):
    members.exclude("b", 0.0, bids=True)
    members.exclude("b", 0.0, bids=True)
    members.reset_exclusions(["b"])
    members.exclude("b", 0.0, bids=True)
    members.hear(Heartbeat("b", 1, 1), 4.0)
    assert "b" in members.present(5.0)


def test_who_left_this_robot_out_is_back_when_it_declares_it_again(members):
    members.exclude("b", 0.0, bids=False)
    members.exclude("c", 0.0, bids=True)
    members.readmit("b")
    members.readmit("c")
    assert set(members.present(0.1)) == {"a", "b"}


def heartbeat(sender, number, *unheard):
    return Message(sender, 1, number, Stage(1), heartbeats=(Heartbeat(sender, 1, number - 1),), unheard=unheard)


def test_who_is_not_heard_itself_is_missed(members):
    assert members.unheard(0.0) == ("b", "c")
    members.hear_from(heartbeat("b", 1), 0.0)
    members.hear(Heartbeat("c", 1, 1), 0.0)  # second hand
    assert members.unheard(0.1) == ("c",)
    assert members.unheard(TIMEOUTS.suspect_s / 2) == ("b", "c")


def test_what_was_heard_is_passed_on_to_those_that_miss_it(members):
    members.hear_from(heartbeat("b", 7), 0.0)
    members.hear_from(heartbeat("c", 5), 0.0)
    own = Heartbeat("a", 1, 3)  # that of robot 3 modulo 3, itself, is the one in turn
    assert members.heartbeats(own, 0.1) == (own,)
    members.hear_from(heartbeat("c", 6, "b"), 0.1)
    assert members.heartbeats(own, 0.2) == (own, Heartbeat("b", 1, 7))
    members.hear_from(heartbeat("c", 7), 0.3)
    assert members.heartbeats(own, 0.4) == (own,)


def test_who_misses_somebody_tells_all(members):
    members.hear_from(heartbeat("b", 7), 0.0)
    assert members.unheard(0.1) == ("c",)
    assert members.heartbeats(Heartbeat("a", 1, 3), 0.1) == (Heartbeat("a", 1, 3), Heartbeat("b", 1, 7))


def test_old_news_are_not_passed_on(members):
    members.hear_from(heartbeat("b", 7), 0.0)
    members.hear_from(heartbeat("c", 5, "b"), 0.4)
    own = Heartbeat("a", 1, 3)
    assert members.heartbeats(own, 0.4) == (own, Heartbeat("b", 1, 7))
    assert members.heartbeats(own, 0.6) == (own,)


def test_every_robot_is_told_of_in_turn(members):
    members.hear_from(heartbeat("b", 7), 0.0)
    members.hear_from(heartbeat("c", 9), 0.0)
    told = [members.heartbeats(Heartbeat("a", 1, number), 0.1)[1:] for number in range(3)]
    assert told == [(), (Heartbeat("b", 1, 7),), (Heartbeat("c", 1, 9),)]


def test_strangers_and_past_lives_are_not_heeded(members):
    members.hear(Heartbeat("b", 2, 1), 0.0)
    assert not members.accepts(heartbeat("x", 1))
    assert not members.accepts(heartbeat("b", 99))
    assert members.accepts(heartbeat("c", 1))
