"""Where robots went: what is drawn."""

import numpy as np
import pytest
from tests.report.voyages import carry_out, shipped

import muster
from muster.report.maps.recorded_tracks import plot_flown
from muster.report.record import RecordWriter, read_record

pytest.importorskip("matplotlib")
pytest.importorskip("mcap")
pytest.importorskip("shapely")


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("name", ["31T-6R", "floor", "yard"])
def test_tracks_tasks_and_map(name, tmp_path, drawn):
    mission = shipped(name)
    with RecordWriter(tmp_path / "r.mcap", mission) as writer:
        carry_out(mission, muster.solve(mission, "greedy"), writer, dt=0.5, until=10.0)
    recording = read_record(tmp_path / "r.mcap")
    ax = plot_flown(recording)
    for k, robot in enumerate(mission.robots):
        (line,) = drawn(ax, f"track-{robot.id}")
        data = np.array(line.get_data_3d() if mission.dimensions == 3 else line.get_data()).T
        np.testing.assert_array_equal(data, recording.tracks.positions[:, k, : mission.dimensions])
    assert all(drawn(ax, f"task-{task.id}") for task in mission.tasks)
    assert bool(drawn(ax, "image")) == (name == "floor")
    assert bool(drawn(ax, "boundary")) == (name == "yard")
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels[: len(mission.robots)] == [robot.id for robot in mission.robots]
    assert {"task done", "task open"} <= set(labels)


def test_tasks_that_appeared_or_moved_are_in_the_picture(mission, plan, tmp_path, drawn):
    appears = (1.0, "new_task", {"task": {"id": "late", "position": [-90, 3]}})
    moves = (2.0, "move_task", {"task": "e", "position": [3, 120]})
    with RecordWriter(tmp_path / "r.mcap", mission) as writer:
        carry_out(mission, plan, writer, dt=0.5, until=10.0, more=[appears, moves])
    ax = plot_flown(read_record(tmp_path / "r.mcap"))
    for name, place in (("late", [-90, 3]), ("e", [3, 120])):
        (mark,) = drawn(ax, f"task-{name}")
        np.testing.assert_array_equal(mark.get_xydata(), [place])
        assert ax.viewLim.contains(*place)
