"""The study of the auction thesis: what comes out, what is marked, what is told of scenario 3."""

import pytest

from muster.allocation.auctions.bids import BID_RULES
from muster.library import as_corrected, published
from muster_studies.auction_5.auctions import BIDS
from muster_studies.effort import Effort
from muster_studies.registry import study_named

ROWS = {
    "5.2": 2,
    "5.3": 2,
    **{f"5.{k}": 4 for k in range(4, 16)},
    "scenario-1": 9,
    "5.17": 20,
    "5.18": 10,
    "5.19": 15,
    "5.20": 15,
    "scenario-2": 11,
    "scenario-3": 15,
    "scenario-3-least-contested": 12,
}
ROUNDS = [f"5.{k}" for k in range(2, 15)]


@pytest.fixture(scope="module")
def auction_report():
    return study_named("auction-5").run(Effort())


@pytest.fixture(scope="module")
def auction_tables(auction_report):
    return {table.number: table for table in auction_report.tables}


def own(table):
    return [record for record in table.records() if record["values"] != "thesis"]


@pytest.mark.long
def test_all_tables_are_there(auction_report):
    assert {table.number: len(table.rows) for table in auction_report.tables} == ROWS
    assert list(study_named("auction-5").tables) == list(ROWS)
    assert auction_report.seeds is None
    assert auction_report.runs == 8 + 8 + 24


@pytest.mark.parametrize("number", ROUNDS)
def test_every_round_comes_out(auction_tables, number):
    records = own(auction_tables[number])
    assert {record["mark"] for record in records} == {"✓"}
    assert auction_tables[number].decimals == 1


def test_bids_are_those_of_the_library_and_the_own_ones_in_full(auction_tables):
    thesis, here = auction_tables["5.9"].records()[:2]
    assert {task: thesis[task] for task in ("task1", "task2", "task3", "task4", "task5")} == {
        "task1": None,
        "task2": 6.4,
        "task3": 7.0,
        "task4": None,
        "task5": 7.3,
    }
    assert here["task5"] == pytest.approx(7.3485, abs=1e-4)
    assert here["task1"] is None


def test_a_tie_goes_to_the_first_drone(auction_tables):
    here = own(auction_tables["5.4"])
    assert [(r["drone"], r["task"], r["wins"]) for r in here] == [
        ("firefly0", "task6", "yes"),
        ("firefly1", "task6", "no"),
    ]
    assert here[0]["bid"] == here[1]["bid"] == pytest.approx(3**0.5)


@pytest.mark.parametrize("number", ["5.15", "5.18", "5.19"])
def test_navigation_paths_come_out(auction_tables, number):
    assert {record["mark"] for record in own(auction_tables[number])} == {"✓"}


def test_table_5_20_comes_out_with_the_fitted_bid_alone(auction_tables):
    by_bid = {bid: [r for r in own(auction_tables["5.20"]) if r["values"] == bid] for bid in BIDS[2:4]}
    assert {record["mark"] for record in by_bid["average-as-printed"]} == {"✓"}
    assert {record["mark"] for record in by_bid["average"]} == {"✓", "other tasks (1)"}
    (note,) = auction_tables["5.20"].notes
    assert note.startswith("(1) average is the bid")


def test_the_misprint_is_marked(auction_tables):
    first, *rest = auction_tables["5.17"].records()
    assert first["position, thesis"] == ("-9", "-13", "10")
    assert first["position, own"] == ("-9", "13", "10")
    assert first["mark"] == "✓ erratum (1)"
    assert {record["mark"] for record in rest} == {"✓"}
    assert "sign of y" in auction_tables["5.17"].notes[0]


@pytest.mark.parametrize(
    ("number", "bid", "name"),
    [
        ("scenario-1", "total", "MiniSum"),
        ("scenario-2", "total", "MiniSum"),
        ("scenario-2", "max", "MiniMax"),
        ("scenario-2", "average-as-printed", "MiniAve"),
    ],
)
def test_figures_of_published_paths_are_those_of_own_ones(auction_tables, number, bid, name):
    records = auction_tables[number].records()
    (thesis,) = [record for record in records if record["bid"] == f"{name}, thesis"]
    placement = "append" if number == "scenario-1" else "insert"
    (here,) = [record for record in records if (record["bid"], record["placement"]) == (bid, placement)]
    for figure in ("total", "max", "average"):
        assert here[figure] == pytest.approx(thesis[figure])
    for count in ("done", "most", "idle"):
        assert here[count] == thesis[count]


def test_scenario_3_is_said_to_be_another_instance(auction_tables):
    table = auction_tables["scenario-3"]
    assert "of another instance" in table.notes[0]
    assert "auction-3-seeded" in table.notes[1]
    thesis = [record for record in table.records() if "thesis" in record["bid"]]
    assert [(r["done"], r["most"], r["idle"], r["total"]) for r in thesis] == [
        (50, 15, 12, None),
        (50, 8, 1, None),
        (50, 4, 0, None),
    ]
    paths = as_corrected(published("auction-2"))["tables"]["5.21"]["paths"]
    assert max(map(len, paths.values())) == thesis[0]["most"]


@pytest.mark.parametrize("number", ["scenario-3", "scenario-3-least-contested"])
def test_scenario_3_has_all_bid_rules(auction_tables, number):
    assert set(BIDS) == set(BID_RULES)
    here = [record for record in auction_tables[number].records() if record["placement"]]
    assert [(r["bid"], r["placement"]) for r in here] == [
        (bid, place) for bid in BIDS for place in ("append", "insert")
    ]
    assert {record["done"] for record in here} == {50}
    by_bid = {record["bid"]: record for record in here}
    assert by_bid["total"]["total"] < by_bid["max"]["total"]
    assert by_bid["max"]["max"] < by_bid["total"]["max"]


def test_chosen_tables_alone():
    report = study_named("auction-5").run(Effort(tables=("5.19", "5.17")))
    assert [table.number for table in report.tables] == ["5.17", "5.19"]
    assert report.runs == 2
