"""The study that compares all allocators on all shipped missions."""

import json

import pytest

import muster
from muster.allocation.registry import ALLOCATORS
from muster.cli.main import run
from muster_studies.allocators.study import MISSIONS, OBJECTIVES
from muster_studies.effort import Effort
from muster_studies.markdown import as_markdown
from muster_studies.registry import study_named


@pytest.fixture(scope="module")
def compared():
    return study_named("allocators").run(Effort(iterations=20, tables=("6T-2R", "31T-3R44-3R26")))


def test_all_that_ships_as_a_mission_is_in_it():
    assert set(study_named("allocators").tables) == {"summary", *MISSIONS}
    assert {"31T-6R50", "eil51-5", "auction-2", "market-rescue-20"} <= set(MISSIONS)


@pytest.mark.long
def test_a_table_has_every_allocator_and_objective(compared):
    for table in compared.tables[1:]:
        assert [row["allocator"] for row in table.records()] == list(ALLOCATORS)
        assert set(OBJECTIVES) < set(table.columns)


@pytest.mark.long(keep=3)
@pytest.mark.parametrize("allocator", ALLOCATORS)
def test_values_are_the_judges(compared, allocator):
    mission = muster.load("6T-2R")
    table = next(table for table in compared.tables if table.number == "6T-2R")
    (row,) = (row for row in table.records() if row["allocator"] == allocator)
    for objective in OBJECTIVES:
        plan = muster.solve(mission, allocator, objective=objective, iterations=20)
        assert row[objective] == muster.verify(mission, plan).value(objective)


def test_tasks_left_out_are_told(compared):
    table = next(table for table in compared.tables if table.number == "31T-3R44-3R26")
    plan = muster.solve(muster.load("31T-3R44-3R26"), "greedy")
    cell = next(row for row in table.records() if row["allocator"] == "greedy")["total+max"]
    assert cell == f"{plan.objective_value:.2f} ({plan.tasks_completed})"


@pytest.mark.long
def test_weight_is_told_where_priorities_differ():
    table = study_named("allocators").run(Effort(iterations=20, tables=("flood",))).tables[1]
    cell = next(row for row in table.records() if row["allocator"] == "greedy")["total+max"]
    plan = muster.solve(muster.load("flood"), "greedy", objective="total+max")
    assert plan.weight_completed > plan.tasks_completed
    assert cell == f"{plan.objective_value:.2f} ({plan.tasks_completed}; {plan.weight_completed:g})"


def test_the_summary_measures_from_the_best(compared):
    summary = compared.tables[0]
    assert summary.number == "summary"
    for objective in OBJECTIVES:
        excesses = [row[objective] for row in summary.records() if row[objective] is not None]
        assert min(excesses) >= 0
    assert sum(row["less done"] for row in summary.records()) > 0


def test_markdown_has_every_row_and_the_command(compared):
    lines = as_markdown(compared, "muster study allocators").splitlines()
    assert "Made by `muster study allocators`" in "\n".join(lines[:4])
    assert sum(line.startswith("| market |") for line in lines) == 3
    assert len({line.count("|") for line in lines if line.startswith("| auction")}) <= 2


def test_a_markdown_file_is_written(monkeypatch, tmp_path):
    arguments = ["study", "allocators", "--tables", "6T-2R", "--iterations", "1", "--workers", "1"]
    arguments += ["-o", str(tmp_path / "t.md")]
    monkeypatch.setattr("sys.argv", ["muster", *arguments])
    assert run(arguments) == 0
    text = (tmp_path / "t.md").read_text()
    assert "`muster study allocators --tables 6T-2R --iterations 1" in text
    assert "| greedy |" in text


def test_an_unknown_mission_is_refused():
    with pytest.raises(muster.ParameterError, match="did you mean '6T-2R'"):
        study_named("allocators").run(Effort(tables=("6T-2",)))


def test_json_holds_numbers(compared):
    data = json.loads(json.dumps(compared.as_dict()))
    assert isinstance(data["tables"][1]["rows"][0]["total"], float)
