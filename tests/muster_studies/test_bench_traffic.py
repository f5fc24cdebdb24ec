"""The instances of `muster bench --only traffic`, in short."""

import numpy as np
import pytest
from tests.muster_studies.movingai_maps import map_text
from tests.traffic import annotated

from muster_studies.benches.joint_paths import (
    FOLDER,
    RANDOM,
    SCENARIO,
    WAREHOUSE,
    lattice,
    prefixes_bench,
    random_ends,
    roadmap_bench,
    shelves,
    solve,
    warehouse,
    warehouse_bench,
)


def test_the_warehouse_is_that_of_the_benchmark():
    """Its free cells, 5,699, as the benchmark states them."""
    assert warehouse().shape == (63, 161)
    assert (~warehouse()).sum() == 5699


def test_solved_and_judged():
    solved = solve(warehouse(), random_ends(warehouse(), 40, 3), 3)
    assert solved.least <= solved.cost < 2 * solved.least


def test_files_of_a_folder_are_read(tmp_path, monkeypatch):
    blocked = np.zeros((4, 4), dtype=bool)
    for name in (WAREHOUSE, RANDOM):
        (tmp_path / name).write_text(map_text(blocked))
    (tmp_path / SCENARIO).write_text("version 1\n0\ta.map\t4\t4\t0\t0\t3\t3\t4\n")
    monkeypatch.setenv(FOLDER, str(tmp_path))
    monkeypatch.setattr("muster_studies.benches.joint_paths.PREFIXES", (1,))
    monkeypatch.setattr("muster_studies.benches.joint_paths.TIME_LIMIT_S", 0.05)
    notes = [row.note for row in prefixes_bench(1)]
    assert notes == ["1 of 1 solved; sum of costs 6, at least 6"] * 2


@pytest.mark.long
def test_500_robots_of_one_seed():
    (row,) = warehouse_bench(1)
    assert row.note.startswith("1 of 1 solved")


@pytest.mark.long
def test_200_robots_on_a_roadmap():
    (row,) = roadmap_bench(1)
    assert row.note.startswith("1 of 1 to all goals")


def test_the_roadmap_has_the_conflicts_of_the_slow_way():
    free = ~shelves(20)
    quick, (slow, _) = lattice(free, 1.0, 0.62), annotated.lattice(free, 1.0, 0.62)
    assert np.array_equal(quick.points, slow.points)
    near = [
        {
            tuple(edge): {*roadmap.reach_point[roadmap.reach_start[k] : roadmap.reach_start[k + 1]].tolist()}
            for k, edge in enumerate(roadmap.edges.tolist())
        }
        for roadmap in (quick, slow)
    ]
    assert near[0] == near[1]
