"""`muster.compare`: own allocators beside others; what is kept, refused and told."""

import math
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import muster
from muster.mission.errors import InputError
from muster_studies.comparison.compare import begun
from muster_studies.comparison.missions import missions_of
from muster_studies.comparison.results_file import ResultsFile
from muster_studies.comparison.settings import Settings


def in_order(problem):
    """All tasks in order, to the robots in turn, as far as they may."""
    routes = [[] for _ in problem.robots]
    for task in range(len(problem.tasks)):
        able = [i for i in range(len(routes)) if problem.allowed[i, task]]
        if able:
            routes[able[task % len(able)]].append(task)
    return routes


def ends_its_process(problem):
    os._exit(7)


def fails(problem):
    raise ZeroDivisionError("in\nvain")


def stops_itself(problem):
    raise KeyboardInterrupt


def exits(problem):
    sys.exit("enough")


def endless(problem):
    while True:
        pass


class OfAClass:
    def __call__(self, problem):
        return in_order(problem)


def small(count=2):
    return muster.generate("uniform", count, tasks=6, robots=2)


def test_an_allocator_of_ones_own_beside_search_on_generated_missions():
    missions = muster.generate("uniform", 6, tasks=8, robots=2)
    found = muster.compare(missions, ["search", in_order], seeds=2, iterations=50, jobs=1)
    frame, table = found.to_frame(), found.table()
    assert len(frame) == 6 * 2 * 2
    assert set(frame.status) == {"done"}
    assert list(table.index) == ["search", "in_order"]
    assert table.wins["search"] == 6
    assert table.gap_mean["search"] == pytest.approx(0, abs=1)
    assert table.gap_mean["in_order"] > 20
    (pair,) = found.pairs
    assert (pair.wins, pair.p_value, pair.exact) == (6, pytest.approx(2 / 64), True)
    assert [line.get_label() for line in found.plot_profile().get_lines()] == ["search", "in_order"]
    for run in found.runs:
        mission = next(mission for mission in missions if mission.name == run.mission)
        if run.allocator == "in_order":
            routes = {robot.id: [] for robot in mission.robots}
            for k, task in enumerate(mission.tasks):
                routes[mission.robots[k % 2].id].append(task.id)
            assert run.value == pytest.approx(muster.verify(mission, routes).value())


@pytest.mark.long
def test_processes_give_what_one_gives_and_lose_single_runs_alone(capfd):
    given = {"greedy": "greedy", "own": in_order, "local": lambda problem: in_order(problem)}
    one = muster.compare(small(), given, seeds=1, jobs=1)
    lossy = {
        **given,
        "lost": ends_its_process,
        "fails": fails,
        "stops": stops_itself,
        "exits": exits,
        "endless": endless,
    }
    several = muster.compare(small(), lossy, seeds=1, jobs=2, give_up=2)
    values = {(run.mission, run.allocator): run.value for run in several.runs}
    assert {(run.mission, run.allocator): run.value for run in one.runs}.items() <= values.items()
    reasons = {run.allocator: (run.status, run.reason) for run in several.runs}
    assert reasons["lost"] == ("failed", "its process ended: exit code 7")
    assert reasons["fails"] == ("failed", "ZeroDivisionError: in vain")
    assert reasons["stops"] == ("failed", "KeyboardInterrupt")
    assert reasons["exits"] == ("failed", "SystemExit: enough")
    assert reasons["endless"] == ("failed", "given up after 2 s")
    assert [run.allocator for run in several.runs[: len(lossy)]] == list(lossy)
    assert capfd.readouterr() == ("", "")


def test_what_cannot_be_done_or_is_wrong_is_a_row():
    def too_many(problem):
        return [list(range(len(problem.tasks)))] * len(problem.robots)

    windows, plain = muster.generate("windows", robots=3, tasks=5) + muster.generate("uniform", tasks=5)
    found = muster.compare([windows, plain], ["greedy", too_many], seeds=1, iterations=10, jobs=1)
    assert [run.status for run in found.runs] == ["done", "not-applicable", "done", "failed"]
    assert "window_s (window)" in found.runs[1].reason
    assert "too_many" in found.runs[3].reason
    assert [(one.failed, one.not_applicable) for one in found.standings] == [(0, 0), (1, 1)]


def test_results_are_kept_and_gone_on_with(tmp_path):
    file, made = tmp_path / "r.csv", []
    options = {"seeds": 2, "iterations": 20, "jobs": 1, "results": file}
    first = muster.compare(small(), ["greedy", "search"], **options)
    text = file.read_text()
    assert len(text.splitlines()) == 1 + len(first.runs) == 9
    again = muster.compare(small(), ["greedy", "search"], on_run=lambda *run: made.append(run), **options)
    assert (made, file.read_text()) == ([], text)
    assert again.runs == first.runs
    file.write_text(text[: text.rfind("\n", 0, -1) + 20])  # the last line breaks off
    mended = muster.compare(small(), ["greedy", "search"], on_run=lambda *run: made.append(run), **options)
    assert [(run.allocator, count, total) for run, count, total in made] == [("search", 8, 8)]
    assert [run.value for run in mended.runs] == [run.value for run in first.runs]
    more = muster.compare(small(3), ["greedy", "search", "auction"], **options)
    assert len(more.runs) == 18
    assert len(file.read_text().splitlines()) == 19


def test_results_made_otherwise_are_refused(tmp_path):
    file = tmp_path / "r.csv"
    muster.compare(small(), "greedy", seeds=1, iterations=20, jobs=1, results=file)
    with pytest.raises(
        muster.InputError, match=r"r.csv:2: iteration_limit: 20; expected 30, as asked now; or another file"
    ):
        muster.compare(small(), "greedy", seeds=1, iterations=30, jobs=1, results=file)
    other = [muster.Mission(name=small()[0].name, robots=small()[0].robots, tasks=())]
    with pytest.raises(muster.InputError, match=r"r.csv:2: digest: another mission of this name"):
        muster.compare(other, "greedy", seeds=1, iterations=20, jobs=1, results=file)
    file.write_text("a,b\n1,2\n")
    with pytest.raises(muster.InputError, match=r"r.csv:1: a,b; expected results of muster compare"):
        muster.compare(small(), "greedy", seeds=1, iterations=20, jobs=1, results=file)


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("status", "dnoe", "status: dnoe; expected done or not-applicable or failed or invalid"),
        ("value", "", "value: nothing; expected a number"),
        ("value", "nan", "value: nan; expected a number"),
        ("weight_completed", "inf", "weight_completed: inf; expected a number"),
        ("tasks_completed", "6.5", "tasks_completed: 6.5; expected a whole number"),
        ("seed", "", "seed: nothing; expected a whole number"),
        ("cut_short", "", "cut_short: nothing; expected True or False"),
    ],
)
def test_damaged_results_are_refused(name, value, said, tmp_path):
    file, options = tmp_path / "r.csv", {"seeds": 1, "iterations": 20, "jobs": 1}
    muster.compare(small(), "greedy", results=file, **options)
    head, first, second = file.read_text().splitlines()
    cells = second.split(",")
    cells[head.split(",").index(name)] = value
    file.write_text("\n".join([head, first, ",".join(cells), ""]))
    with pytest.raises(InputError, match=rf"r.csv:3: {said}$"):
        muster.compare(small(), "greedy", results=file, **options)


def test_results_saved_by_a_spreadsheet_are_read_and_those_of_another_version_are_refused(tmp_path):
    file, made, options = tmp_path / "r.csv", [], {"seeds": 1, "iterations": 20, "jobs": 1}
    first = muster.compare(small(), "greedy", results=file, **options)
    text = file.read_text()
    file.write_text(text.replace("False", "FALSE").replace("\n", "\r\n"), encoding="utf-8-sig", newline="")
    again = muster.compare(small(), "greedy", results=file, on_run=lambda *run: made.append(run), **options)
    assert (made, again.runs) == ([], first.runs)
    file.write_text(text.replace(",cut_short", "").replace(",False", ""))
    with pytest.raises(InputError, match=r"r.csv:1: no column cut_short; expected results of this version of Muster"):
        muster.compare(small(), "greedy", results=file, **options)


def test_a_file_of_results_is_written_by_one_comparison_at_once(tmp_path):
    file = tmp_path / "r.csv"
    said = []

    def beside(run, made, total):
        with pytest.raises(InputError) as error:
            muster.compare(small(), "greedy", seeds=3, iterations=20, jobs=1, results=file)
        said.append(str(error.value))

    with ResultsFile(file):
        pass  # the columns
    muster.compare(small(1), "greedy", seeds=1, iterations=20, jobs=1, results=file, on_run=beside)
    assert said == [f"{file}: written by another comparison; expected a file of its own for each, or to wait"]
    early = ResultsFile(file)
    muster.compare(small(), "greedy", seeds=1, iterations=20, jobs=1, results=file)
    with pytest.raises(InputError, match="added meanwhile; expected begun again"), early:
        pass


@pytest.mark.long
def test_an_interruption_keeps_what_there_is(tmp_path):
    def interrupt(run, made, total):
        if made == 3:
            raise KeyboardInterrupt

    pending = begun(
        small(),
        ["greedy", "auction"],
        seeds=2,
        jobs=2,
        settings=Settings(iterations=10),
        against=None,
        results=tmp_path / "r.csv",
    )
    with pytest.raises(KeyboardInterrupt):
        pending.run(interrupt)
    part = pending.comparison()
    assert (len(part.runs), part.expected, part.is_whole) == (3, 8, False)
    assert part.counts == "2 allocators, 1 mission, 2 seeds, 3 of 8 runs" or part.counts.endswith("3 of 8 runs")
    assert len((tmp_path / "r.csv").read_text().splitlines()) == 4
    assert len(part.standings) == 2
    pending.run()
    assert pending.comparison().is_whole


SCRIPT = """
import muster

class Least:
    order = 1

def mine(problem, *, step: int = 1):
    return [list(range(len(problem.tasks)))[::Least.order * step]] + [[] for _ in problem.robots[1:]]

found = muster.compare(muster.generate("uniform", 2, tasks=5, robots=2), ["greedy", mine], seeds=1, jobs=2)
print([run.status for run in found.runs], [run.tasks_completed for run in found.runs])
"""


@pytest.mark.long
@pytest.mark.parametrize("through", ["file", "standard input"])
def test_functions_of_a_script_go_to_processes(through, tmp_path):
    """Without `if __name__ == "__main__"`, and as in a notebook, where there is no file."""
    (tmp_path / "mine.py").write_text(SCRIPT)
    run = subprocess.run(
        [sys.executable, "mine.py" if through == "file" else "-"],
        input=None if through == "file" else SCRIPT,
        capture_output=True,
        text=True,
        cwd=tmp_path,
        check=False,
    )
    assert (run.stdout, run.stderr) == ("['done', 'done', 'done', 'done'] [5, 5, 5, 5]\n", "")


def test_without_cloudpickle_it_is_told(monkeypatch):
    monkeypatch.setitem(sys.modules, "cloudpickle", None)
    with pytest.raises(muster.MissingExtraError, match=r"several processes .*muster-robotics\[compare\].*jobs=1"):
        muster.compare(small(), lambda problem: in_order(problem), seeds=1, jobs=2)
    assert muster.compare(small(), lambda problem: in_order(problem), seeds=1, jobs=1).runs[0].is_done


@pytest.mark.long
def test_an_allocator_of_a_file_here(tmp_path, monkeypatch):
    name = "own_allocators_of_this_test"
    (tmp_path / f"{name}.py").write_text(
        textwrap.dedent("""
        def first(problem, *, most: int = 100):
            return [list(range(min(most, len(problem.tasks)))), *([] for _ in problem.robots[1:])]
        """)
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    found = muster.compare(small(1), [f"{name}:first", f"{name}:first:most=2"], seeds=1, jobs=2)
    assert [run.tasks_completed for run in found.runs] == [6, 2]
    assert [run.parameters for run in found.runs] == ["", "most=2"]
    with pytest.raises(muster.ParameterError, match=f"allocator {name}:second: AttributeError: .*expected MODULE:NAME"):
        muster.compare(small(1), f"{name}:second", seeds=1)
    with pytest.raises(muster.ParameterError, match="allocator no_such_module:x: ModuleNotFoundError"):
        muster.compare(small(1), "no_such_module:x", seeds=1)


def test_missions_by_names_patterns_folders_and_families(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for mission in small(3):
        mission.save(tmp_path / f"{mission.name}.yaml")
    given = ("6T-2R,11T-2R", "uniform-*-[01].yaml", tmp_path / "uniform-6T-2R-2.yaml", "mixed:tasks=3:count=2")
    found = muster.compare(given, "greedy", seeds=1, iterations=1, jobs=1)
    assert found.missions == (
        *("6T-2R", "11T-2R", "uniform-6T-2R-0", "uniform-6T-2R-1", "uniform-6T-2R-2", "mixed-3T-3R-0", "mixed-3T-3R-1"),
    )
    assert muster.compare(tmp_path, "greedy", seeds=1, jobs=1).missions == tuple(f"uniform-6T-2R-{k}" for k in range(3))


@pytest.mark.parametrize(
    ("missions", "allocators", "options", "said"),
    [
        ([], "greedy", {}, "missions: none"),
        ("unifrm", "greedy", {}, "missions: unifrm; expected .*did you mean 'uniform'"),
        ("uniform:taks=3", "greedy", {}, "uniform: taks: unknown; did you mean 'tasks'"),
        ("uniform:tasks", "greedy", {}, "missions: uniform:tasks; expected a file.*did you mean 'uniform'"),
        ("none-*.yaml", "greedy", {}, r"missions: none-\*.yaml; expected a pattern that a file has"),
        ("none.yaml", "greedy", {}, "none.yaml: No such file"),
        ([3], "greedy", {}, "missions: 3; expected a Mission"),
        ("6T-2R", [], {}, "allocators: none"),
        ("6T-2R", "gredy", {}, "allocator: gredy; expected .*did you mean 'greedy'"),
        ("6T-2R", ["greedy", "greedy"], {}, "allocators: greedy twice"),
        ("6T-2R", "genetic:size=3", {}, "^genetic has no parameter size"),
        ("6T-2R", "genetic:elite=x", {}, "^genetic has no parameter elite"),
        ("6T-2R", "search:threads=x", {}, 'allocator search:threads=x: threads: "x"; expected a number'),
        ("6T-2R", [3], {}, "allocators: 3; expected a name"),
        ("6T-2R", OfAClass, {}, r"allocator OfAClass: it is a class; expected an instance: OfAClass\(\)"),
        ("6T-2R", "greedy", {"seeds": [[1]]}, "seeds: .*; expected a number above 0"),
        ("6T-2R", "greedy", {"seeds": np.array([1.5])}, "seeds: 1.5; expected a number above 0"),
        ("6T-2R", "greedy", {"jobs": True}, "jobs: true; expected a whole number"),
        ("6T-2R", "greedy", {"seeds": 0}, "seeds: 0; expected a number above 0"),
        ("6T-2R", "greedy", {"seeds": [-1]}, "seeds: -1; expected a number above 0"),
        ("6T-2R", "greedy", {"jobs": 0}, "jobs: 0; expected a whole number of at least 1"),
        ("6T-2R", "greedy", {"time_limit": 0}, "time_limit: 0; expected seconds, above 0"),
        ("6T-2R", "greedy", {"time_limit": math.nan}, "time_limit: nan; expected seconds"),
        ("6T-2R", "greedy", {"clock": "sun"}, 'clock: "sun"; expected wall or processor'),
        ("6T-2R", "greedy", {"objective": "totl"}, "objective: .*did you mean 'total'"),
        ("6T-2R", "greedy", {"against": "search"}, 'against: "search"; expected one of the allocators: greedy'),
        ("6T-2R", "greedy", {"results": "r.txt"}, "results: r.txt; expected a file that ends in .csv"),
        ("6T-2R", "greedy", {"results": "none/r.csv"}, "results: none/r.csv; expected a file in a folder that exists"),
    ],
)
def test_what_is_wrong_is_told(missions, allocators, options, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(muster.MusterError, match=said):
        muster.compare(missions, allocators, **{"seeds": 1, "jobs": 1, **options})
    assert list(Path.cwd().iterdir()) == []


def test_a_name_of_a_shipped_mission_and_a_family_is_told(caplog):
    told = ["missions: warehouse: the shipped mission; the family is warehouse:seed=0"]
    assert list(missions_of(["6T-2R", "warehouse"])) == ["6T-2R", "warehouse"]
    assert caplog.messages == told
    (family,) = missions_of("warehouse:seed=0")
    assert (family != "warehouse", caplog.messages) == (True, told)


def test_numbers_of_numpy_and_columns_without_numbers(tmp_path):
    options = {"jobs": np.int64(1), "time_limit": 1}
    found = muster.compare("6T-2R", ["greedy", OfAClass()], seeds=np.array([3, 1, 3]), **options)
    assert [(run.allocator, run.seed) for run in found.runs] == [
        *(("greedy", 3), ("OfAClass", 3), ("greedy", 1), ("OfAClass", 1)),
    ]
    assert len(muster.compare("6T-2R", "greedy", seeds=np.int64(2), **options).runs) == 2
    assert found.to_frame().iteration_limit.dtype == found.pairs_table().p_value.dtype == float
    with pytest.raises(muster.ParameterError, match=r"report: .*r.pdf; expected a file that ends in .html"):
        found.save_report(tmp_path / "r.pdf")


def test_processor_time_and_another_objective():
    found = muster.compare(
        "6T-2R", "hill-climbing", seeds=1, time_limit=0.05, clock="processor", objective="max", jobs=1
    )
    (run,) = found.runs
    assert (run.clock, run.objective, run.time_limit_s) == ("processor", "max", 0.05)
    assert run.value == pytest.approx(run.max_usage)


def test_the_search_of_a_comparison_has_one_thread():
    from muster_studies.comparison.contestants import contestants_of

    for text, threads in (("search", 1), ("search:threads=2", 2)):
        (one,) = contestants_of(text)
        assert one.parameters(one.allocator()).threads == threads
