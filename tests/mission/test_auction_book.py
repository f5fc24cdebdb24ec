"""The book of an auction: its CSV, and what a plan file keeps of it."""

import csv
import json

import pytest

import muster
from muster.mission.auction_book import COLUMNS, MOST_BIDS_OF_AN_AWARD, Award, Book
from muster.mission.reading.plan_reader import read_plan


@pytest.fixture(scope="module")
def plan():
    return muster.solve(muster.load("auction-1"), "auction", bid="total", placement="append")


def test_the_csv_holds_every_bid(plan, tmp_path):
    plan.book.save(tmp_path / "book.csv")
    with (tmp_path / "book.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS == ("round", "task", "robot", "bid", "winner", "price")
    assert len(rows) == len(plan.book.bids) == 2 * (6 + 5 + 4 + 3 + 2 + 1)
    for row, bid in zip(rows, plan.book.bids, strict=True):
        assert (int(row["round"]), row["task"], row["robot"]) == (bid.round, bid.task, bid.robot)
        assert float(row["bid"]) == bid.bid
        assert row["winner"] == (bid.winner or "")
        assert row["price"] == ("" if bid.price is None else repr(bid.price))
    sold = [row["task"] for row in rows if row["winner"] == row["robot"]]
    assert sold == ["task6", "task4", "task1", "task5", "task2", "task3"]


def test_a_plan_file_keeps_the_awards(plan, tmp_path):
    plan.save(tmp_path / "plan.json")
    back = read_plan(tmp_path / "plan.json")
    assert back == plan
    assert back.book.awards == plan.book.awards
    assert back.book.rounds == 6
    assert back.book.award_of("task5").robot == "firefly1"
    assert back.book.award_of("task7") is None
    (tmp_path / "again.csv").write_text("kept")
    with pytest.raises(muster.MusterError, match="every bid"):
        back.book.save(tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_text() == "kept"


def test_a_plan_that_is_not_of_an_auction_has_none():
    assert "book" not in muster.solve(muster.load("auction-1"), "greedy").as_dict()


def test_an_award_names_the_best_bids_only():
    bids = [(f"r_{k}", float(k)) for k in range(50)]
    award = Award.of(3, "t", "r_0", 0.0, bids)
    assert award.bids == tuple(bids[:MOST_BIDS_OF_AN_AWARD])
    assert award.bidders == 50


@pytest.mark.parametrize(
    "book",
    [
        "none",
        [{"round": 1}],
        [{"round": "1", "task": "t", "robot": "r", "price": 1.0, "bids": {}, "bidders": 0}],
        [{"round": 1, "task": "t", "robot": "r", "price": 1.0, "bids": {"r": "low"}, "bidders": 1}],
        [{"round": 1, "task": "t", "robot": "r", "price": None, "bids": {}, "bidders": 0}],
        [7],
    ],
)
def test_a_book_that_is_none_is_refused(book, tmp_path):
    (tmp_path / "plan.json").write_text(json.dumps({"schema": "muster-plan/1", "routes": [], "book": book}))
    with pytest.raises(muster.MusterError, match="book"):
        read_plan(tmp_path / "plan.json")


def test_the_message_names_what_is_wrong(tmp_path):
    award = {"round": 1, "task": "t", "robot": "r", "price": "cheap", "bids": {}, "bidders": 0}
    (tmp_path / "plan.json").write_text(json.dumps({"schema": "muster-plan/1", "routes": [], "book": [award]}))
    with pytest.raises(muster.MusterError, match=r'book\[0\].price: "cheap"; expected a finite number'):
        read_plan(tmp_path / "plan.json")


def test_a_disk_without_room(plan):
    with pytest.raises(OSError, match="/dev/full"):
        plan.book.save("/dev/full")


def test_books_are_equal_if_their_awards_are():
    assert Book(rounds=1, awards=(), for_each_bid=print) == Book(rounds=1, awards=())
