"""`muster compare`: tables, data, files, and what Ctrl-C leaves."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("folder")
QUICK = ("--missions", "uniform:tasks=5:robots=2:count=2", "--seeds", 1, "--iterations", 10, "--jobs", 1)


@pytest.mark.long
def test_tables_are_printed_and_files_written(muster):
    arguments = ("compare", *QUICK, "-a", "greedy,auction", "-o", "runs.csv", "--report", "r.html", "--plot", "r.svg")
    code, out, err = muster(*arguments)
    assert (code, err) == (0, "")
    assert out.startswith("2 allocators, 2 missions, 1 seed, 4 runs; 10 iterations each")
    assert {"greedy", "auction", "In"} <= {line.split()[0] for line in out.splitlines() if line.strip()}
    assert len(Path("runs.csv").read_text(encoding="utf-8").splitlines()) == 5
    page = Path("r.html").read_text(encoding="utf-8")
    assert "http://" not in page.replace("http://www.w3.org", "").replace("http://purl.org", "").replace(
        "http://creativecommons.org", ""
    )
    assert "<script" not in page
    assert page.count("<svg") == 2
    assert "uniform-5T-2R-1" in page
    again = muster(*arguments, "-v")
    assert again[:2] == (0, out)
    assert again[2] == "runs.csv: 4 of 4 runs are there\n"


def test_json_has_all(muster):
    code, out, _ = muster("compare", *QUICK, "-a", "greedy", "-a", "auction", "--against", "greedy", "--format", "json")
    data = json.loads(out)
    assert code == 0
    assert data["whole"] is True
    assert [one["allocator"] for one in data["allocators"]] == ["greedy", "auction"]
    assert [(one["allocator"], one["other"]) for one in data["pairs"]] == [("auction", "greedy")]
    assert len(data["runs"]) == 4
    assert data["settings"]["iterations"] == 10


def test_files_of_a_shell_pattern(muster):
    assert muster("generate", "uniform", "--tasks", 4, "--count", 3, "-o", "m")[0] == 0
    names = sorted(str(file) for file in Path("m").iterdir())
    code, out, _ = muster("compare", "--missions", *names, "-a", "greedy", "--seeds", 1, "--jobs", 1)
    assert code == 0
    assert "1 allocator, 3 missions" in out


def test_runs_without_a_plan_and_those_cut_short_are_told(muster):
    Path("of_this_cli_test.py").write_text(
        "def fails(problem):\n    raise ValueError('no')\n"
        "def cut(problem, stop):\n    stop.cut()\n    return [[] for _ in problem.robots]\n",
        encoding="utf-8",
    )
    said = (
        "of_this_cli_test:fails: 2 of 2 runs without a plan (2 failed); first uniform-5T-2R-0, seed 0: ValueError: no"
    )
    arguments = ("compare", *QUICK, "-a", "of_this_cli_test:fails")
    code, _, err = muster(*arguments)
    assert (code, err.splitlines()) == (3, [said])
    assert muster(*arguments, "-q")[::2] == (3, "")
    code, _, err = muster(*arguments, "-v")
    assert err.splitlines() == [
        *(f"uniform-5T-2R-{k}, of_this_cli_test:fails, seed 0: failed: ValueError: no" for k in range(2)),
        said,
    ]
    arguments = (*arguments, "-a", "greedy,of_this_cli_test:cut", "--report", "r.html", "-o", "runs.csv")
    cut = "cut short by the time limit: of_this_cli_test:cut 2 runs"
    for _ in range(2):  # the second time of the file
        code, _, err = muster(*arguments)
        assert (code, err.splitlines()) == (0, [said, cut])
    assert f'<p class="alarm">{cut}</p>' in Path("r.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("-a", "greedy"), "missions: none; expected one at least"),
        (("6T-2R",), "Missing option '-a'"),
        (("6T-2R", "-a", "gredy"), "did you mean 'greedy'"),
        (("6T-2R", "-a", "greedy", "-o", "r.txt"), "results: r.txt; expected a file that ends in .csv"),
        (("6T-2R", "-a", "greedy", "--report", "r.pdf"), "--report: r.pdf; expected a file that ends in .html"),
        (("6T-2R", "-a", "greedy", "--plot", "r.xyz"), "r.xyz"),
        (("6T-2R", "-a", "greedy", "--report", "no/r.html"), "no/r.html: cannot be written"),
        (("6T-2R", "-a", "greedy", "--seed", -1), "--seed: -1; expected a whole number from 0 to 2**64 - 1"),
    ],
)
def test_what_is_wrong_is_told(arguments, said, muster):
    code, out, err = muster("compare", *arguments)
    assert (code, out) == (2, "")
    assert said in err


@pytest.mark.long
def test_ctrl_c_keeps_what_there_is_and_the_same_command_goes_on(muster):
    """A first allocator is quick; the second tells when it has begun, and never ends."""
    Path("of_this_cli_test_too.py").write_text(
        "import os, time\n"
        "def quick(problem):\n    return [[] for _ in problem.robots]\n"
        "def endless(problem):\n"
        "    if os.path.exists('begun'):\n        return [[] for _ in problem.robots]\n"
        "    open('begun', 'w').close()\n    print('begun', flush=True)\n"
        "    while True:\n        time.sleep(0.01)\n",
        encoding="utf-8",
    )
    arguments = [*map(str, QUICK[:-2]), "--jobs", "2", "-o", "runs.csv"]
    arguments += ["-a", "of_this_cli_test_too:quick,of_this_cli_test_too:endless"]
    command = [sys.executable, "-m", "muster.cli", "compare", *arguments]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stderr.readline() == "begun\n"  # what allocators print goes to standard error
    while len(Path("runs.csv").read_text(encoding="utf-8").splitlines()) < 2:
        os.sched_yield()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate()
    assert process.returncode == 130
    kept = len(Path("runs.csv").read_text(encoding="utf-8").splitlines()) - 1
    assert err.splitlines()[-1] == f"interrupted after {kept} of 4 runs; runs.csv has them, the same command goes on"
    assert f"{kept} of 4 runs" in out
    code, out, _ = muster("compare", *arguments)
    assert code == 0
    assert "2 missions, 1 seed, 4 runs" in out
