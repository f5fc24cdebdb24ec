"""What the tests of maps share: missions around a map, and brute force."""

from importlib.util import find_spec

import numpy as np
import pytest

from muster.mission.reading.yaml_reader import parse_yaml

if not all(find_spec(name) for name in ("PIL", "scipy", "shapely")):
    collect_ignore_glob = ["test_*.py"]


@pytest.fixture
def mission_with(tmp_path):
    """A mission file in a folder of its own whose map is written as given, on line 4."""

    def make(chart, robots="[{id: r_0, position: [1, 1]}]", tasks="[]"):
        text = f"schema: muster/1\nname: m\n# the map\nmap: {chart}\nrobots: {robots}\ntasks: {tasks}\n"
        return parse_yaml(text, tmp_path / "m.yaml")

    return make


@pytest.fixture
def gap_to_squares():
    """Metres from points (n, 2) in cells to the nearest blocked square, by looking at all; outside is blocked."""

    def gaps(grid, cells):
        rows, columns = grid.shape
        blocked = np.argwhere(np.pad(grid.blocked, 1, constant_values=True))[:, ::-1] - 0.5
        away = np.abs(np.asarray(cells)[:, None, :] - blocked[None]) - 0.5
        least = np.hypot(*np.maximum(away, 0).transpose(2, 0, 1)).min(axis=1)
        column, row = np.asarray(cells).T
        beyond = (column < 0) | (row < 0) | (column > columns) | (row > rows)
        return np.where(beyond, 0, least) * grid.resolution_m

    return gaps
