"""`muster replay`."""

import json
from pathlib import Path

import pytest
from tests.cli.yard import table_rows
from tests.report.voyages import carry_out

from muster import load, solve
from muster.report.record import RecordWriter

pytest.importorskip("mcap")


@pytest.fixture
def recorded(folder):
    """Records the yard of this folder; gives the record's file."""

    def record(**how):
        mission = load("yard.yaml")
        with RecordWriter("r.mcap", mission) as writer:
            return Path("r.mcap"), carry_out(mission, solve(mission, "greedy"), writer, **how)

    return record


def test_what_is_printed(recorded, muster):
    file, verdict = recorded()
    code, out, err = muster("replay", file)
    assert (code, err) == (0, "")
    rows = table_rows(out)
    assert out.startswith(f"yard: {verdict.makespan_s:.1f} s, 1 plan, 12 events, complete\n")
    travelled, compared = [row for row in rows if row[0] == "r_0"]
    assert float(travelled[2]) == pytest.approx(verdict.routes[0].travel, abs=0.2)
    assert compared[1:3] == [f"{verdict.routes[0].usage:.2f}"] * 2
    assert ["0.00", "r_0", "sets", "out", "for", "task", "look"] in rows
    assert ["tasks", "done", "3", "of", str(len(load("yard.yaml").tasks))] in rows


def test_json(recorded, muster):
    file, verdict = recorded()
    code, out, err = muster("replay", file, "--format", "json")
    data = json.loads(out)
    assert (code, err) == (0, "")
    assert {key: data[key] for key in ("mission", "complete", "bids")} == {
        "mission": "yard",
        "complete": True,
        "bids": 0,
    }
    assert data["duration_s"] == verdict.makespan_s
    assert data["plans"] == [{"time_s": 0.0, "allocator": "greedy", "tasks": 3}]
    assert [event["kind"] for event in data["events"]].count("ends") == 3
    assert data["report"]["tasks_done"] == ["open", "look", "enter"]


def test_pictures_and_pages(recorded, muster):
    pytest.importorskip("matplotlib")
    file, _ = recorded()
    assert muster("replay", file, "--html", "r.html", "--plot", "r.svg", "-q")[0] == 0
    assert Path("r.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    assert "track-r_0" in Path("r.svg").read_text(encoding="utf-8")


def test_many_events_are_not_all_printed(recorded, muster):
    file, _ = recorded(more=[(1.0, "tick", {"number": k}) for k in range(60)])
    assert "... and 32 events more; -v lists all" in muster("replay", file)[1]
    out = muster("replay", file, "-v")[1]
    assert "more" not in out
    assert out.count("tick") == 60


def test_a_mission_that_did_not_come_to_its_end(recorded, muster):
    file, _ = recorded(until=3.0)
    code, out, err = muster("replay", file)
    assert (code, err) == (0, "")
    assert "no report: the mission did not come to its end" in out


def test_a_record_that_breaks_off(recorded, muster):
    file, verdict = recorded()
    data = file.read_bytes()
    file.write_bytes(data[: len(data) - 100])
    code, out, err = muster("replay", file)
    assert code == 0
    assert err == f"warning: r.mcap: breaks off at {verdict.makespan_s:.1f} s; what is whole is shown\n"
    assert "breaks off" in out.splitlines()[0]
    assert muster("replay", file, "-q")[2] == ""


@pytest.mark.parametrize("name", ["no.mcap", "yard.yaml", "."])
def test_what_is_no_record(name, folder, muster):
    code, out, err = muster("replay", name)
    assert (code, out) == (2, "")
    assert err.startswith(f"{name}: ")
    assert len(err.splitlines()) == 1


def test_outputs_are_refused_before_the_work(recorded, muster):
    file, _ = recorded()
    assert muster("replay", file, "--html", file)[0] == 2
    assert muster("replay", file, "--html", "no/r.html")[0] == 2
    assert muster("replay", file, "--plot", "r.jpg")[0] == 2
