"""Where robots went: what is drawn."""

from dataclasses import replace

import numpy as np
import pytest
from tests.report.voyages import carry_out, shipped

import muster
from muster.report.maps.recorded_tracks import plot_flown
from muster.report.record import RecordWriter, read_record

pytest.importorskip("matplotlib")
proj3d = pytest.importorskip("mpl_toolkits.mplot3d.proj3d")
pytest.importorskip("mcap")
pytest.importorskip("shapely")


@pytest.mark.long
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


@pytest.mark.parametrize("dimensions", [2, 3])
def test_the_map_that_robots_built_lies_on_the_ground(dimensions, mission, plan, tmp_path, drawn):
    if dimensions == 3:
        mission = replace(
            mission,
            robots=tuple(replace(one, position=(*one.position, 0.0)) for one in mission.robots),
            tasks=tuple(replace(one, position=(*one.position, 0.0)) for one in mission.tasks),
        )
    grid = {"cell_m": 2.0, "origin": [1.0, 2.0, 0.0], "size": [2, 3], "explored_m2": 8.0}
    grows = (1.0, "map_grows", {**grid, "runs": [[0, 0, 2, 1], [1, 2, 1, 2]]})
    with RecordWriter(tmp_path / "r.mcap", mission) as writer:
        carry_out(mission, plan, writer, dt=0.5, until=10.0, more=[grows])
    ax = plot_flown(read_record(tmp_path / "r.mcap"))
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert {"not seen", "obstacle that was seen"} <= set(labels)
    ax.figure.set_dpi(100)
    ax.set_axis_off()
    if dimensions == 3:
        ax.view_init(90, -90)
    ax.figure.canvas.draw()
    pixels = np.asarray(ax.figure.canvas.buffer_rgba())[::-1, :, :3]

    def brightness(x, y):
        """How bright the picture is at a place on the ground, metres."""
        spot = proj3d.proj_transform(x, y, 0.0, ax.get_proj())[:2] if dimensions == 3 else (x, y)
        column, row = ax.transData.transform(spot).astype(int)
        return pixels[row, column].mean()

    obstacle, unseen, free, outside = (brightness(*place) for place in ((6, 5), (6, 3), (1.5, 2.5), (9, 5)))
    assert obstacle < 60 < unseen < free == outside
