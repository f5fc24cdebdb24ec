"""Pictures of a reference and of flights, and of measures: what is drawn is what was given."""

import numpy as np
import pytest

from muster.mission.model import Map
from muster_studies.tracking_pictures import Measure, Tracked, plot_measures, plot_tracking

pytest.importorskip("matplotlib")


def tracked(name, aside):
    return Tracked(
        name=name, places=np.array([[0.0, aside], [1.0, aside]]), times=np.array([0.0, 5.0]), aside=np.full(2, aside)
    )


def test_reference_and_flights():
    chart = Map(boundary=((0, -1), (1, -1), (1, 1), (0, 1)))
    flights = [tracked("calm", 0.0), tracked("noisy", 0.01), tracked("noisy", 0.02)]
    reference = np.array([[0.0, 0.0], [1.0, 0.0]])
    above, below = (figure := plot_tracking(chart, reference, flights, {"goal": (1.0, 0.0)}, "title")).axes
    drawn = [line.get_xydata().tolist() for line in above.lines]
    assert all(flight.places.tolist() in drawn for flight in flights)
    assert [line.get_ydata().tolist() for line in below.lines] == [[0, 0], [10, 10], [20, 20]]  # mm
    assert below.lines[1].get_color() == below.lines[2].get_color() != below.lines[0].get_color()
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["reference", "calm", "noisy"]
    assert "goal" in [text.get_text() for text in above.texts]


def test_points_are_marked_by_what_they_are():
    seen = {"scan": np.array([[0.1, 0.2], [0.3, 0.4]]), "landmark": np.array([[0.5, 0.6]]), "none": np.empty((0, 2))}
    figure = plot_tracking(None, np.array([[0.0, 0.0], [1.0, 0.0]]), [tracked("calm", 0.0)], {}, "title", seen)
    drawn = {line.get_label(): line for line in figure.axes[0].lines}
    assert {kind: drawn[kind].get_xydata().tolist() for kind in seen} == {k: v.tolist() for k, v in seen.items()}
    assert len({drawn[kind].get_marker() for kind in seen}) == 3
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["reference", "calm", *seen]


def test_so_many_measures_a_row():
    measure = Measure(label="", means={"a": 1.0}, spreads={"a": 0.1})
    axes = plot_measures([measure] * 6, "title", columns=3).axes
    assert [ax.get_subplotspec().colspan.start for ax in axes] == [0, 1, 2] * 2


@pytest.mark.parametrize("count", [1, 5])
def test_measures(count):
    measure = Measure(label="error, m", means={"a": 1.0, "b": 2.0}, spreads={"a": 0.1, "b": 0.0}, printed=3.0)
    axes = plot_measures([measure] * count, "title").axes
    assert len(axes) == count
    for ax in axes:
        assert [bar.get_height() for bar in ax.patches] == [1.0, 2.0]
        assert ax.get_title(loc="left") == "error, m"
        assert any(np.ptp(line.get_ydata()) == 0 and line.get_ydata()[0] == 3.0 for line in ax.lines)
