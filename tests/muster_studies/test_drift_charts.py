"""Pictures of drift: what is drawn is what the study found."""

import numpy as np
import pytest

from muster.perception.drift import SETPOINTS, Bias, air_drift, published_flight
from muster.perception.errors import AirErrors
from muster_studies.thesis_6_1.drift_pictures import (
    plot_drift_from_above,
    plot_drift_of_coordinate,
    plot_drift_over_way,
)

pytest.importorskip("matplotlib")
NAMES = ("odometry", "inertial", "fixes")


@pytest.fixture(scope="module")
def drift():
    return air_drift(published_flight(passes=1), 0.1, AirErrors(), Bias(scale=0.02), fix_every_s=1.0)


def test_errors_are_distances_of_the_places(drift):
    for name, places in zip(NAMES, drift.places, strict=True):
        assert np.allclose(np.linalg.norm(places - drift.truth, axis=1), getattr(drift, name))


def test_from_above(drift):
    (ax,) = plot_drift_from_above(drift, NAMES, SETPOINTS, "title").axes
    lines = {line.get_label(): line.get_xydata() for line in ax.lines}
    assert list(lines) == [*NAMES, "true", "setpoint"]
    assert np.array_equal(lines["true"], drift.truth[:, :2])
    assert np.array_equal(lines["fixes"], drift.places[2][:, :2])


def test_a_coordinate_and_its_error(drift):
    above, below = plot_drift_of_coordinate(drift, NAMES, 2, "title").axes
    assert np.array_equal(above.lines[0].get_ydata(), drift.places[0][:, 2])
    assert np.array_equal(below.lines[0].get_ydata(), drift.places[0][:, 2] - drift.truth[:, 2])
    assert above.get_ylabel() == "z [m]"


def test_over_the_way(drift):
    (ax,) = plot_drift_over_way([drift, drift], {"alone": "odometry"}, [1.0, 2.0], "title").axes
    ends, flights, mean = ax.lines[:2], ax.lines[2:4], ax.lines[4]
    assert [line.get_xdata()[0] for line in ends] == [1.0, 2.0]
    assert all(np.array_equal(line.get_ydata(), drift.odometry) for line in flights)
    assert np.allclose(mean.get_ydata(), drift.odometry)
