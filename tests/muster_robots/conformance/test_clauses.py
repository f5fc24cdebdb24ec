"""A right adapter conforms, and each clause finds adapters that are broken in this."""

import os

import pytest
from tests.muster_robots.conformance.adapters import BROKEN, KEPT, Yard, right, stand_of

from muster.mission.errors import ParameterError
from muster_robots.conformance.clauses import CLAUSES
from muster_robots.conformance.kit import findings
from muster_robots.custody_settings import CustodySettings
from muster_robots.goal_fleet import GoalFleet


@pytest.fixture(autouse=True)
def closed():
    yield
    while KEPT:
        os.close(KEPT.pop())


def test_a_right_adapter_conforms():
    found = list(findings(right()))
    assert {one.clause: (one.result, one.seen) for one in found if one.result != "holds"} == {}
    assert [one.clause for one in found] == list(CLAUSES)


def test_it_conforms_where_custody_counts_its_robots_as_silent():
    """Each clause lets a robot be silent for four seconds; a robot that is back must show first that it holds."""

    def strict(*given, **how):
        return GoalFleet(*given, custody=CustodySettings(link_lost_s=1.0), **how)

    others = [name for name, clause in CLAUSES.items() if not clause.silences]
    found = {one.clause: one.result for one in findings(stand_of(Yard(), fleet=strict), without=others)}
    silent = {name for name, clause in CLAUSES.items() if clause.silences}
    assert {name for name, result in found.items() if result == "holds"} == silent


def test_every_clause_has_a_broken_adapter():
    assert list(BROKEN) == list(CLAUSES)


LACKS = {
    "accepts_any_setting": "setting site: a wrong value is accepted",
    "raises_an_error_of_its_own_for_a_wrong_setting": "KeyError: 'no such thing'; expected a MusterError",
    "claims_anew_each_time": "expected the same for the same settings",
    "connects_to_claim": "claims leave behind file /dev/null",
    "claims_nothing": "expected texts, at least one",
    "leaves_a_thread": "left behind after close: thread listener",
    "leaves_a_file": "left behind after close: file /dev/null",
    "opens_once": "port 14550: in use",
    "takes_unknown_robots": "robot no_such_robot, which does not exist, is accepted",
    "does_not_name_unknown_robots": "'bad request', which does not name it",
    "reports_in_its_own_frame": "r_0: at (0.00, 0.00, 0.00), 5.10 m from its place in the mission: map frame?",
    "reports_nothing_new": "expected a new one within 2 s",
    "stamps_by_another_clock": "while the fleet's clock says",
    "reports_charge_in_percent": "charge 90.0; expected a share, 0 to 1",
    "says_arrival_at_once": "r_0: arrival reported 1.80 m from the way point",
    "does_not_go": "r_0: 0 of 2 way points passed within",
    "passes_without_holding": "s after it came; expected hold_s=3 s",
    "goes_on_with_the_order_before": "left the place of its last order",
    "does_not_cancel": "m farther after cancel; expected at most",
    "does_not_stop": "m farther after stop; expected at most",
    "sends_all_robots": "r_1: moved 1.80 m by an order to r_0",
    "freezes_fresh": "an old pose with a new time?",
    "raises_when_a_robot_is_silent": "ends the run for all: RuntimeError: no such host",
    "fails_when_a_robot_is_silent": "r_0: reported as failed (no heartbeat), so it is out for good",
    "waits_for_silent_robots": "s late; expected at most 1 s",
    "gives_silent_robots_up": "r_0: not heard within 10 s after it answers again",
    "drops_orders_after_silence": "r_0: 0 of 1 way points passed within",
    "begins_at_the_start_alone": "r_0: stands away from its start",
    "reports_starts_when_it_is_opened_again": "m from where it was left, when opened again",
    "goes_on_without_renewals": "after orders were renewed last; expected at most 11.",
    "stops_although_it_is_renewed": "after its order, which was renewed",
    "renews_itself": "after orders were renewed last; expected at most 11.",
    "takes_no_orders_after_a_lease": "r_0: 0 of 1 way points passed within",
}


@pytest.mark.parametrize(
    ("clause", "broken"),
    [(name, make) for name, all_made in BROKEN.items() for make in all_made],
    ids=[make.__name__ for all_made in BROKEN.values() for make in all_made],
)
def test_a_clause_finds_what_is_broken(clause, broken):
    others = [name for name in CLAUSES if name != clause]
    (found,) = [one for one in findings(broken(), without=others) if one.clause == clause]
    assert found.result == "lacks"
    assert LACKS[broken.__name__] in found.seen


@pytest.mark.parametrize("ability", ["holds", "battery", "resumes", "leased"])
def test_what_a_fleet_does_not_declare_is_not_asked_of_it(ability):
    declared = [name for name in ("ground", "holds", "battery", "resumes", "leased") if name != ability]
    found = list(findings(stand_of(Yard(), abilities=declared), without=[n for n in CLAUSES if not CLAUSES[n].ability]))
    excused = {one.clause for one in found if one.result == "not declared"}
    assert excused == {name for name, clause in CLAUSES.items() if clause.ability == ability}
    assert all(one.is_well for one in found)


def test_what_cannot_be_tried_does_not_hold():
    stand = right()
    stand.silence = None
    others = [name for name, clause in CLAUSES.items() if not clause.silences]
    found = [one for one in findings(stand, without=others) if one.clause not in others]
    assert {one.result for one in found} == {"not tried"}
    assert not any(one.is_well for one in found)


def test_leases_are_tried_where_there_is_room():
    stand = right()
    stand.lease_reach_m = 20.0
    (found,) = [
        one
        for one in findings(stand, without=[name for name in CLAUSES if name != "lease"])
        if one.result != "left out"
    ]
    assert (found.clause, found.result) == ("lease", "not tried")
    assert found.seen == "expected 27 m free east of r_0 (--lease-reach 27)"


def test_nothing_more_is_tried_where_a_fleet_does_not_open():
    def opens(*_):
        raise OSError("connection refused")

    found = {one.clause: one for one in findings(stand_of(Yard(), opens=opens))}
    assert (found["opens"].result, found["opens"].seen) == ("lacks", "OSError: connection refused")
    assert {found[name].result for name in list(CLAUSES)[3:]} == {"not tried"}


def test_an_unknown_clause_is_refused():
    with pytest.raises(ParameterError, match=r"clause: cansel; expected settings, .*; did you mean 'cancel'"):
        list(findings(right(), without=["cansel"]))
