"""`muster study`: what it prints, and how it ends."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from muster.cli.main import run
from muster_studies.registry import STUDIES

WAITING = """
import sys
from muster.cli.main import run
import muster_studies.study_verb, muster_studies.registry
print("ready", flush=True)
sys.exit(run(["study", "thesis-3.3", "--tables", "3.2", "--iterations", "1000000000", "--workers", "2"]))
"""


@pytest.mark.parametrize("arguments", [["study"], ["study", "--list"]])
def test_lists_studies(capsys, arguments):
    assert run(arguments) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in STUDIES)


def test_lists_studies_as_json(capsys):
    assert run(["study", "--format", "json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    studies = {study["name"]: study["tables"] for study in listed}
    counts = {"thesis-3.3": 24, "auction-5": 22, "market-rescue": 3}
    assert {name: len(studies[name]) for name in counts} == counts
    (rvo,) = [study["figures"] for study in listed if study["name"] == "rvo"]
    assert [figure["number"] for figure in rvo] == [f"A.{k}" for k in (4, 5, 6, 7, 8, 9, 15, 16, 17)]
    assert {figure["source"] for figure in rvo} == {"tcf-thesis"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["thesis-3"], "did you mean 'thesis-3.3'?"),
        (["thesis-3.3", "--tables", "3.5,3.1"], "table: 3.1; expected 3.2 to 3.22"),
        (["auction-5", "--tables", "5.21"], "table: 5.21; expected 5.2 to 5.20, scenario-1, "),
        (["market-rescue", "--tables", "figure 5"], "did you mean 'Figure 5'?"),
        (["thesis-3.3", "-o", "nowhere/at/all.txt"], "nowhere/at/all.txt: cannot be written"),
        (["thesis-3.3", "--seeds", "0"], "--seeds"),
    ],
)
def test_refuses(capsys, arguments, message):
    assert run(["study", *arguments]) == 2
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.out == ""


@pytest.mark.long
def test_quick_study_prints_all_tables(capsys, tmp_path):
    file = tmp_path / "study.json"
    assert run(["study", "thesis-3.3", "--quick", "--iterations", "50", "--workers", "2", "-o", str(file)]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    report = json.loads(file.read_text(encoding="utf-8"))
    assert report["seeds"] == 2
    assert [table["number"] for table in report["tables"]] == list(STUDIES["thesis-3.3"].tables)
    for table in report["tables"]:
        assert f"{table['number']}. {table['title'].split(';')[0]}" in captured.out
        assert all(list(row) == table["columns"] for row in table["rows"])
    (row,) = [
        r for r in report["tables"][5]["rows"] if (r["scenario"], r["tasks"], r["iterations"]) == ("16T-3R", 16, None)
    ]
    assert row["F"] == pytest.approx(364.71, abs=0.011)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("name", ["auction-5", "market-rescue"])
def test_other_quick_studies_print_all_tables(capsys, tmp_path, name):
    file = tmp_path / "study.json"
    assert run(["study", name, "--quick", "--workers", "1", "-o", str(file)]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    report = json.loads(file.read_text(encoding="utf-8"))
    assert [table["number"] for table in report["tables"]] == list(STUDIES[name].tables)
    for table in report["tables"]:
        word = "" if table["number"][0].isalpha() else "Table "
        assert f"\n{word}{table['number']}. {table['title']}"[:30] in captured.out
        assert all(list(row) == table["columns"] for row in table["rows"])


@pytest.mark.parametrize(("name", "seeds"), [("auction-5", None), ("market-rescue", 2)])
def test_seeds_are_told_where_something_is_random(capsys, name, seeds):
    tables = STUDIES[name].tables[0]
    arguments = ["study", name, "--tables", tables, "--seeds", "2", "--iterations", "1", "--workers", "1"]
    assert run(arguments) == 0
    assert ("seeds 0 to 1" in capsys.readouterr().out) == (seeds is not None)
    assert run([*arguments, "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out)["seeds"] == seeds


def test_json_on_standard_output(capsys, tmp_path):
    file = tmp_path / "tables"
    arguments = ["--format", "json", "--tables", "3.5, 3.16", "--workers", "1", "-q", "-o", str(file)]
    assert run(["study", "thesis-3.3", *arguments]) == 0
    out = capsys.readouterr().out
    assert [table["number"] for table in json.loads(out)["tables"]] == ["3.5", "3.16"]
    assert file.read_text(encoding="utf-8") == out


def test_text_goes_to_a_file_too(capsys, tmp_path):
    file = tmp_path / "study.txt"
    assert run(["study", "thesis-3.3", "--tables", "3.8", "--workers", "1", "-v", "-o", str(file)]) == 0
    captured = capsys.readouterr()
    assert file.read_text(encoding="utf-8") == captured.out
    assert "6, 20, 27, 1" in captured.out
    assert "3 runs" in captured.err


@pytest.mark.long
def test_a_terminal_without_check_marks():
    code = "from muster.cli.main import run; raise SystemExit(run(['study', 'thesis-3.3', '--tables', '3.5']))"
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, env=environment, check=True)
    assert b"?" not in done.stdout
    assert b"= " in done.stdout


def until_it_has_children(pid):
    """Wait until the process has started its workers."""
    until = time.monotonic() + 120
    while not any(file.read_text() for file in Path(f"/proc/{pid}/task").glob("*/children")):
        assert time.monotonic() < until, "no worker has started"
        time.sleep(0.05)


@pytest.mark.long
def test_ctrl_c_ends_it():
    study = subprocess.Popen(
        [sys.executable, "-c", WAITING],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert study.stdout is not None
    assert study.stdout.readline() == "ready\n"
    until_it_has_children(study.pid)
    os.killpg(study.pid, signal.SIGINT)  # as a terminal does: to all processes
    out, err = study.communicate(timeout=300)  # however busy the machine is: its processes start first
    assert (study.returncode, out, err.strip()) == (130, "", "interrupted")
