import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster import ParameterError
from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS, Terms
from muster.allocation.auctions.bids import BID_RULES, FIGURES, Standing, lack_penalty, weighted
from muster.allocation.auctions.winners import WINNER_RULES
from muster.model.measured_energy import share_used


@pytest.mark.parametrize(
    ("name", "figure", "bid"),
    [
        ("total", "growth", 4.0),
        ("max", "growth", 14.0),
        ("average", "arrivals", 4.0),
        ("average-as-printed", "growth", 4 * 14.0),
        ("total+max", "growth", 4.0 + 2.0),
        ("makespan", "end", 4.0),
    ],
)
def test_what_a_robot_bids_with_three_tasks_usage_10_in_a_team_up_to_12(name, figure, bid):
    rule = BID_RULES[name]
    assert rule.figure == figure
    assert rule.bid(np.array([4.0]), Standing(usage=10.0, tasks=3, greatest_usage=12.0)) == pytest.approx([bid])


def test_a_robot_that_stays_below_the_greatest_usage_does_not_raise_it():
    bids = BID_RULES["total+max"].bid(np.array([1.0, 3.0]), Standing(usage=10.0, tasks=3, greatest_usage=12.0))
    assert bids.tolist() == [1.0, 4.0]


@pytest.mark.parametrize("name", BIDS)
def test_no_figure_no_bid(name):
    assert np.isinf(BID_RULES[name].bid(np.array([np.inf]), Standing(10.0, 3, 12.0)))


@pytest.mark.parametrize("name", BIDS)
@given(
    figures=st.lists(st.floats(0, 1e6), min_size=2, max_size=6).map(sorted),
    usage=st.floats(0, 1e6),
    tasks=st.integers(0, 50),
    more=st.floats(0, 1e6),
)
def test_a_higher_figure_is_no_lower_bid(name, figures, usage, tasks, more):
    bids = BID_RULES[name].bid(np.array(figures), Standing(usage, tasks, usage + more))
    assert sorted(bids.tolist()) == bids.tolist()


def test_the_words_of_the_terms_are_the_rules_there_are():
    assert tuple(BID_RULES) == BIDS
    assert tuple(WINNER_RULES) == WINNERS
    assert {rule.figure for rule in BID_RULES.values()} == set(FIGURES)


def test_penalties_are_shares():
    capacities = np.array([60.0, 60.0, np.inf, 0.0])
    assert share_used(np.array([0.0, 30.0, 5.0, 0.0]), capacities).tolist() == [0.0, 0.5, 0.0, 0.0]
    assert lack_penalty(np.array([1.0, 0.7])) == pytest.approx([0.0, 0.3])
    assert weighted(np.array([10.0, -10.0, np.inf]), np.array([0.5, 1.0, 0.0])).tolist() == [15.0, -5.0, np.inf]


@pytest.mark.parametrize(
    ("terms", "message"),
    [
        ({"bid": "least"}, "bid: least; expected total or max or average"),
        ({"placement": "front"}, f"placement: front; expected {' or '.join(PLACEMENTS)}"),
        ({"winner": "highest"}, "winner: highest; expected lowest or least-contested"),
        ({"battery_weight": -1}, "battery_weight: -1; expected a number from 0 to 1e"),
        ({"suitability_weight": float("nan")}, "suitability_weight: nan"),
    ],
)
def test_terms_out_of_range_are_refused(terms, message):
    with pytest.raises(ParameterError, match=message):
        Terms(**terms)
