"""The console example of docs/records.md: a recording that others made as the reference of a mission."""

import re
from pathlib import Path

import pytest

from muster.cli.main import run

pytest.importorskip("mcap")
pytest.importorskip("rosbags")

TEXT = (Path(__file__).parents[2] / "docs" / "records.md").read_text(encoding="utf-8")


def write_others(record, bag):
    """A bag as others write it: poses 3 cm east and 4 cm north of the robots, from 1.7e9 s on."""
    from tests.muster_robots.recordings.conftest import told_of, write

    from muster.report.record import read_record

    recording = read_record(record)
    told = [
        one
        for robot in recording.tracks.robots
        for one in told_of(recording, robot, f"/{robot}/odom", begins_s=1.7e9, off=(0.03, 0.04, 0.0))
    ]
    write("rosbag1", bag, sorted(told, key=lambda one: one[1]))


def test_the_error_to_what_others_recorded(tmp_path, monkeypatch, capsys):
    (example,) = re.findall(r"```console\n(.*?)```", TEXT, flags=re.DOTALL)
    monkeypatch.chdir(tmp_path)
    _, fly, look = example.split("$ muster ")
    assert run(fly.split()) == 0
    write_others("flown.mcap", "real.bag")
    capsys.readouterr()
    command, *output = look.splitlines()
    assert run(command.split()) == 0
    printed = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    assert [line for line in printed if line][-len(output) :] == output
