"""Custody of one robot, without a bridge: what is wanted, what is seen, and which command follows."""

import pytest

from muster_robots.custody import Custody, CustodyLimits, Holder, Seen, Standing, Wants


class Watch:
    """A custody that is looked at once a second."""

    def __init__(self, **limits):
        self.custody, self.now, self.heard_s = Custody(CustodyLimits(**limits)), 0.0, 0.0

    def see(self, does, holder=Holder.MUSTER, *, seconds=1, **more):
        """The commands of so many seconds of reports that are all alike."""
        commands = []
        for _ in range(seconds):
            self.now += 1.0
            self.heard_s = self.now
            commands.append(self.custody.look(Seen(self.now, self.now, does, holder, **more), self.now))
        return [command for command in commands if command is not None]

    def miss(self, seconds):
        """Nothing is heard for so long."""
        for _ in range(seconds):
            self.now += 1.0
            assert self.custody.look(Seen(self.heard_s, self.heard_s, Wants.ORDER, Holder.MUSTER), self.now) is None

    @property
    def standing(self):
        return self.custody.standing


def wanting(what, **limits):
    watch = Watch(**limits)
    watch.custody.want(what)
    return watch


def test_what_is_wanted_is_said_again_until_it_is_seen():
    watch = wanting(Wants.HOLD, again_s=2.0)
    assert watch.see(Wants.ORDER, seconds=7) == [Wants.HOLD] * 3
    assert watch.see(Wants.HOLD, seconds=7) == []
    assert watch.see(Wants.ORDER, seconds=2) == [Wants.HOLD]  # and if it stops to be so


@pytest.mark.parametrize("wanted", [Wants.HOLD, Wants.RETURN, Wants.LAND])
def test_who_stands_disarmed_is_told_nothing(wanted):
    assert wanting(wanted).see(Wants.IDLE, seconds=10) == []


@pytest.mark.parametrize("wanted", [Wants.IDLE, Wants.ORDER])
def test_orders_are_given_by_whoever_has_them(wanted):
    assert wanting(wanted).see(Wants.HOLD, seconds=10) == []


def test_an_order_is_said_again_where_that_is_asked_for_and_each_time_after_twice_as_long():
    watch = wanting(Wants.ORDER, again_s=2.0)
    watch.custody.repeats_orders = True
    assert watch.see(Wants.IDLE, seconds=31) == [Wants.ORDER] * 4  # at 2, 6, 14 and 30 s
    watch.see(Wants.ORDER)
    assert watch.see(Wants.IDLE, seconds=4) == [Wants.ORDER]


@pytest.mark.parametrize(("gap_s", "silent"), [(2, False), (5, False), (9, False), (11, True), (20, True)])
def test_a_gap_is_a_state_that_ends(gap_s, silent):
    watch = wanting(Wants.ORDER)
    watch.see(Wants.ORDER, seconds=3)
    watch.miss(gap_s)
    assert (watch.standing is Standing.SILENT) == silent
    watch.see(Wants.ORDER)
    assert (watch.standing is Standing.OURS) == (not silent)
    watch.see(Wants.ORDER, seconds=4)
    assert watch.standing is Standing.OURS
    assert not watch.custody.is_worn_out(watch.now)


def test_after_a_gap_the_first_report_counts():
    watch = wanting(Wants.HOLD)
    watch.see(Wants.HOLD)
    watch.miss(15)
    assert watch.see(Wants.ORDER) == [Wants.HOLD]


def test_gaps_that_lie_far_enough_apart_wear_nobody_out():
    for apart_s, worn in ((10, True), (60, False)):
        watch = wanting(Wants.ORDER, troubles=3, troubles_within_s=120.0)
        for _ in range(5):
            watch.miss(12)
            watch.see(Wants.ORDER, seconds=apart_s)
        assert watch.custody.is_worn_out(watch.now) == worn


@pytest.mark.parametrize(
    ("holder", "standing"),
    [
        (Holder.FAILSAFE, Standing.FAILSAFE),
        (Holder.PILOT, Standing.PILOT),
        (Holder.STATION, Standing.STATION),
    ],
)
def test_who_is_in_other_hands_is_told_nothing_and_comes_back(holder, standing):
    watch = wanting(Wants.HOLD)
    assert watch.see(Wants.RETURN, holder) == []
    assert watch.standing is Standing.OURS  # one report may be older than a command
    assert watch.see(Wants.RETURN, holder, seconds=30) == []
    assert watch.standing is standing
    assert watch.see(Wants.ORDER, seconds=2) == [Wants.HOLD]
    watch.see(Wants.HOLD, seconds=7)
    assert watch.standing is Standing.OURS


def test_a_failsafe_that_does_what_is_wanted_disturbs_nobody():
    watch = wanting(Wants.HOLD)
    watch.see(Wants.HOLD, Holder.FAILSAFE, seconds=5)
    assert watch.standing is Standing.OURS


def test_a_pilot_with_sticks_gets_it_for_good_and_the_end_is_said_all_the_same():
    watch = wanting(Wants.HOLD)
    watch.see(None, Holder.PILOT, seconds=3, sticks=True)
    watch.see(Wants.HOLD, seconds=60)
    assert watch.standing is Standing.PILOT
    watch.custody.want(Wants.RETURN)
    assert watch.see(Wants.HOLD, seconds=2) == [Wants.RETURN]


def test_who_is_unfit_is_suspect_until_it_is_fit():
    watch = wanting(Wants.HOLD)
    watch.see(Wants.HOLD, unfit="no position", seconds=20)
    assert watch.standing is Standing.SUSPECT
    watch.see(Wants.HOLD, seconds=5)
    assert watch.standing is Standing.OURS
