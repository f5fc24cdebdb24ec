"""Broken mission files, each with the message a user should get.

`broken/NAME.expected` is what `muster check` prints on standard error when run in that folder; the exit code is 2. The
mission is NAME.yaml, or what NAME.args says. The files of task lists, robots and tables are in `broken/parts`.
"""

import json
import subprocess
import sysconfig
from pathlib import Path

import pytest

from muster.cli.main import run

FOLDER = Path(__file__).parent / "broken"
NAMES = sorted(path.stem for path in FOLDER.glob("*.expected"))
KEYS = ["file", "line", "field", "value", "expected"]


def arguments(name):
    args = FOLDER / f"{name}.args"
    return args.read_text(encoding="utf-8").split() if args.exists() else [f"{name}.yaml"]


def expected(name):
    return (FOLDER / f"{name}.expected").read_text(encoding="utf-8")


def line_of(error):
    """A finding of `--format json` as the line that a person gets: what cannot be printed is escaped."""
    place = error["file"] if error["line"] is None else f"{error['file']}:{error['line']}"
    subject = f"{error['field']}: " if error["field"] else ""
    line = f"{place}: {subject}{error['value']}; expected {error['expected']}"
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in line) + "\n"


@pytest.mark.parametrize("name", NAMES)
def test_message(name, capsys, monkeypatch):
    monkeypatch.chdir(FOLDER)
    code = run(["check", *arguments(name)])
    out, err = capsys.readouterr()
    assert err == expected(name)
    assert (code, out) == (2, "")


@pytest.mark.long(keep=80)
@pytest.mark.parametrize("name", NAMES)
def test_json_has_the_same_findings(name, capsys, monkeypatch):
    monkeypatch.chdir(FOLDER)
    code = run(["check", *arguments(name), "--format", "json"])
    out, err = capsys.readouterr()
    data = json.loads(out)
    assert (code, err) == (2, "")
    others = ["conflict", "unknown", "shortfalls", "remedies", "unseen", "blocked", "cut_off"]
    assert list(data) == ["errors", "impossible", *others]
    assert (data["conflict"], data["unknown"]) == (None, False)
    assert data["impossible"] == []
    assert [list(error) for error in data["errors"]] == [KEYS] * len(data["errors"])
    assert "".join(line_of(error) for error in data["errors"]) == expected(name)


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    "name", ["several-errors", "prerequisite-cycle-of-3", "csv-robots-duplicate-id", "yaml-empty-file"]
)
def test_installed_command(name):
    muster = Path(sysconfig.get_path("scripts")) / "muster"
    done = subprocess.run(
        [muster, "check", *arguments(name)], cwd=FOLDER, capture_output=True, encoding="utf-8", check=False
    )
    assert done.stderr == expected(name)
    assert (done.returncode, done.stdout) == (2, "")


@pytest.mark.parametrize("verb", ["solve", "verify", "explain"])
def test_every_verb_says_the_same(verb, capsys, monkeypatch, tmp_path):
    plan = tmp_path / "plan.json"
    plan.write_text('{"schema": "muster-plan/1", "routes": []}', encoding="utf-8")
    monkeypatch.chdir(FOLDER)
    for name in ("several-errors", "yaml-second-document", "csv-negative-cost", "tsplib-wrong-type"):
        code = run([verb, *arguments(name), *([str(plan)] if verb != "solve" else [])])
        out, err = capsys.readouterr()
        assert (code, out, err) == (2, "", expected(name))


def test_of_each_knot_of_prerequisites_one_cycle_is_named(tmp_path, capsys):
    """Not all there are: a ring of tasks that all wait for its first one has as many cycles as tasks."""
    waits = [f"[{(k + 1) % 500}, 0]" if 0 < k < 499 else f"[{(k + 1) % 500}]" for k in range(500)]
    tasks = "".join(f"  - {{id: {k}, position: [0, 0], prerequisites: {names}}}\n" for k, names in enumerate(waits))
    path = tmp_path / "ring.yaml"
    path.write_text(f"schema: muster/1\nrobots: [{{id: r_0, position: [0, 0]}}]\ntasks:\n{tasks}", encoding="utf-8")
    assert run(["check", str(path)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_every_file_has_its_message():
    """No broken file lies about that no test reads."""
    read = {word for name in NAMES for word in arguments(name)}
    read |= {word.strip('{},[]"') for name in read if name.endswith(".yaml") for word in words_of(name)}
    files = {str(path.relative_to(FOLDER)) for path in FOLDER.rglob("*") if path.is_file()}
    assert {file for file in files if not file.endswith((".expected", ".args"))} <= read


def words_of(name):
    return (FOLDER / name).read_bytes().decode("utf-8", errors="replace").split()
