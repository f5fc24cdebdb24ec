"""What counts as reached and as equal, and how many iterations a case gets."""

from dataclasses import replace

import pytest

from muster.cli.main import run
from muster.mission.errors import ParameterError
from muster_studies.comparison_marks import differences, reached
from muster_studies.effort import Effort
from muster_studies.markdown import as_markdown
from muster_studies.registry import study_named
from muster_studies.runs import Case, Outcome, Sample, perform
from muster_studies.tables import Notes, Report, Table, span
from muster_studies.thesis_3_3.budgets import budgets
from muster_studies.thesis_3_3.rules import step_kept

CASE = Case(mission="6T-2R", allocator="greedy", iterations=1)


def sample(*runs: tuple[int, float]) -> Sample:
    """Runs with these tasks completed, of 6, and values of total+max."""
    verdict = perform(CASE, 0).verdict
    return Sample(
        tuple(
            Outcome(
                CASE,
                seed,
                replace(verdict, tasks_completed=tasks, weight_completed=tasks, total_cost=value, max_usage=0.0),
                1,
                0.0,
                0.0,
            )
            for seed, (tasks, value) in enumerate(runs)
        )
    )


@pytest.mark.parametrize(
    ("runs", "tasks", "mark"),
    [
        ([(6, 10.0), (6, 12.0)], None, "reached 1/2"),
        ([(6, 11.01), (6, 11.02)], None, "reached 1/2"),
        ([(6, 12.0), (6, 13.0)], None, "not reached"),
        ([(5, 1.0)], None, "not reached"),
        ([(5, 99.0)], 4, "reached 1/1"),
        ([(3, 1.0)], 4, "not reached"),
        ([(4, 11.0), (3, 1.0)], 4, "reached 1/2"),
    ],
)
def test_reached_compares_tasks_first(runs, tasks, mark):
    assert reached(sample(*runs), 11.0, tasks) == mark


def test_best_and_worst_compare_tasks_first():
    runs = sample((5, 1.0), (6, 20.0), (6, 30.0), (4, 2.0))
    assert runs.best.seed == 1
    assert runs.worst.seed == 3
    assert runs.mean == pytest.approx(53 / 4)
    assert sample((6, 1.0)).deviation is None


def test_differences():
    assert differences({"C": 1.0, "F": None}, {"C": 1.01, "F": 5.0}, ("C", "F")) == "✓"
    assert differences({"C": 1.0, "F": 7.0}, {"C": 1.02, "F": 5.0}, ("C", "F")) == "C +0.02, F -2.00"


def test_a_check_mark_needs_its_rule_in_the_head_of_the_table():
    ticked = ("3.2", "Tasks", ("F", "mark"), ((1.0, "✓ erratum (1)"),))
    with pytest.raises(ValueError, match=r"Table 3\.2\. Tasks: check marks without their rule"):
        Table(*ticked)
    with pytest.raises(ValueError, match="expected mark_rule"):
        Table(*ticked, mark_rule="what is equal")
    table = Table(*ticked, mark_rule="✓: F as published.")
    report = Report(study="a", document="b", seeds=None, runs=1, cpu_s=0.0, legend=(), tables=(table,))
    assert "\nTasks.\n\n✓: F as published.\n\n| F | mark |" in as_markdown(report, "muster study a")
    assert table.as_dict()["mark_rule"] == "✓: F as published."


def test_the_rule_is_printed_under_the_heading(capsys):
    assert run(["study", "auction-5", "--tables", "5.2"]) == 0
    lines = [line.strip() for line in capsys.readouterr().out.splitlines()]
    heading = next(k for k, line in enumerate(lines) if line.startswith("Table 5.2. "))
    assert lines[heading + 1] == "✓: all own bids as published, to the printed digit."


def test_notes_are_numbered_once():
    notes = Notes()
    assert [notes.number(text) for text in ("a", "b", "a")] == ["(1)", "(2)", "(1)"]
    assert notes.lines() == ("(1) a", "(2) b")


def test_budgets():
    assert budgets(Effort(iterations=7), "31T-6R", "greedy+genetic", 1000) == (7,)
    assert budgets(Effort(quick=True), "31T-6R", "greedy+genetic", 1000) == (1000,)
    published, greater = budgets(Effort(), "31T-6R", "greedy+genetic", 1000)
    assert published == 1000 < greater


def test_a_step_of_a_chain():
    verdict = perform(Case(mission="24T-5R", allocator="greedy", ignored=("suitability", "capacity")), 0).verdict
    assert step_kept("24T-5R", verdict, "r_2", ["10"], ["2", "11"]) == "kept"
    assert step_kept("24T-5R", verdict, "r_2", ["11", "10"], []) == "other robots"
    assert step_kept("24T-5R", verdict, "r_1", ["10"], []) == "other robots"
    assert step_kept("24T-5R", verdict, "r_2", ["10"], ["22"]) == "broken"  # 22 needs 1, which is done later
    assert step_kept("24T-5R", replace(verdict, routes=()), "r_2", ["10"], []) == "rejected"


@pytest.mark.parametrize("wrong", [{"seeds": 0}, {"iterations": -1}])
def test_effort_checks_itself(wrong):
    with pytest.raises(ParameterError, match="expected a whole number"):
        Effort(**wrong)


def test_numbers_of_tables_in_short():
    assert span(("3.2", "3.3", "3.22")) == "3.2 to 3.22"
    assert span(("5.2", "5.20", "scenario-1")) == "5.2 to 5.20, scenario-1"
    assert span(("6T-2R", "a", "b", "c", "d", "e")) == "6T-2R, a, b, c, 2 more"
    headings = [Table(number, "Tasks", (), ()).heading for number in ("3.2", "Figure 5", "6T-2R")]
    assert headings == ["Table 3.2. Tasks", "Figure 5. Tasks", "6T-2R. Tasks"]


def test_unknown_names():
    with pytest.raises(ParameterError, match=r"did you mean 'thesis-3\.3'"):
        study_named("thesis-33")
    with pytest.raises(ParameterError, match=r"table: 3\.23; expected 3\.2 to 3\.22"):
        study_named("thesis-3.3").run(Effort(tables=("3.23",)))
