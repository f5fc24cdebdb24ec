"""The judge on the account of an auction that a plan holds."""

from dataclasses import replace

import pytest

import muster


@pytest.fixture(scope="module")
def mission():
    return muster.load("auction-1")


@pytest.fixture(scope="module")
def plan(mission):
    return muster.solve(mission, "auction", bid="total", placement="append")


def with_award(plan, **changes):
    first, *others = plan.book.awards
    return replace(plan, book=replace(plan.book, awards=(replace(first, **changes), *others)))


def test_a_true_account_is_accepted(mission, plan):
    assert muster.verify(mission, plan).valid


@pytest.mark.parametrize(
    ("changes", "detail"),
    [
        ({"task": "task9"}, "in no route"),
        ({"robot": "firefly1"}, "won by firefly1, but done by another"),
        ({"task": "task4"}, "won 2 times"),
        ({"round": 0}, "round 0 of 6"),
        ({"round": 7}, "round 7 of 6"),
        ({"bids": (("ghost", 1.0),)}, "no robot of the mission"),
        ({"bidders": 1}, "2 bids of 1 robots"),
        ({"price": -5.0}, "was not the bid"),
    ],
)
def test_a_false_account_is_found(mission, plan, changes, detail):
    found = muster.verify(mission, with_award(plan, **changes)).violations
    assert any(violation.kind == "book" and detail in violation.detail for violation in found)
