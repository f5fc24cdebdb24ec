"""MethodRun of robots: what is drawn."""

from dataclasses import replace

import numpy as np
import pytest

from muster_studies.rvo.pictures import MethodRun, plot_trajectories, plot_velocities

pytest.importorskip("matplotlib")


def ways(method):
    positions = np.array([[[0.0, 0.0], [4.0, 0.0]], [[1.0, 0.5], [3.0, -0.5]], [[2.0, 0.0], [2.5, 0.0]]])
    return MethodRun(
        method=method,
        robots=("r_0", "r_1"),
        goals=np.array([[2.0, 0.0], [2.5, 0.0]]),
        positions=positions,
        velocities=np.diff(positions, axis=0) / 0.5,
        least_distances_m=np.array([2.2, 0.5]),
        dt=0.5,
        touch_m=0.3,
        inflated_m=0.4,
    )


def test_panels():
    figure = plot_trajectories([ways("RVO"), ways("ORCA")], "a title")
    assert len(figure.axes) == 4
    paths, distances = figure.axes[0], figure.axes[2]
    velocities = plot_velocities([ways("RVO"), ways("ORCA")], "a title")
    assert len(velocities.axes) == 4
    x, y = velocities.axes[0], velocities.axes[2]
    assert [ax.get_title() for ax in figure.axes[:2]] == ["RVO", "ORCA"]
    assert paths.lines[0].get_xydata().tolist() == [[0, 0], [1, 0.5], [2, 0]]
    assert distances.lines[0].get_xydata().tolist() == [[0.5, 2.2], [1.0, 0.5]]
    assert {line.get_ydata()[0] for line in distances.lines[1:]} == {0.3, 0.4}
    assert x.lines[1].get_ydata().tolist() == [-2.0, -1.0]
    assert y.lines[0].get_ydata().tolist() == [1.0, -1.0]


def test_methods_are_drawn_to_one_scale():
    """Of two methods the second comes nearer and takes longer; its panels hold it, and the first's are like them."""
    slow = ways("ORCA")
    slow = replace(slow, least_distances_m=np.array([9.0, 0.1]), velocities=slow.velocities * 3, dt=2.0)
    figure = plot_trajectories([ways("RVO"), slow], "a title")
    velocities = plot_velocities([ways("RVO"), slow], "a title")
    for first, second in (figure.axes[2:], velocities.axes[:2], velocities.axes[2:]):
        assert first.get_xlim() == second.get_xlim()
        assert first.get_ylim() == second.get_ylim()
        for ax in (first, second):
            for line in ax.lines:
                assert ax.get_ylim()[0] <= min(line.get_ydata()) <= max(line.get_ydata()) <= ax.get_ylim()[1]
    assert figure.axes[2].get_ylim()[0] == 0
