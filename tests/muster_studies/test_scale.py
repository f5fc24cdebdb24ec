"""Quality against time: what is run, kept and told."""

import json
from dataclasses import asdict

import pytest

from muster.cli.main import run as command
from muster.mission.errors import MusterError
from muster_studies import scale as scales
from muster_studies.scale import Run, measured, scale


@pytest.fixture
def asked(monkeypatch):
    """What is run; nothing is: greedy does all from 5 s on, auction never, search always, the better the longer."""
    runs = []

    def pretended(mission, size, allocator, limit_s):
        runs.append((size, allocator, limit_s))
        done = {"greedy": size if limit_s >= 5 else 7, "auction": 8, "search": size}[allocator]
        value = {"greedy": 300.0, "auction": 10.0, "search": 210.0 - limit_s}[allocator]
        return Run(size, allocator, limit_s, done, value, 1.5, limit_s + 0.25, 60.4, 2.0)

    monkeypatch.setattr(scales, "measured", pretended)
    return runs


def test_what_has_ended_by_itself_is_not_run_longer(asked):
    report = scale([100], [10.0, 1.0, 5.0])
    assert asked == [
        *((100, name, limit) for limit in (1.0, 5.0) for name in ("greedy", "auction", "search")),
        (100, "auction", 10.0),
        (100, "search", 10.0),
    ]
    assert report.runs == 8
    assert report.cpu_s == 12.0
    assert report.tables[0].rows[1] == ("greedy", "5", 100, 300.0, "1.500", 1.5, 5.25, 0.25, 60)
    assert report.tables[0].rows[2] == ("auction", "1", 8, 10.0, None, 1.5, 1.25, 0.25, 60)
    assert report.tables[0].rows[-1][4] == "1.000"


def test_runs_that_are_kept_are_not_made_again(asked, tmp_path):
    kept, told = tmp_path / "runs.jsonl", []
    first = Run(100, "search", 1.0, 100, 150.0, 0.5, 0.75, 50.0, 1.0)
    kept.write_text(json.dumps(asdict(first)) + "\n", encoding="utf-8")
    report = scale([100], [1.0], kept, told.append)
    assert [run[1] for run in asked] == ["greedy", "auction"] == [run.allocator for run in told]
    assert ("search", "1", 100, 150.0, "1.000", 0.5, 0.75, 0.0, 50) in report.tables[0].rows
    asked.clear()
    again = scale([100], [1.0], kept)
    assert not asked
    assert again.tables == report.tables


@pytest.mark.long
def test_a_run_is_a_process_whose_plan_is_read(tmp_path):
    run = measured(scales._mission(100, tmp_path), 100, "greedy", 30.0)
    assert (run.tasks, run.done, run.key) == (100, 100, (100, "greedy", 30.0))
    assert run.objective > 1000
    assert run.cpu_s > 0
    assert run.memory_mb > 10


@pytest.mark.long
def test_a_run_that_fails_ends_the_bench(tmp_path):
    with pytest.raises(MusterError, match="exit code 2"):
        measured(tmp_path / "none.yaml", 100, "greedy", 1.0)


@pytest.mark.parametrize(
    ("option", "expected"),
    [
        (("--tasks", "50"), "100 or 1000 or 10000 or 100000"),
        (("--seconds", "0"), "--seconds: "),
        (("--seconds", "x"), "--seconds: "),
    ],
)
def test_sizes_and_limits_that_there_are_not(option, expected, capsys):
    assert command(["bench", "scale", *option]) == 2
    assert expected in capsys.readouterr().err


def test_the_tables_are_printed_and_written(asked, tmp_path, capsys):
    page = tmp_path / "scale.md"
    assert command(["bench", "scale", "--tasks", "100,1000", "--seconds", "1,5", "-o", str(page)]) == 0
    assert "1,000 tasks, 20 robots" in capsys.readouterr().out
    assert "| greedy | 5 | 1000 | 300.00 | 1.463 |" in page.read_text(encoding="utf-8")
