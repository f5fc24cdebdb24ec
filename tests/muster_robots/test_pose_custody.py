"""Custody of a robot that reports poses, without a bridge: what it is seen to do, and what it is told again."""

import pytest

from muster.motion.port import Telemetry
from muster_robots.custody import CustodyLimits, Holder, Wants
from muster_robots.pose_custody import PoseCustody, failures

SPEED_MPS, STEP_S = 1.0, 0.2


class Watch:
    """A robot on a line that is heard five times a second."""

    def __init__(self, *, receives=lambda: True, **limits):
        self.custody = PoseCustody("r", CustodyLimits(silent_after_s=5.0, settled_s=1.0, **limits), "ears", receives)
        self.now, self.x = 0.0, 0.0
        self.said = Telemetry(0.0, (0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0), 0.0, 0, 0)
        self.stand(3.0)

    def drive(self, seconds, *, there=False, heading=0.0):
        return self._pass(seconds, SPEED_MPS, there=there, heading=heading)

    def stand(self, seconds, *, there=False, heading=0.0):
        return self._pass(seconds, 0.0, there=there, heading=heading)

    def miss(self, seconds):
        """Nothing is heard for so long."""
        return self._pass(seconds, None, there=False, heading=0.0)

    def turn(self, seconds):
        return [command for k in range(round(seconds / STEP_S)) for command in self.stand(STEP_S, heading=0.2 * k)]

    def _pass(self, seconds, speed_mps, *, there, heading):
        told = []
        for _ in range(round(seconds / STEP_S)):
            self.now += STEP_S
            if speed_mps is not None:
                self.x += speed_mps * STEP_S
                self.custody.hear(self.now, (self.x, 0.0, 0.0), heading)
                self.said = Telemetry(self.now, (self.x, 0.0, 0.0), heading, (0.0, 0.0, 0.0), 0.0, 0, 0)
            told.append(self.custody.look(self.now, is_carried_out=there))
        return [command for command in told if command is not None]

    @property
    def age_s(self):
        """How old its report counts as."""
        return self.now - self.custody.judged(self.said).time_s

    @property
    def suspended(self):
        return self.custody.judged(self.said).suspended


def ordered(*, goes=True, **how):
    watch = Watch(**how)
    assert watch.custody.want(watch.now, goes=goes)
    return watch


def test_who_was_never_ordered_is_told_nothing_whatever_it_does():
    watch = Watch()
    assert watch.drive(10.0) == watch.stand(10.0) == []


def test_a_robot_that_has_lost_its_goal_gets_it_again_ever_more_rarely():
    """Its navigation plans anew each time, and it may stand as something blocks it."""
    watch = ordered()
    assert watch.drive(5.0) == []
    assert watch.stand(1.0) == []
    assert watch.stand(31.0) == [Wants.ORDER] * 4  # after about 2, 4, 8 and 16 s
    assert watch.drive(3.0) == []
    assert watch.stand(3.0) == [Wants.ORDER]


def test_who_turns_or_is_there_or_whose_navigation_is_at_it_carries_its_order_out():
    watch = ordered()
    assert watch.turn(10.0) == []
    assert watch.stand(10.0, there=True) == []


def test_a_robot_that_is_to_hold_keeps_getting_that_while_it_moves():
    watch = ordered(goes=False)
    assert watch.drive(9.0) == [Wants.HOLD] * 4
    watch.stand(3.0)  # it brakes
    assert watch.stand(20.0) == []
    assert set(watch.drive(3.0)) == {Wants.HOLD}


def test_one_that_trembles_stands():
    watch = ordered(goes=False)
    for k in range(100):
        watch.x = 0.1 * (k % 2)
        assert watch.stand(STEP_S) == []


def test_a_silence_that_is_short_changes_nothing():
    watch = ordered()
    watch.drive(3.0)
    watch.miss(4.0)
    watch.drive(STEP_S)
    assert watch.age_s == 0.0


@pytest.mark.parametrize("goes", [True, False])
def test_a_silent_robot_takes_part_again_when_it_does_what_is_wanted_and_is_told_that_first(goes):
    watch = ordered(goes=goes)
    watch.drive(3.0)
    watch.miss(9.0)
    wrong, right = (watch.stand, watch.drive) if goes else (watch.drive, watch.stand)
    assert watch.age_s == pytest.approx(9.0)
    assert set(wrong(4.0)) == {Wants.ORDER if goes else Wants.HOLD}
    assert watch.age_s == pytest.approx(13.0)
    right(5.0)
    assert watch.age_s == 0.0


def test_whose_orders_nobody_receives_counts_as_not_heard_at_once_and_comes_back(caplog):
    ears = [True]
    watch = ordered(receives=lambda: ears[0])
    watch.drive(2.0)
    ears[0] = False
    watch.drive(4.0)
    assert watch.age_s == pytest.approx(4.0, abs=2 * STEP_S)
    assert caplog.messages == ["robot r: nobody receives its orders; expected ears; it counts as silent"]
    watch.drive(4.0)
    ears[0] = True
    watch.drive(STEP_S)
    assert watch.age_s > 7.0  # it has not shown yet that it obeys
    watch.drive(4.0)
    assert watch.age_s == 0.0


def test_flapping_puts_a_robot_out_once():
    watch = ordered(goes=False, troubles=2)
    for silences in range(1, 5):
        watch.miss(6.0)
        watch.stand(5.0)
        assert watch.age_s == 0.0
        found = failures([watch.custody], watch.now, 7.0)
        assert len(found) == (silences == 3)
        for event in found:
            assert (event.robot_fails, event.at_s) == ("r", 7.0)
            assert event.reason == "silent, or without an answer, more than 2 times in 120 s"


@pytest.mark.parametrize("who", [Holder.PILOT, Holder.STATION])
def test_who_is_taken_is_told_nothing_and_takes_part_again_when_it_has_stood(who):
    watch = ordered()
    watch.drive(3.0)
    watch.custody.take(watch.now, who, "a person with a joystick")
    assert watch.drive(20.0) == []
    assert watch.suspended == f"{who.value}: a person with a joystick"
    assert not watch.custody.want(watch.now, goes=False)  # noted, and not to be said
    watch.stand(4.0)
    assert (watch.suspended == "") == (who is Holder.STATION)
    watch.stand(5.0)
    assert watch.suspended == ""


def test_what_a_robot_was_to_do_before_it_was_taken_is_not_told_again():
    watch = ordered()
    watch.custody.take(watch.now, Holder.STATION, "its goal was cancelled")
    assert watch.stand(20.0) == []


def test_an_order_to_one_that_is_taken_is_told_when_it_is_given_back():
    watch = ordered()
    watch.custody.take(watch.now, Holder.STATION, "its goal was cancelled")
    assert not watch.custody.want(watch.now, goes=True)
    assert watch.stand(4.0) == [Wants.ORDER]
    watch.drive(3.0)
    assert watch.suspended == ""


def test_one_that_was_never_heard_is_no_silence():
    custody = PoseCustody("r", CustodyLimits())
    for now in range(100):
        assert custody.look(float(now), is_carried_out=False) is None
        assert custody.failure(float(now)) == ""
    assert custody.judged(None) is None
