"""Records: what goes in comes out; a record that breaks off is read up to there."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from tests.report.voyages import carry_out, shipped

import muster
from muster.mission.errors import InputError, MissingExtraError, MusterError, ParameterError
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.plan import Plan, Route
from muster.mission.system.clock import VirtualClock
from muster.report.record import RecordWriter, read_record
from muster.report.record.schemas import SCHEMAS, TOPICS

pytest.importorskip("mcap")


@pytest.fixture(scope="module")
def mission():
    return shipped("31T-6R")


@pytest.fixture(scope="module")
def plan(mission):
    return muster.solve(mission, "greedy")


@pytest.fixture(scope="module")
def whole(mission, plan, tmp_path_factory):
    """The file of a mission carried out to its end."""
    file = tmp_path_factory.mktemp("record") / "whole.mcap"
    with RecordWriter(file, mission, chunk_bytes=8 * 1024, clock=VirtualClock()) as writer:
        carry_out(mission, plan, writer, dt=0.25)
    return file


@pytest.fixture
def writer(tmp_path):
    small = Mission(
        robots=[Robot(id="a", position=(0, 0))], tasks=[Task(id="t", position=(1, 1)), Task(id="u", position=(5, 5))]
    )
    with RecordWriter(tmp_path / "small.mcap", small) as writer:
        yield writer


class Told:
    """An observer that keeps what it is told."""

    def __init__(self):
        self.steps, self.events, self.plans, self.reports = [], [], [], []

    def on_step(self, now, positions, headings, velocities):
        self.steps.append((now, positions, headings, velocities))

    def on_event(self, now, kind, data):
        self.events.append((now, kind, data))

    def on_plan(self, now, plan):
        self.plans.append((now, plan))

    def on_report(self, report):
        self.reports.append(report)


def test_what_goes_in_comes_out(mission, plan, whole):
    told, read = Told(), read_record(whole)
    carry_out(mission, plan, told, dt=0.25)
    assert read.complete
    assert read.mission == mission
    assert [(event.time_s, event.kind, event.data) for event in read.events] == told.events
    assert [(version.time_s, version.plan.routes) for version in read.plans] == [(0.0, plan.routes)]
    assert read.report == told.reports[0]
    assert read.duration_s == told.reports[0]["mission_time_s"]
    assert read.tracks.robots == tuple(robot.id for robot in mission.robots)
    np.testing.assert_array_equal(read.tracks.times_s, [now for now, *_ in told.steps])
    for got, k in ((read.tracks.positions, 1), (read.tracks.headings, 2), (read.tracks.velocities, 3)):
        np.testing.assert_allclose(got, [step[k] for step in told.steps], atol=5.001e-5)


@pytest.mark.long
def test_every_message_has_the_form_of_its_schema(whole):
    """Read by the reader of mcap, judged by jsonschema."""
    import jsonschema
    from mcap.reader import make_reader

    seen = {}
    with whole.open("rb") as stream:
        for schema, channel, message in make_reader(stream).iter_messages():
            assert (channel.message_encoding, schema.encoding) == ("json", "jsonschema")
            assert TOPICS[channel.topic] == schema.name
            assert json.loads(schema.data) == SCHEMAS[schema.name]
            data = json.loads(message.data)
            if seen.setdefault(channel.topic, 0) < 10:
                jsonschema.validate(data, SCHEMAS[schema.name])
            seen[channel.topic] += 1
    assert set(seen) == {"/tf", "/poses", "/scene", "/log", "/muster/state", "/muster/event", "/muster/plan"} | {
        "/muster/report"
    }
    assert seen["/tf"] == seen["/poses"] == seen["/muster/state"] == 246
    assert seen["/log"] == seen["/muster/event"] == 124


@pytest.mark.long
def test_a_record_cut_anywhere_is_read_up_to_there(whole, tmp_path):
    data, read = whole.read_bytes(), read_record(whole)
    file, lengths, text = tmp_path / "cut.mcap", [], read.mission_text.encode()
    beginning = data.index(text) + len(text) + 4  # the mission, and its checksum
    generator = random.Random(1)
    for cut in sorted(generator.randrange(len(data)) for _ in range(80)):
        file.write_bytes(data[:cut])
        if cut < beginning:
            with pytest.raises(InputError, match="expected a record that muster has written"):
                read_record(file)
            continue
        part = read_record(file)
        steps = len(part.tracks.times_s)
        lengths.append((steps, len(part.events)))
        assert not part.complete
        assert part.events == read.events[: len(part.events)]
        np.testing.assert_array_equal(part.tracks.positions, read.tracks.positions[:steps])
    assert len(lengths) > 60
    assert lengths == sorted(lengths)
    assert len(set(lengths)) > 20  # it is in every chunk that something is found


@pytest.mark.long
def test_of_a_record_with_wrong_bytes_what_is_read_is_right(whole, tmp_path):
    from mcap.reader import make_reader

    data, read = whole.read_bytes(), read_record(whole)
    with whole.open("rb") as stream:
        chunks = make_reader(stream).get_summary().chunk_indexes
    beginning, end = chunks[1].chunk_start_offset, chunks[-1].chunk_start_offset
    file, generator, kept = tmp_path / "wrong.mcap", random.Random(2), []
    for _ in range(40):
        at = generator.randrange(beginning, end)
        file.write_bytes(data[:at] + bytes(64) + data[at + 64 :])
        part = read_record(file)
        rows = np.searchsorted(read.tracks.times_s, part.tracks.times_s)
        kept.append(len(rows))
        assert not part.complete
        assert all(event in read.events for event in part.events)
        np.testing.assert_array_equal(part.tracks.times_s, read.tracks.times_s[rows])
        np.testing.assert_array_equal(part.tracks.positions, read.tracks.positions[rows])
    assert len(set(kept)) > 10


_ENDLESS = """
import sys, muster, numpy as np
from muster.report.record import RecordWriter
mission = muster.load("31T-6R")
writer, step = RecordWriter(sys.argv[1], mission), 0
while True:
    now = step * 0.1
    writer.on_step(now, np.full((6, 3), now), np.zeros(6), np.zeros((6, 3)))
    if step % 7 == 0:
        writer.on_event(now, "tick", {"number": step // 7})
    if step == 50:
        print("running", flush=True)
    step += 1
"""


@pytest.mark.long
def test_the_record_of_a_killed_process_opens(tmp_path):
    file = tmp_path / "killed.mcap"
    process = subprocess.Popen([sys.executable, "-c", _ENDLESS, str(file)], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"running\n"
    until = time.monotonic() + 120
    while file.stat().st_size < 200_000:  # what it has said is in the file later, as chunks are written whole
        assert time.monotonic() < until, "nothing is written"
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
    read = read_record(file)
    steps = len(read.tracks.times_s)
    assert not read.complete
    assert read.report is None
    assert steps >= 20
    np.testing.assert_allclose(read.tracks.positions[:, 0, 0], np.arange(steps) * 0.1, atol=1e-4)
    assert [event.data["number"] for event in read.events] == list(range(len(read.events)))


def test_what_a_killed_process_loses_is_bounded(tmp_path, mission):
    """Without being closed the file holds all but less than a chunk, and all that is older than `flush_s`."""
    clock, file = VirtualClock(), tmp_path / "open.mcap"
    writer = RecordWriter(file, mission, flush_s=1.0, chunk_bytes=10**9, clock=clock)
    for step in range(30):
        writer.on_step(step * 0.1, np.zeros((6, 3)), np.zeros(6), np.zeros((6, 3)))
        clock.advance(0.1)
    assert len(read_record(file).tracks.times_s) >= 20
    writer.close()
    writer = RecordWriter(file, mission, chunk_bytes=4096, clock=VirtualClock())
    for step in range(30):
        writer.on_step(step * 0.1, np.zeros((6, 3)), np.zeros(6), np.zeros((6, 3)))
    assert len(read_record(file).tracks.times_s) >= 26
    writer.close()


@pytest.mark.parametrize(("dt", "rate_hz", "period_s"), [(0.01, 10, 0.1), (0.02, 4, 0.26), (0.5, 10, 0.5)])
def test_steps_are_thinned(dt, rate_hz, period_s, tmp_path):
    mission = Mission(robots=[Robot(id="a", position=(0, 0))], tasks=[Task(id="t", position=(1, 1))])
    with RecordWriter(tmp_path / "r.mcap", mission, rate_hz=rate_hz) as writer:
        for step in range(1000):
            writer.on_step(step * dt, np.zeros((1, 3)), np.zeros(1), np.zeros((1, 3)))
    times = read_record(tmp_path / "r.mcap").tracks.times_s
    assert np.diff(times).max() <= period_s + 1e-9
    assert len(times) <= 1000 * dt * rate_hz + 1


def test_robots_and_tasks_that_come_later(writer, tmp_path):
    writer.on_step(0.0, np.zeros((1, 3)), np.zeros(1), np.zeros((1, 3)))
    writer.on_event(0.1, "robot_joins", {"robot": {"id": "b", "position": [2, 2], "radius_m": 0.2}})
    writer.on_event(0.1, "new_task", {"task": Task(id="late", position=(3, 3))})
    writer.on_event(0.15, "move_task", {"task": "u", "position": [9, 9]})
    writer.on_plan(0.2, Plan(routes=(Route("a", ("t",)), Route("b", ("late", "u")))))
    writer.on_step(0.2, np.ones((2, 3)), np.ones(2), np.ones((2, 3)))
    writer.on_step(0.3, np.array([[np.nan] * 3, [2.0] * 3]), np.ones(2), np.ones((2, 3)))
    writer.close()
    read = read_record(tmp_path / "small.mcap")
    assert [robot.id for robot in read.robots] == ["a", "b"]
    assert read.robots[1].radius_m == 0.2
    xs = read.tracks.positions[:, :, 0]
    np.testing.assert_array_equal(xs, [[0, np.nan], [1, 1], [np.nan, 2]])
    assert read.events[1].data["task"] == {"id": "late", "position": [3.0, 3.0]}
    scenes = messages(tmp_path / "small.mcap", "/scene")
    (route,) = [e for e in scenes[-1]["entities"] if e["id"] == "route/b"]
    assert [(p["x"], p["y"]) for p in route["lines"][0]["points"]] == [(2, 2), (3, 3), (9, 9)]


def messages(file, topic):
    from mcap.reader import make_reader

    with Path(file).open("rb") as stream:
        return [json.loads(message.data) for *_, message in make_reader(stream).iter_messages(topics=[topic])]


def test_bids_of_an_auction(mission, tmp_path):
    plan = muster.solve(mission, "auction")
    with RecordWriter(tmp_path / "a.mcap", mission) as writer:
        writer.on_plan(3.0, plan)
    read = read_record(tmp_path / "a.mcap")
    assert [bid["task"] for bid in read.bids] == [award.task for award in plan.book.awards]
    assert read.bids[0]["bids"] == dict(plan.book.awards[0].bids)
    assert read.plans[0].plan.book == plan.book


def test_the_map_is_in_the_record(tmp_path):
    from muster.motion.map_world import World

    floor = muster.load("floor")
    with RecordWriter(tmp_path / "f.mcap", floor):
        pass
    image, read = World.of(floor).image, read_record(tmp_path / "f.mcap")
    np.testing.assert_array_equal(read.image.blocked, image.blocked)
    assert read.image.resolution_m == image.resolution_m
    assert read.image.origin == pytest.approx(image.origin)
    assert read.mission.map == floor.map


def test_a_mission_by_travel_tables(tmp_path):
    (tmp_path / "t.csv").write_text("place,a,t\na,0,7\nt,7,0\n", encoding="utf-8")
    (tmp_path / "m.yaml").write_text(
        "schema: muster/1\nrules: {travel: matrix}\ntravel: {k: t.csv}\n"
        "robots: [{id: a, type: k, position: [0, 0]}]\ntasks: [{id: t, position: [3, 4]}]\n",
        encoding="utf-8",
    )
    mission = muster.load(tmp_path / "m.yaml")
    with RecordWriter(tmp_path / "m.mcap", mission) as writer:
        writer.on_plan(0.0, muster.solve(mission, "greedy"))
    (tmp_path / "t.csv").unlink()
    read = read_record(tmp_path / "m.mcap")
    assert read.mission.rules == Rules()
    assert "matrix" in read.mission_text
    assert [robot.id for robot in read.robots] == ["a"]


def test_without_the_extra(monkeypatch, tmp_path, mission, whole):
    monkeypatch.setitem(sys.modules, "mcap", None)
    for call in (lambda: read_record(whole), lambda: RecordWriter(tmp_path / "r.mcap", mission)):
        with pytest.raises(MissingExtraError, match=r"a record needs .* pip install 'muster-robotics\[record\]'"):
            call()
    assert not (tmp_path / "r.mcap").exists()


def test_a_robot_too_many(writer):
    with pytest.raises(ParameterError, match="2 rows; expected one for each of 1 robots"):
        writer.on_step(0.0, np.zeros((2, 3)), np.zeros(2), np.zeros((2, 3)))


def test_a_new_task_that_is_none(writer):
    with pytest.raises(ParameterError, match="event new_task"):
        writer.on_event(0.0, "new_task", {"task": {"id": "x"}})


@pytest.mark.parametrize("content", [None, b"", b"schema: muster/1\n", b"\x89MCAP0\r\n", b"\x89MCAP0\r\n" + bytes(99)])
def test_what_is_no_record(content, tmp_path):
    file = tmp_path / "other.mcap"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(MusterError) as refused:
        read_record(file)
    assert str(refused.value).startswith(f"{file}: ")
    assert len(str(refused.value).splitlines()) == 1
