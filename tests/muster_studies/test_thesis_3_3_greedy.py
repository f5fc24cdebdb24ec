"""The greedy parts of Tables 3.2 to 3.22 come out as published."""

import pytest

from muster.library import as_corrected, published
from muster_studies.comparison_marks import TOLERANCE
from muster_studies.effort import Effort
from muster_studies.registry import study_named

ROUTES = {
    "3.5": "tcf-unconstrained",
    "3.8": "tcf-prerequisites",
    "3.13": "tcf-suitability",
    "3.17": "tcf-work-capacity",
}
TOTALS = {
    "3.2": "tcf-salesmen",
    "3.3": "tcf-salesmen",
    "3.7": "tcf-unconstrained",
    "3.10": "tcf-prerequisites",
    "3.15": "tcf-suitability",
    "3.19": "tcf-work-capacity",
    "3.21": "tcf-objectives",
}
FIGURES = {"total_cost": "C", "total+max": "F", "max_usage": "max u", "equality_index": "E", "tasks_completed": "tasks"}


def of(records, **labels):
    """The one record with these cells."""
    (found,) = [record for record in records if labels.items() <= record.items()]
    return found


@pytest.mark.long
@pytest.mark.parametrize("number", ROUTES)
def test_routes_are_published_ones(tables, number):
    records = tables[number].records()
    compared = 0
    for plan in as_corrected(published(ROUTES[number]))["tables"][number]["plans"]:
        for robot, route in plan["routes"].items():
            own = of(records, scenario=plan["mission"], robot=robot)
            assert own["tasks, own"] == tuple(str(task) for task in route["tasks"])
            assert own["usage, own"] == pytest.approx(route["usage"], abs=TOLERANCE)
            assert own["mark"].startswith("✓")
            compared += 1
    assert compared == len(records)


@pytest.mark.parametrize("number", TOTALS)
def test_figures_are_published_ones(tables, number):
    table = as_corrected(published(TOTALS[number]))["tables"][number]
    rows = [row for row in table["rows"] if row.get("allocator", table.get("allocator")) == "greedy"]
    assert rows
    for row in rows:
        labels = {"scenario": row.get("mission"), "objective": row.get("objective"), "allocator": row.get("allocator")}
        present = {label: value for label, value in labels.items() if value and label in tables[number].columns}
        own = of(tables[number].records(), values="own", **present)
        assert own["mark"] == "✓"
        for key in FIGURES.keys() & row.keys() - {"total_cost" if number == "3.2" else ""}:
            assert own[FIGURES[key]] == pytest.approx(row[key], abs=TOLERANCE), (key, row)


@pytest.mark.parametrize(
    ("number", "labels", "figures"),
    [
        ("3.2", {"allocator": "greedy"}, {"F": 799.22, "tasks": 55}),
        ("3.3", {"allocator": "greedy"}, {"C": 632.94, "F": 799.22}),
        ("3.7", {"scenario": "31T-6R", "allocator": "greedy"}, {"C": 199.43, "F": 241.39, "tasks": 31}),
        ("3.7", {"scenario": "16T-3R", "allocator": "greedy"}, {"C": 259.41, "F": 364.71}),
        ("3.10", {"scenario": "24T-5R", "allocator": "greedy"}, {"C": 186.66, "F": 230.76}),
        ("3.15", {"scenario": "31T-6R", "allocator": "greedy"}, {"C": 221.39, "F": 275.53}),
        ("3.19", {"scenario": "31T-6R50", "allocator": "greedy"}, {"C": 197.32, "F": 245.53, "tasks": 23}),
        ("3.19", {"scenario": "31T-3R44-3R26", "allocator": "greedy"}, {"C": 163.98, "F": 201.69, "tasks": 19}),
        ("3.19", {"scenario": "31T-2R65-4R25", "allocator": "greedy"}, {"C": 194.98, "F": 252.35, "tasks": 21}),
        ("3.21", {"scenario": "31T-6R", "objective": "total"}, {"C": 160.40, "max u": 74.42, "E": 0.42}),
        ("3.21", {"scenario": "16T-3R", "objective": "total"}, {"C": 239.04, "F": 478.08, "E": 0.33}),
        ("3.21", {"scenario": "24T-5R", "objective": "total+max"}, {"max u": 35.54, "E": 0.93}),
    ],
)
def test_some_figures(tables, number, labels, figures):
    own = of(tables[number].records(), values="own", **labels)
    for column, value in figures.items():
        assert own[column] == pytest.approx(value, abs=0.011)


def test_some_routes(tables):
    own = of(tables["3.17"].records(), scenario="31T-2R65-4R25", robot="r_4")
    assert own["tasks, own"] == ("6", "4", "23", "12", "30", "14")
    assert own["usage, own"] == pytest.approx(47.35, abs=0.011)


def test_chains(tables):
    """Table 3.11: the own greedy plans hold to every published chain."""
    steps = [record for record in tables["3.11"].records() if record["allocator"] == "greedy"]
    assert len(steps) == 14
    assert {(step["thesis plan"], step["own plan"]) for step in steps} == {("kept", "kept")}


def test_violations(tables):
    """Table 3.12: the own greedy plans break the same prerequisites, and the judge agrees."""
    records = [record for record in tables["3.12"].records() if record["allocator"] == "greedy"]
    assert [(r["task"], r["before"], r["own plan"], r["own judged"]) for r in records] == [
        ("9", "29", "yes", "rejected"),
        ("1", "0", "yes", "rejected"),
        ("7", "17", "yes", "rejected"),
    ]


def test_capacities(tables):
    """Table 3.16."""
    records = tables["3.16"].records()
    for scenario, capacities in {
        "31T-6R50": [50] * 6,
        "31T-3R44-3R26": [44, 44, 44, 26, 26, 26],
        "31T-2R65-4R25": [25, 65, 25, 25, 65, 25],
    }.items():
        assert [record[f"{scenario}, own"] for record in records] == capacities
        assert [record[f"{scenario}, thesis"] for record in records] == capacities
    assert {record["mark"] for record in records} == {"✓"}


def test_seeds_do_not_matter():
    effort = Effort(seeds=3, tables=("3.7",), iterations=1)
    samples = study_named("thesis-3.3").run(effort)
    assert samples.runs == 3 + 3 * 3  # greedy once in each scenario
