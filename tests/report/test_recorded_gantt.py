"""The time chart of what was carried out: the same bars as the plan's, where all goes by the plan."""

from dataclasses import replace

import numpy as np
import pytest
from tests.report.test_gantt import bars
from tests.report.voyages import carry_out

from muster import verify
from muster.report import plot_gantt
from muster.report.record import RecordWriter, read_record
from muster.report.time_charts.activity_spans import spans
from muster.report.time_charts.recorded_gantt import plot_flown_gantt
from muster.state import event_of

pytest.importorskip("matplotlib")
pytest.importorskip("mcap")


@pytest.fixture
def recorded(mission, plan, tmp_path):
    def record(**how):
        with RecordWriter(tmp_path / "r.mcap", mission) as writer:
            carry_out(mission, plan, writer, dt=0.5, **how)
        return read_record(tmp_path / "r.mcap")

    return record


def test_carried_out_by_the_plan_it_looks_like_the_plan(mission, plan, recorded, drawn):
    planned, flown = plot_gantt(mission, verify(mission, plan)), plot_flown_gantt(recorded())
    for gid in ("work-ada", "waiting-ada", "travel-ada", "work-bob"):
        np.testing.assert_allclose(bars(drawn(flown, gid)), bars(drawn(planned, gid)))
    assert drawn(flown, "prerequisite-d-c")
    assert drawn(flown, "travel-idle") == []


def test_it_ends_where_the_record_breaks_off(recorded, drawn):
    ax = plot_flown_gantt(replace(recorded(until=10.0), complete=False))
    (end,) = drawn(ax, "end")
    assert end.get_xdata()[0] == pytest.approx(10.0)
    (alarm,) = drawn(ax, "alarm")
    assert "breaks off" in alarm.get_text()
    assert bars(drawn(ax, "travel-ada"))[-1][0] + bars(drawn(ax, "travel-ada"))[-1][1] == pytest.approx(10.0)


def test_tasks_that_were_added_have_marks(recorded, drawn):
    recording = recorded(until=10.0)
    task = {"id": "new", "position": [0, 0], "window_s": [[4, 8]], "deadline_s": 9, "due_s": 5, "prerequisites": ["a"]}
    added = (
        event_of(2.0, "new_task", {"task": task}),
        event_of(3.0, "sets_out", {"robot": "idle", "task": "new"}),
        event_of(7.5, "starts", {"robot": "idle", "task": "new"}),
        event_of(9.0, "ends", {"robot": "idle", "task": "new"}),
    )
    events = sorted([*recording.events, *added], key=lambda event: event.time_s)
    ax = plot_flown_gantt(replace(recording, events=tuple(events)))
    (window,) = drawn(ax, "window-new")
    (box,) = [path.get_extents() for path in window.get_paths()]
    assert (box.x0, box.x1, (box.y0 + box.y1) / 2) == pytest.approx((4, 8, 2))
    assert [list(line.get_xdata()) for line in (*drawn(ax, "deadline"), *drawn(ax, "due"))] == [[9, 9], [5, 5]]
    assert drawn(ax, "late-new")
    assert drawn(ax, "prerequisite-a-new")


def test_robots_that_joined_have_rows(recorded, drawn):
    recording = recorded(until=10.0)
    joins = (
        event_of(2.0, "robot_joins", {"robot": {"id": "eve", "position": [0, 0]}}),
        event_of(2.0, "sets_out", {"robot": "eve", "task": "e"}),
        event_of(2.2, "robot_fails", {"robot": "eve"}),
    )
    ax = plot_flown_gantt(replace(recording, events=(*joins, *recording.events)))
    assert [label.get_text() for label in ax.get_yticklabels()] == ["ada", "bob", "idle", "eve"]
    assert bars(drawn(ax, "travel-eve"))[0][:2] == pytest.approx((2.0, 0.2))


def test_waiting_in_traffic_interrupts_travel_also_where_it_is_told_after_its_end():
    told = [
        (0.0, "sets_out", {"robot": "a", "task": "x"}),
        (6.0, "waits_in_traffic", {"robot": "a", "waits_for": "b", "position": [0, 0], "since_s": 5.0}),
        (8.0, "sets_out", {"robot": "a", "task": "x"}),  # it stood aside meanwhile
        (11.0, "arrives", {"robot": "a", "task": "x"}),
        (11.5, "goes_on", {"robot": "a", "until_s": 10.0, "waited_s": {"b": 5.0}, "position": [0, 0]}),
        (12.0, "starts", {"robot": "a", "task": "x"}),
        (13.0, "waits_in_traffic", {"robot": "a", "waits_for": "c", "position": [0, 0], "since_s": 12.5}),
        (20.0, "ends", {"robot": "a", "task": "x"}),
    ]
    found = spans([event_of(*event) for event in told], 30.0)
    assert sorted((span.from_s, span.until_s, span.kind) for span in found if span.task == "x") == [
        (0.0, 5.0, "travel"),
        (5.0, 10.0, "traffic"),
        (10.0, 11.0, "travel"),
        (11.0, 12.0, "waiting"),
        (12.0, 20.0, "work"),
        (12.5, 30.0, "traffic"),
    ]


def test_waiting_in_traffic_has_bars_and_an_entry_of_its_own(recorded, drawn):
    recording = recorded()
    waits = {"robot": "ada", "waits_for": "bob", "position": [0, 0], "since_s": 0.5}
    events = (*recording.events, event_of(1.5, "waits_in_traffic", waits))
    goes_on = event_of(2.5, "goes_on", {"robot": "ada", "until_s": 2.0, "waited_s": {"bob": 1.5}})
    ax = plot_flown_gantt(replace(recording, events=tuple(sorted((*events, goes_on), key=lambda e: e.time_s))))
    assert bars(drawn(ax, "traffic-ada"))[0][:2] == pytest.approx((0.5, 1.5))
    assert "in traffic" in [text.get_text() for text in ax.get_legend().get_texts()]
