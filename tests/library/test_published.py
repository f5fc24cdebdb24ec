"""The published tables: fixed values from the documents, and that the corrected ones follow from the missions."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from functools import cache
from typing import Any

import pytest

from muster.library import as_corrected, as_printed, mission_names, mission_path, published, published_names
from muster.mission.model import Mission
from muster.mission.reading.yaml_reader import read_yaml

TABLES = {
    "auction-1": [f"5.{k}" for k in range(1, 16)],
    "auction-2": [f"5.{k}" for k in range(16, 24)],
    "market-rescue": ["Figure 3", "Figure 5"],
    "tcf-avoidance": ["A.17", "A.18", "A.22"],
    "tcf-experiments": ["6.2", "6.3", "6.6", "6.7", "6.8", "6.9", "6.10", "6.11"],
    "tcf-objectives": ["3.21", "3.22"],
    "tcf-points-of-interest": ["6.4", "6.5", "A.10"],
    "tcf-prerequisites": ["3.8", "3.9", "3.10", "3.11", "3.12"],
    "tcf-salesmen": ["3.2", "3.3", "3.4", "A.15", "A.16"],
    "tcf-suitability": ["3.13", "3.14", "3.15"],
    "tcf-unconstrained": ["3.5", "3.6", "3.7"],
    "tcf-work-capacity": ["3.16", "3.17", "3.18", "3.19", "3.20"],
}
ERRATA = {  # table -> how many of its values are misprinted
    "3.2": 1,
    "3.6": 1,
    "3.11": 1,
    "3.12": 1,
    "3.14": 2,
    "3.15": 1,
    "3.17": 1,
    "3.18": 1,
    "3.20": 1,
    "3.22": 1,
    "5.17": 1,
    "6.2": 4,
    "6.3": 1,
    "6.5": 2,
    "6.7": 1,
    "6.9": 2,
    "6.11": 2,
    "A.17": 1,
    "A.18": 1,
}
PRINTED_TO = 0.0105  # the documents round some numbers and cut off others


@cache
def section(name: str) -> dict[str, Any]:
    return published(name)


def table(number: str, side: Any = as_printed) -> dict[str, Any]:
    name = next(name for name, numbers in TABLES.items() if number in numbers)
    found: dict[str, Any] = side(section(name)["tables"][number])
    return found


def every(what: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """All `plans` or `rows`, each with the number of its table."""
    for number in itertools.chain(*TABLES.values()):
        for record in table(number, as_corrected).get(what, []):
            yield number, record


@cache
def shipped(name: str) -> Mission:
    path = mission_path(name)
    assert path is not None
    return read_yaml(path)


def usages(mission: Mission, routes: dict[str, Any]) -> list[float]:
    starts = {r.id: r.position for r in mission.robots}
    tasks = {t.id: t for t in mission.tasks}
    assert list(routes) == list(starts)
    found = []
    for robot, route in routes.items():
        done = [tasks[str(name)] for name in route["tasks"]]
        way = [starts[robot], *(t.position for t in done)]
        found.append(sum(map(math.dist, way, way[1:])) + sum(t.actuation_cost for t in done))
    return found


def walk(data: Any) -> Iterator[dict[str, Any]]:
    if isinstance(data, dict):
        yield data
    for item in data.values() if isinstance(data, dict) else data if isinstance(data, list) else ():
        yield from walk(item)


def test_names():
    assert published_names() == list(TABLES)
    with pytest.raises(KeyError):
        published("tcf-everything")


@pytest.mark.parametrize("name", TABLES)
def test_file_holds_its_tables(name):
    data = section(name)
    assert list(data["tables"]) == TABLES[name]
    assert data["document"] in ("TCF thesis", "auction thesis", "market paper")
    assert all(t["title"] for t in data["tables"].values())


@pytest.mark.parametrize("name", TABLES)
def test_missions_named_there_ship(name):
    for record in walk(section(name)):
        if "run_as" in record:
            assert record["run_as"] in mission_names()
            assert record["mission"] in mission_names()


@pytest.mark.parametrize("name", TABLES)
def test_every_misprint_says_why_and_is_one(name):
    for number, one in section(name)["tables"].items():
        misprints = [record for record in walk(one) if "printed" in record or "corrected" in record]
        assert all(record.keys() == {"printed", "corrected", "erratum"} for record in misprints)
        assert all(record["printed"] != record["corrected"] and record["erratum"] for record in misprints)
        assert len(misprints) == ERRATA.get(number, 0), number


def test_one_side_of_a_misprint():
    assert as_printed({"a": [1, {"printed": 2, "corrected": 3, "erratum": "why"}]}) == {"a": [1, 2]}
    assert as_corrected({"a": [1, {"printed": 2, "corrected": 3, "erratum": "why"}]}) == {"a": [1, 3]}


@pytest.mark.parametrize(("number", "plan"), [p for p in every("plans") if "allocator" in p[1]])
def test_corrected_usages_follow_from_the_missions(number, plan):
    printed = [route["usage"] for route in plan["routes"].values()]
    assert usages(shipped(plan["run_as"]), plan["routes"]) == pytest.approx(printed, abs=PRINTED_TO)


@pytest.mark.parametrize(("number", "plan"), list(every("plans")))
def test_no_task_stands_twice(number, plan):
    done = [name for route in plan["routes"].values() for name in route["tasks"]]
    assert len(done) == len(set(done))
    if plan["mission"][:3] != "31T" or plan["mission"] == "31T-6R":
        assert len(done) == len(shipped(plan["run_as"]).tasks)


TOTALS_OF = {  # table of routes -> table of their totals
    "3.5": "3.7",
    "3.6": "3.7",
    "3.8": "3.10",
    "3.9": "3.10",
    "3.13": "3.15",
    "3.14": "3.15",
    "3.17": "3.19",
    "3.18": "3.19",
    "6.2": "6.3",
    "6.6": "6.7",
    "6.8": "6.10",
    "6.9": "6.11",
}


@pytest.mark.parametrize(("routes_in", "totals_in"), TOTALS_OF.items())
def test_corrected_totals_follow_from_the_routes(routes_in, totals_in):
    for plan in table(routes_in, as_corrected)["plans"]:
        same = [
            row
            for row in table(totals_in, as_corrected)["rows"]
            if (row["run_as"], row["allocator"]) == (plan["run_as"], plan["allocator"]) and "measured" not in row
        ]
        assert len(same) == 1
        found = usages(shipped(plan["run_as"]), plan["routes"])
        assert same[0]["total_cost"] == pytest.approx(sum(found), abs=PRINTED_TO)
        assert same[0]["total+max"] == pytest.approx(sum(found) + max(found), abs=PRINTED_TO)
        completed = sum(len(route["tasks"]) for route in plan["routes"].values())
        assert same[0].get("tasks_completed", completed) == completed


@pytest.mark.parametrize(("number", "row"), [r for r in every("rows") if "max_usage" in r[1]])
def test_corrected_maxima_add_up(number, row):
    assert row["total+max"] == pytest.approx(row["total_cost"] + row["max_usage"], abs=PRINTED_TO)


@pytest.mark.parametrize(
    ("number", "mission", "cost", "total_and_max"),
    [
        ("3.7", "31T-6R", 199.43, 241.39),
        ("3.7", "16T-3R", 259.41, 364.71),
        ("3.7", "24T-5R", 152.163, 187.704),
        ("3.10", "31T-6R", 229.25, 277.12),
        ("3.10", "16T-3R", 273.68, 371.87),
        ("3.10", "24T-5R", 186.66, 230.76),
        ("3.15", "31T-6R", 221.39, 275.53),
        ("3.15", "16T-3R", 259.03, 370.22),
        ("3.15", "24T-5R", 183.83, 232.91),
        ("3.19", "31T-6R50", 197.32, 245.53),
        ("3.19", "31T-3R44-3R26", 163.98, 201.69),
        ("3.19", "31T-2R65-4R25", 194.98, 252.35),
        ("6.10", "6T-2R", 18.04, 27.85),
    ],
)
def test_greedy_totals(number, mission, cost, total_and_max):
    row = next(r for r in table(number)["rows"] if r["mission"] == mission and r["allocator"] == "greedy")
    assert (row["total_cost"], row["total+max"]) == (cost, total_and_max)


def test_greedy_sequences_of_table_3_17():
    routes = table("3.17")["plans"][0]["routes"]
    assert [route["tasks"] for route in routes.values()] == [
        [20, 11, 13, 1],
        [25, 27],
        [19, 0, 2],
        [26, 15, 30],
        [6, 4, 23, 12, 28],
        [21, 24, 3, 17, 7, 18],
    ]


def test_misprints_keep_both_values():
    def usage(number: str, plan: int, robot: str, side: Any) -> float:
        found: float = table(number, side)["plans"][plan]["routes"][robot]["usage"]
        return found

    for number, plan, robot, printed, corrected in (
        ("3.6", 0, "r_5", 39.03, 39.00),
        ("3.14", 2, "r_1", 38.68, 38.86),
        ("3.17", 1, "r_0", 37.11, 37.71),
        ("6.9", 0, "r_1", 9.82, 9.28),
    ):
        assert usage(number, plan, robot, as_printed) == printed
        assert usage(number, plan, robot, as_corrected) == corrected
    assert table("5.17")["positions"]["task0"] == [-9, -13, 10]
    assert table("5.17", as_corrected)["positions"]["task0"] == [-9, 13, 10]


def test_salesmen_statistics_follow_from_the_ten_runs():
    runs = table("A.15")["total+max"]
    for row in table("3.2", as_corrected)["rows"][2:]:
        ten = runs[row["allocator"]]
        mean = sum(ten) / 10
        assert (row["worst"], row["best"]) == (max(ten), min(ten))
        assert row["mean"] == pytest.approx(mean, abs=PRINTED_TO)
        deviation = math.sqrt(sum((value - mean) ** 2 for value in ten) / 9)
        assert row["standard_deviation"] == pytest.approx(deviation, abs=PRINTED_TO)
        iterations = table("A.16")["iterations"][row["allocator"]]
        assert row["mean_iterations"] == pytest.approx(sum(iterations) / 10, abs=0.5)
    assert table("3.2")["rows"][3]["best"] == 698.19


def test_broken_prerequisites_are_in_the_routes():
    for violation in table("3.12", as_corrected)["violations"]:
        plan = next(p for p in table(violation["table"], as_corrected)["plans"] if p["mission"] == violation["mission"])
        route = plan["routes"][violation["robot"]]["tasks"]
        task, prerequisite = violation["task"], violation["before_prerequisite"]
        assert route.index(task) < route.index(prerequisite)
        before = {t.id: t.prerequisites for t in shipped(plan["run_as"]).tasks}
        assert str(prerequisite) in before[str(task)]


def test_chains_keep_to_the_routes():
    for chain in table("3.11", as_corrected)["chains"]:
        number = "3.8" if chain["allocator"] == "greedy" else "3.9"
        plan = next(p for p in table(number, as_corrected)["plans"] if p["mission"] == chain["mission"])
        before = {t.id: t.prerequisites for t in shipped(plan["run_as"]).tasks}
        done: set[str] = set()
        for step in chain["steps"]:
            route = plan["routes"][step["robot"]]["tasks"]
            assert step["tasks"] == sorted(step["tasks"], key=route.index)
            done |= {str(name) for name in step["tasks"]}
            assert all(done >= set(before[str(name)]) for name in step["satisfied"])


def test_work_capacities_are_those_of_the_missions():
    for name, capacities in table("3.16")["missions"].items():
        assert {r.id: r.work_capacity for r in shipped(name).robots} == capacities


def test_bids_of_auction_1_follow_from_the_positions():
    mission = shipped("auction-1")
    tasks = {t.id: t.position for t in mission.tasks}
    ends = {r.id: r.position for r in mission.robots}
    paths: dict[str, list[str]] = {robot: [] for robot in ends}
    tables = section("auction-1")["tables"].values()
    for number in range(1, 7):
        one_round = [t for t in tables if t.get("round") == number]
        bids = {robot: sheet for t in one_round for robot, sheet in t.get("bids", {}).items()}
        outcome = one_round[-1]
        allocated = {name for path in paths.values() for name in path}
        for robot, sheet in bids.items():
            assert set(sheet) == set(tasks) - allocated
            assert sheet == {t: pytest.approx(math.dist(ends[robot], tasks[t]), abs=0.0501) for t in sheet}
            lowest = min(sheet, key=sheet.__getitem__)
            assert outcome["submitted"][robot] == {lowest: sheet[lowest]}
        winner, won = outcome["winner"]["robot"], outcome["winner"]["task"]
        assert winner == min(bids, key=lambda robot: (min(outcome["submitted"][robot].values()), robot))
        paths[winner].append(won)
        ends[winner] = tasks[won]
    routes = table("5.15")["plans"][0]["routes"]
    assert {robot: route["tasks"] for robot, route in routes.items()} == paths


def test_positions_of_the_auctions_are_those_of_the_missions():
    for number, name, side in (
        ("5.1", "auction-1", as_printed),
        ("5.17", "auction-2", as_printed),
        ("5.17", "auction-2-as-run", as_corrected),
    ):
        assert {t.id: list(t.position) for t in shipped(name).tasks} == table(number, side)["positions"]
    starts = {r.id: list(r.position[:2]) for r in shipped("auction-2").robots}
    assert starts == table("5.16")["positions"]


def test_navigation_paths_of_auction_2():
    routes = table("5.18")["plans"][0]["routes"]
    assert routes["firefly0"]["tasks"] == ["task1", "task5"]
    assert [len(route["tasks"]) for route in routes.values()] == [2, 13, 5, 0, 0]
    routes = table("5.19")["plans"][0]["routes"]
    assert [len(route["tasks"]) for route in routes.values()] == [4, 5, 4, 5, 2]
    routes = table("5.20")["plans"][0]["routes"]
    assert [len(route["tasks"]) for route in routes.values()] == [3, 4, 5, 5, 3]


@pytest.mark.parametrize(("number", "most", "idle"), [("5.21", 15, 12), ("5.22", 8, 1), ("5.23", 4, 0)])
def test_navigation_paths_of_scenario_3_hold_every_task_once(number, most, idle):
    paths = table(number)["paths"]
    assert list(paths) == [f"firefly{k}" for k in range(20)]
    done = [name for path in paths.values() for name in path]
    assert sorted(done) == sorted(f"task{k}" for k in range(50))
    assert (max(map(len, paths.values())), sum(not path for path in paths.values())) == (most, idle)
    assert paths["firefly19"][0] == "task9"  # as the text says


def test_market_allocation_gives_every_survivor_a_robot_of_its_skill():
    model, plan = table("Figure 3"), table("Figure 5")["plans"][0]
    for robot, route in plan["routes"].items():
        for survivor in route["tasks"]:
            assert model["tasks"][survivor]["requires"] == model["robots"][robot]["skills"]
