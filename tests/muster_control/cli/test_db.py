"""`muster db`, as a user has it."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from muster_control.contract import User
from muster_control.store import Store
from muster_control.store.schema import HEAD

SUMMARY = {"name": "Yard", "robots": 2, "tasks": 3, "dimensions": 2}


@pytest.fixture
def url(tmp_path, monkeypatch):
    """A database with a run that is over, in the usual place."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    url = f"sqlite:///{tmp_path}/data/muster/muster.db"
    store = Store.open(url)
    store.missions.create("Yard", "a", {}, SUMMARY, "ann")
    plan = store.plans.add("Yard", 1, "planned", "ann", {})
    run = store.runs.add("Yard", 1, plan.id, "kinematic", {}, None, "ann")
    store.actions.add(User("ann", "command"), "run.start", {}, run.id)
    store.runs.set(run.id, state="ended")
    store.close()
    return url


@pytest.mark.long
def test_a_full_disk_behind_standard_output(url):
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "muster.cli", "db", "info", "--db", url]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    said = "No space left on device; expected room for what is written, and printed\n"
    assert (done.returncode, done.stderr) == (2, said)


def test_the_usual_database_is_copied_and_put_back(url, muster, tmp_path):
    file, other = tmp_path / "copy.db", f"sqlite:///{tmp_path}/other.db"
    assert muster("db", "backup", file) == (0, "", f"wrote {file}: {file.stat().st_size} bytes\n")
    said = f"restored {tmp_path}/other.db: 1 missions, 1 plans, 1 runs\n"
    assert muster("db", "restore", file, "--db", other) == (0, "", said)
    code, out, err = muster("db", "info", "--db", other, "--format", "json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert found["rows"]["runs"] == 1
    assert found["database"] == f"{tmp_path}/other.db"
    assert muster("db", "backup", tmp_path / "quiet.db", "-q") == (0, "", "")


def test_the_database_that_the_environment_names(url, muster, monkeypatch, tmp_path):
    monkeypatch.setenv("MUSTER_DB", url)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "elsewhere"))
    code, out, _ = muster("db", "info")
    assert (code, out.startswith(f"{tmp_path}/data/muster/muster.db: ")) == (0, True)


def test_info_as_a_table(url, muster, tmp_path):
    code, out, err = muster("db", "info")
    assert (code, err) == (0, "")
    assert out.startswith(f"{tmp_path}/data/muster/muster.db: tables {HEAD}, ")
    assert [line.split() for line in out.splitlines() if "versions" in line] == [["mission", "versions", "1"]]


def test_prune_says_what_goes(url, muster):
    code, out, err = muster("db", "prune", "--older-than", 0, "--dry-run")
    assert (code, err) == (0, "")
    assert "would go" in out
    wanted = {"runs": 1, "entries": 0, "stretches": 0, "actions": 1, "jobs": 0, "plans": 0,
              "mission_versions": 0, "missions": 0, "files": 0}  # fmt: skip
    for flags, expected in ((["--dry-run"], wanted), ([], wanted), ([], dict.fromkeys(wanted, 0))):
        code, out, _ = muster("db", "prune", "--older-than", 0, "--format", "json", *flags)
        assert (code, json.loads(out)) == (0, expected)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["backup", "copy.db", "--db", "sqlite:///none.db"], "none.db: no such file; expected a database"),
        (["backup", "copy.db", "--db", "none.db"], "--db: no URL of a database; expected sqlite:///FILE or"),
        (["backup", "copy.db", "--db", "postgresql://a:secret@127.0.0.1:1/m"], "PostgreSQL m at 127.0.0.1:1: the"),
        (["restore", "absent.db", "--db", "sqlite:///new.db"], "absent.db: no such file; expected one that"),
        (["prune", "--older-than", "nan"], "Error: Invalid value for '--older-than'"),
        (["prune", "--older-than", "-1"], "Error: Invalid value for '--older-than'"),
        (["prune"], "Error: Missing option '--older-than'"),
        (["backup"], "Error: Missing argument 'FILE'"),
        (["sell"], "Error: No such command 'sell'"),
    ],
)  # fmt: skip
def test_mistakes_are_a_line(arguments, line, muster, folder):
    code, out, err = muster("db", *arguments)
    assert (code, out) == (2, "")
    assert err.splitlines()[-1].startswith(line)
    assert "secret" not in err


@pytest.mark.parametrize("verb", ["info", "backup", "restore", "prune"])
def test_help(verb, muster):
    code, out, err = muster("db", verb, "--help")
    assert (code, err) == (0, "")
    assert out.startswith(f"Usage: muster db {verb} [OPTIONS]")
    assert all(len(line) <= 80 for line in out.splitlines())
