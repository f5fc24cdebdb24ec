"""What the study says of the published tables: errata, plans that the judge rejects, what is reached."""

import pytest

from muster.library import published, published_names
from muster_studies.comparison_marks import TOLERANCE
from muster_studies.effort import Effort
from muster_studies.misprints import corrected
from muster_studies.registry import study_named
from muster_studies.thesis_3_3.plans import published_plans

ROWS = {
    "3.2": 11,
    "3.3": 19,
    "3.4": 12,
    "3.5": 14,
    "3.6": 14,
    "3.7": 12,
    "3.8": 14,
    "3.9": 14,
    "3.10": 12,
    "3.11": 25,
    "3.12": 6,
    "3.13": 14,
    "3.14": 14,
    "3.15": 12,
    "3.16": 6,
    "3.17": 18,
    "3.18": 18,
    "3.19": 12,
    "3.20": 8,
    "3.21": 12,
    "3.22": 12,
    "A.15": 2,
    "A.16": 2,
    "readings": 28,
}
PLANS = ("3.5", "3.6", "3.8", "3.9", "3.13", "3.14", "3.17", "3.18")
RANDOM_PLANS = ("3.6", "3.9", "3.14", "3.18")


def errata_in(data):
    """Every erratum in published data."""
    if isinstance(data, dict):
        if "erratum" in data:
            yield data["erratum"]
        data = list(data.values())
    for item in data if isinstance(data, list) else ():
        yield from errata_in(item)


def all_published_tables():
    for name in published_names():
        yield from published(name)["tables"].items()


def test_all_tables_are_there(report):
    assert {table.number: len(table.rows) for table in report.tables} == ROWS
    assert [table.number for table in report.tables] == list(ROWS) == list(study_named("thesis-3.3").tables)
    for table in report.tables:
        assert all(len(row) == len(table.columns) for row in table.rows)


def test_every_erratum_is_marked(tables):
    known = [(number, text) for number, table in all_published_tables() for text in errata_in(table) if number in ROWS]
    assert len(known) >= 10
    for number, text in known:
        marks = " ".join(str(record["mark"]) for record in tables[number].records())
        notes = [note for note in tables[number].notes if text in note]
        assert notes, (number, text)
        assert f"erratum {notes[0].split()[0]}" in marks


def test_some_errata(tables):
    printed = {record["robot"]: record for record in tables["3.17"].records() if record["scenario"] == "31T-3R44-3R26"}
    assert printed["r_0"]["usage, thesis"] == 37.11
    assert printed["r_0"]["usage, own"] == pytest.approx(37.71, abs=0.011)
    assert printed["r_0"]["mark"] == "✓ erratum (1)"
    printed = {record["robot"]: record for record in tables["3.14"].records() if record["scenario"] == "31T-6R"}
    assert "3" not in printed["r_5"]["tasks, thesis"]
    assert printed["r_5"]["recomputed"] == pytest.approx(20.91, abs=0.011)
    (row,) = [r for r in tables["3.15"].records() if r["F"] == 229.73]
    assert row["mark"] == "erratum (1)"


def test_the_judge_rejects_exactly_the_known_plans():
    judged = {(number, name): plan for number in PLANS for name, plan in published_plans(number).items()}
    assert {key: plan.as_printed.violations[0].kind for key, plan in judged.items() if not plan.as_printed.valid} == {
        ("3.9", "24T-5R"): "deadlock",
        ("3.18", "31T-6R50"): "repeated-task",
        ("3.18", "31T-2R65-4R25"): "deadlock",
    }
    assert {key for key, plan in judged.items() if not plan.as_corrected.valid} == {
        ("3.9", "24T-5R"),
        ("3.18", "31T-2R65-4R25"),
    }


def test_rejected_plans_are_told(tables):
    told = {
        (number, note.split(":")[0])
        for number in RANDOM_PLANS
        for note in tables[number].notes
        if "the judge rejects the published plan" in note
    }
    assert told == {("3.9", "24T-5R"), ("3.18", "31T-6R50"), ("3.18", "31T-2R65-4R25")}


@pytest.mark.parametrize("number", PLANS)
def test_printed_usages_follow_from_printed_routes(number):
    """With the errata put right, nothing differs: no misprint is unknown."""
    for plan in published_plans(number).values():
        recomputed = {route.robot: route.usage for route in plan.as_corrected.routes}
        for robot, route in plan.routes.items():
            assert recomputed[robot] == pytest.approx(corrected(route)["usage"], abs=TOLERANCE), (plan.scenario, robot)


def test_published_figures_of_rejected_plans_are_for_information(tables):
    marked = {
        (number, record["scenario"])
        for number, table in tables.items()
        for record in table.records()
        if str(record.get("mark")).startswith("for information")
    }
    assert marked == {("3.10", "24T-5R"), ("3.19", "31T-2R65-4R25")}
    assert any("the published plan breaks the rule" in note for note in tables["3.10"].notes)
    assert any("the published plan breaks the rule" in note for note in tables["3.19"].notes)


def test_random_rows_have_statistics(tables):
    """Best, mean and worst in order, and a mark, in every own row of a random algorithm."""
    seen = 0
    for number in ("3.2", "3.3", "3.4", "3.7", "3.10", "3.15", "3.20"):
        for record in tables[number].records():
            if record["values"] == "own" and record["iterations"] is not None:
                assert record["iterations"] == 100
                assert record["F"] <= record["mean"] + 1e-9
                assert record["mean"] <= record["worst"] + 1e-9
                assert record["mark"].startswith(("reached", "not reached", "for information"))
                seen += 1
    assert seen == 4 + 8 + 4 + 3 + 3 + 3 + 4


def test_uneven_runs_are_noted(tables):
    """A mean over plans with different numbers of tasks says so."""
    notes = {note[:3] for note in tables["3.19"].notes if "different numbers of tasks" in note}
    for record in tables["3.19"].records():
        assert isinstance(record["tasks"], str) == any(note in str(record["mark"]) for note in notes)


def test_runs_are_of_the_missions_that_the_published_runs_had():
    study = study_named("thesis-3.3")
    report = study.run(Effort(seeds=1, iterations=0, tables=("3.13", "3.17", "3.20")))
    for table in report.tables:
        assert any(note.startswith("Run as ") and "-as-run" in note for note in table.notes)


def test_tables_3_11_and_3_12_know_the_rejected_plan(tables):
    chain = [r for r in tables["3.11"].records() if (r["scenario"], r["allocator"]) == ("24T-5R", "greedy+genetic")]
    assert {step["thesis plan"] for step in chain} == {"rejected (2)"}
    assert {r["thesis plan"] for r in tables["3.12"].records()} == {"yes"}
    assert {r["thesis judged"] for r in tables["3.12"].records()} == {"rejected"}
