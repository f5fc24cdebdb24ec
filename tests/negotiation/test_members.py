"""The failure detector, rule by rule."""

import pytest

from muster.negotiation.members import FAR, Members, Patience
from muster.negotiation.messages import Message, Pulse, Stage

PATIENCE = Patience()


@pytest.fixture
def members():
    members = Members("a", PATIENCE)
    members.expect(["a", "b", "c"], 0.0)
    return members


def test_all_are_taken_for_alive_at_first(members):
    assert set(members.present(PATIENCE.suspect_s - 0.1)) == {"a", "b", "c"}


def test_silence_for_suspect_s_is_death_and_a_word_is_life(members):
    members.hear_from(Message("b", 1, 1, Stage(0)), 1.0)
    assert set(members.present(PATIENCE.suspect_s)) == {"a", "b"}
    assert set(members.present(1.0 + PATIENCE.suspect_s)) == {"a"}
    members.hear(Pulse("b", 1, 2), 9.0)
    assert set(members.present(9.0)) == {"a", "b"}


def test_who_is_heard_through_others_alone_has_more_time(members):
    members.hear(Pulse("b", 1, 1), 1.0)
    assert not members.is_far("b")  # it has just begun, and may speak up
    members.hear(Pulse("b", 1, 2), 3.0)
    assert members.is_far("b")
    assert not members.is_far("c")  # of which nothing was heard at all
    assert set(members.present(2.9 + FAR * PATIENCE.suspect_s)) == {"a", "b"}
    assert set(members.present(3.0 + FAR * PATIENCE.suspect_s)) == {"a"}
    members.hear_from(Message("b", 1, 3, Stage(0)), 12.0)
    assert not members.is_far("b")


@pytest.mark.parametrize("old", [Pulse("b", 2, 5), Pulse("b", 2, 4), Pulse("b", 1, 99)])
def test_old_news_do_not_count(members, old):
    members.hear_from(Message("b", 2, 5, Stage(0)), 1.0)
    members.hear(old, 4.9)
    assert "b" not in members.present(5.0)


def test_a_new_incarnation_is_noticed_once(members):
    assert not members.hear(Pulse("b", 3, 1), 0.0)
    assert members.hear(Pulse("b", 4, 1), 0.1)
    assert not members.hear(Pulse("b", 4, 2), 0.2)
    assert members.incarnation("b") == 4


def test_strangers_and_itself_are_not_heard(members):
    assert not members.hear(Pulse("x", 1, 1), 0.0)
    assert not members.hear(Pulse("a", 9, 9), 0.0)
    assert set(members.present(0.0)) == {"a", "b", "c"}
    assert members.incarnation("x") == -1


def test_who_keeps_others_waiting_is_out_for_longer_each_time_up_to_a_limit(members):
    away, now = [], 0.0
    for _ in range(6):
        members.mute("b", now, bids=True)
        begin = now
        while "b" not in members.present(now):
            now += 0.5
            members.hear(Pulse("b", 1, int(2 * now)), now)
        away.append(now - begin)
    assert away == [5.0, 10.0, 20.0, 40.0, 40.0, 40.0]


def test_agreement_forgives(members):
    members.mute("b", 0.0, bids=True)
    members.mute("b", 0.0, bids=True)
    members.forgive(["b"])
    members.mute("b", 0.0, bids=True)
    members.hear(Pulse("b", 1, 1), 4.0)
    assert "b" in members.present(5.0)


def test_who_left_this_robot_out_is_back_when_it_declares_it_again(members):
    members.mute("b", 0.0, bids=False)
    members.mute("c", 0.0, bids=True)
    members.welcome("b")
    members.welcome("c")
    assert set(members.present(0.1)) == {"a", "b"}


def beat(sender, number, *misses):
    return Message(sender, 1, number, Stage(1), pulses=(Pulse(sender, 1, number - 1),), misses=misses)


def test_who_is_not_heard_itself_is_missed(members):
    assert members.misses(0.0) == ("b", "c")
    members.hear_from(beat("b", 1), 0.0)
    members.hear(Pulse("c", 1, 1), 0.0)  # second hand
    assert members.misses(0.1) == ("c",)
    assert members.misses(PATIENCE.suspect_s / 2) == ("b", "c")


def test_what_was_heard_is_passed_on_to_those_that_miss_it(members):
    members.hear_from(beat("b", 7), 0.0)
    members.hear_from(beat("c", 5), 0.0)
    own = Pulse("a", 1, 3)  # that of robot 3 modulo 3, itself, is the one in turn
    assert members.pulses(own, 0.1) == (own,)
    members.hear_from(beat("c", 6, "b"), 0.1)
    assert members.pulses(own, 0.2) == (own, Pulse("b", 1, 7))
    members.hear_from(beat("c", 7), 0.3)
    assert members.pulses(own, 0.4) == (own,)


def test_who_misses_somebody_tells_all(members):
    members.hear_from(beat("b", 7), 0.0)
    assert members.misses(0.1) == ("c",)
    assert members.pulses(Pulse("a", 1, 3), 0.1) == (Pulse("a", 1, 3), Pulse("b", 1, 7))


def test_old_news_are_not_passed_on(members):
    members.hear_from(beat("b", 7), 0.0)
    members.hear_from(beat("c", 5, "b"), 0.4)
    own = Pulse("a", 1, 3)
    assert members.pulses(own, 0.4) == (own, Pulse("b", 1, 7))
    assert members.pulses(own, 0.6) == (own,)


def test_every_robot_is_told_of_in_turn(members):
    members.hear_from(beat("b", 7), 0.0)
    members.hear_from(beat("c", 9), 0.0)
    told = [members.pulses(Pulse("a", 1, number), 0.1)[1:] for number in range(3)]
    assert told == [(), (Pulse("b", 1, 7),), (Pulse("c", 1, 9),)]


def test_strangers_and_past_lives_are_not_heeded(members):
    members.hear(Pulse("b", 2, 1), 0.0)
    assert not members.heeds(beat("x", 1))
    assert not members.heeds(beat("b", 99))
    assert members.heeds(beat("c", 1))
