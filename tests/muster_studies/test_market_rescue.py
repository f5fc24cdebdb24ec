"""The study of the market paper: allocation, time chart, and the richer mission."""

import pytest

from muster_studies.effort import Effort
from muster_studies.market_rescue.comparison import BEST_KNOWN, Comparison, best_known_s
from muster_studies.market_rescue.scenario import chart
from muster_studies.registry import study_named

BEST_KNOWN_S = 242.955


@pytest.fixture(scope="module")
def market_report():
    return study_named("market-rescue").run(Effort(seeds=3, quick=True))


@pytest.fixture(scope="module")
def market_tables(market_report):
    return {table.number: table for table in market_report.tables}


def own(table):
    return {record["robot"]: record for record in table.records() if record["values"] == "own"}


def test_figure_5_comes_out(market_tables):
    here = own(market_tables["Figure 5"])
    assert {robot: set(record["survivors"]) for robot, record in here.items()} == {
        "handBot": {"survivor1", "survivor2"},
        "eyeBot": {"survivor3", "survivor5"},
        "rangeBot": {"survivor4"},
    }
    assert {(record["runs"], record["mark"]) for record in here.values()} == {("3/3", "✓")}


def test_figure_6(market_tables):
    """B by hand from Figure 3; A + B of the slowest robot is the mission's time."""
    here = own(market_tables["Figure 6"])
    seconds = {"handBot": 2 * 10.2 / 0.87, "eyeBot": 2 * 1.8 / 0.92, "rangeBot": 4.8 / 0.81}
    for robot, execution in seconds.items():
        assert here[robot]["B"] == pytest.approx(execution)
        assert here[robot]["A + B"] == pytest.approx(here[robot]["A"] + execution)
        assert here[robot]["mark"] == "✓"
        assert len(here[robot]["chart"]) == round(here[robot]["A + B"] / 2)
    assert here["mission"]["A + B"] == pytest.approx(max(here[robot]["A + B"] for robot in seconds))
    paper = [record for record in market_tables["Figure 6"].records() if record["values"] == "paper"]
    assert paper[-1]["A + B"] == 83.0
    assert any("do not compare" in note for note in market_tables["Figure 6"].notes)


def test_chart_of_a_robot_without_tasks(market_tables):
    assert own(market_tables["Figure 6"])["rangeBot"]["chart"] == "---###"
    assert chart(()) == ""


def test_the_best_known_plan_is_what_it_is_said_to_be():
    assert best_known_s() == pytest.approx(BEST_KNOWN_S, abs=0.001)
    assert sorted(number for numbers in BEST_KNOWN.values() for number in numbers) == list(range(1, 21))


def test_comparison(market_tables):
    best_known, *rest = market_tables["market-rescue-20"].records()
    assert best_known["best"] == pytest.approx(BEST_KNOWN_S, abs=0.001)
    assert {record["done"] for record in rest} == {20}
    assert [(record["allocator"], record["iterations"]) for record in rest] == [
        ("greedy", None),
        ("auction", None),
        ("market", 100),
        ("greedy+genetic", 2000),
        ("genetic", 2000),
    ]
    by_allocator = {record["allocator"]: record for record in rest}
    assert by_allocator["market"]["best"] < by_allocator["auction"]["best"] < by_allocator["greedy"]["best"]
    for record in rest:
        assert record["best +%"] == pytest.approx(100 * (record["best"] - BEST_KNOWN_S) / BEST_KNOWN_S, abs=0.001)
    for name in ("market", "greedy+genetic", "genetic"):
        record = by_allocator[name]
        assert record["best"] <= record["mean"] <= record["worst"]
        assert record["reached"] in ("0/3", "1/3", "2/3", "3/3")


def test_given_iterations_are_those_of_all_allocators():
    cases = [case for case in Comparison().jobs(Effort(iterations=7)) if case.random]
    assert [(case.allocator, case.iterations) for case in cases] == [
        ("market", 7),
        ("greedy+genetic", 7),
        ("genetic", 7),
    ]
    report = study_named("market-rescue").run(Effort(seeds=1, iterations=0))
    assert report.runs == 1 + 2 + 3
    assert any("the iterations of the market" in note for note in report.tables[-1].notes)
