"""Terms and books of auctions on the command line."""

import csv
import json
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("folder")


def rows_of(path):
    with Path(path).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_terms_make_a_difference(muster):
    def routes(*terms):
        code, out, _ = muster("solve", "auction-2-as-run", "-a", "auction", *terms, "--format", "json")
        assert code == 0
        return [route["tasks"] for route in json.loads(out)["routes"]]

    plans = [
        routes("--bid", "total"),
        routes("--bid", "max"),
        routes("--bid", "total", "--placement", "append"),
        routes("--bid", "total", "--winner", "least-contested"),
    ]
    assert plans[0][0] == ["task1", "task5"]
    assert len({str(plan) for plan in plans}) == 4


def test_the_default_bid_is_the_objective(muster):
    plans = [
        json.loads(muster("solve", "auction-2", "-a", "auction", "--format", "json", *arguments)[1])["routes"]
        for arguments in (["--objective", "max"], ["--objective", "max", "--bid", "max"])
    ]
    assert plans[0] == plans[1]


@pytest.mark.parametrize(
    "allocator",
    ["auction", "market", "consensus-bundle", "contract-net", "combinatorial-auction", "bertsekas-auction"],
)
def test_a_book_is_written(muster, allocator):
    code, _, err = muster(
        "solve", "yard.yaml", "-a", allocator, "--iterations", 3, "--book", "book.csv", "-o", "plan.json", "-q"
    )
    assert (code, err) == (0, "")
    rows = rows_of("book.csv")
    plan = json.loads(Path("plan.json").read_text(encoding="utf-8"))
    won = {(int(row["round"]), row["task"], row["robot"]) for row in rows if row["winner"] == row["robot"]}
    assert {(award["round"], award["task"], award["robot"]) for award in plan["book"]} <= won
    assert {award["task"] for award in plan["book"]} == {"look", "open", "enter"}


def test_an_allocator_that_holds_no_auction_has_no_book_and_no_terms(muster):
    code, out, err = muster("solve", "yard.yaml", "-a", "greedy", "--book", "b.csv")
    assert (code, out) == (2, "")
    sellers = "auction or market or consensus-bundle or contract-net or combinatorial-auction or bertsekas-auction"
    assert err == f"--book: greedy keeps no book; expected {sellers}\n"
    code, out, err = muster("solve", "yard.yaml", "-a", "greedy", "--bid", "max")
    takers = "auction or market or contract-net or combinatorial-auction or bertsekas-auction"
    assert (code, err) == (2, f"--bid: greedy takes none; expected --allocator {takers}\n")


@pytest.mark.parametrize("option", ["--bid", "--placement", "--winner"])
def test_a_wrong_word_is_refused(muster, option):
    code, out, err = muster("solve", "yard.yaml", "-a", "auction", option, "cheapest")
    assert (code, out) == (2, "")
    assert "'cheapest' is not one of" in err


def test_the_book_may_not_replace_the_mission(muster):
    code, _, err = muster("solve", "yard.yaml", "-a", "auction", "--book", "yard.yaml")
    assert code == 2
    assert err.startswith("yard.yaml: given twice")


def test_explain_tells_the_auction(muster):
    muster("solve", "yard.yaml", "-a", "auction", "-o", "plan.json")
    code, out, _ = muster("explain", "yard.yaml", "plan.json", "--task", "look")
    assert code == 0
    assert "task look went to r_0 in round 3 for 4.00; r_1 could not: skill, lacks camera\n" in out
    code, out, _ = muster("explain", "yard.yaml", "plan.json", "--task", "enter")
    assert "task enter went to r_1 in round 2" in out
    assert "r_0 could not: suitability, type beta scores 0.5 for E, below 0.65" in out


def test_explain_tells_who_had_no_capacity_left(muster):
    Path("two.yaml").write_text(
        "schema: muster/1\nrobots:\n  - {id: a, position: [0, 0], work_capacity: 5}\n"
        "  - {id: b, position: [9, 0]}\ntasks:\n  - {id: t, position: [6, 0]}\n",
        encoding="utf-8",
    )
    muster("solve", "two.yaml", "-a", "auction", "-o", "plan.json")
    out = muster("explain", "two.yaml", "plan.json", "--task", "t")[1]
    assert "task t went to b in round 1 for 6.00; a could not: capacity" in out


def test_explain_gives_the_award_to_programs(muster):
    muster("solve", "yard.yaml", "-a", "auction", "-o", "plan.json")
    data = json.loads(muster("explain", "yard.yaml", "plan.json", "--task", "look", "--format", "json")[1])
    expected = {"round": 3, "task": "look", "robot": "r_0", "price": 4.0, "bids": {"r_0": 4.0}, "bidders": 1}
    assert data["award"] == expected


def test_rounds_and_messages_are_told(muster):
    assert "rounds            3\n" in muster("solve", "yard.yaml", "-a", "auction")[1]
    assert " messages\n" in muster("solve", "yard.yaml", "-a", "consensus-bundle")[1]


def test_words_are_parameters_too(muster):
    code, out, _ = muster("solve", "31T-6R", "-a", "consensus-bundle", "--set", "topology=line", "--format", "json")
    assert code == 0
    assert json.loads(out)["messages"] % 10 == 0
    code, _, err = muster("solve", "31T-6R", "-a", "consensus-bundle", "--set", "topology=star")
    assert (code, err) == (2, "topology: star; expected complete, ring or line\n")
    code, _, err = muster("solve", "31T-6R", "-a", "auction", "--set", "battery_weight=heavy")
    assert (code, err) == (2, 'battery_weight: "heavy"; expected a number\n')


def test_the_book_may_not_replace_the_start_plan(muster):
    muster("solve", "yard.yaml", "-a", "auction", "-o", "start.csv")
    before = Path("start.csv").read_bytes()
    for arguments in (["--book", "start.csv"], ["--book", "start.csv", "-o", "plan.json"]):
        code, _, err = muster("solve", "yard.yaml", "-a", "auction", "--start", "start.csv", *arguments)
        assert code == 2
        assert err.startswith("start.csv: given twice")
    assert Path("start.csv").read_bytes() == before
    assert muster("solve", "yard.yaml", "-a", "auction", "--start", "start.csv", "-o", "start.csv")[0] == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--book", "book.json"], "--book: book.json; expected a file that ends in .csv\n"),
        (["--bid", "max", "--set", "bid=total"], "--set: bid given twice; expected it once, as --bid\n"),
        (
            ["--set", "battery_weight=1", "--set", "battery_weight=2"],
            "--set: battery_weight given twice; expected it once\n",
        ),
        (["--set", "battery_weight=1e308"], "battery_weight: 1e+308; expected a number from 0 to 1e+06\n"),
    ],
)
def test_what_cannot_be_meant_is_refused(muster, arguments, message):
    code, out, err = muster("solve", "yard.yaml", "-a", "auction", *arguments)
    assert (code, out, err) == (2, "", message)


def test_a_disk_without_room_for_the_book(muster):
    Path("full.csv").symlink_to("/dev/full")
    code, _, err = muster("solve", "yard.yaml", "-a", "auction", "--book", "full.csv", "-q")
    assert code == 2
    assert err.startswith("full.csv")


def test_explain_says_when_there_was_no_way(muster):
    Path("island.yaml").write_text(
        "schema: muster/1\nrules: {travel: matrix}\ntravel: {a: a.csv, b: b.csv}\nrobots:\n"
        "  - {id: r, type: a, position: [0, 0]}\n  - {id: s, type: b, position: [9, 0]}\ntasks:\n"
        "  - {id: t, position: [6, 0]}\n",
        encoding="utf-8",
    )
    Path("a.csv").write_text(",r,s,t\nr,0,9,inf\ns,9,0,inf\nt,inf,inf,0\n", encoding="utf-8")
    Path("b.csv").write_text(",r,s,t\nr,0,9,6\ns,9,0,3\nt,6,3,0\n", encoding="utf-8")
    code, _, err = muster("solve", "island.yaml", "-a", "auction", "-o", "plan.json")
    assert (code, err) == (0, "")
    assert (
        "r could not: unreachable, there is no way to it"
        in muster("explain", "island.yaml", "plan.json", "--task", "t")[1]
    )


def test_a_number_of_four_hundred_digits_is_refused(muster):
    code, _, err = muster("solve", "yard.yaml", "-a", "market", "--set", f"ro={'9' * 400}")
    assert code == 2
    assert err.endswith("expected a number of fewer digits\n")
