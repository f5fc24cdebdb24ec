"""The edge weights of TSPLIB against values worked out by hand."""

import math

import numpy as np
import pytest

import muster
from muster.mission.errors import MissionError
from muster_files.instances.edge_weights import COORDINATES, LAYOUTS, matrix_of, numbers_in, weights_of

NEAR, FAR = (0.0, 0.0, 0.0), (1.0, 2.5, 1.5)  # 2.69... apart in the plane, 3.08... in space


@pytest.mark.parametrize(
    ("kind", "weight"),
    [
        ("EUC_2D", 3),
        ("EUC_3D", 3),
        ("CEIL_2D", 3),
        ("CEIL_3D", 4),
        ("FLOOR_2D", 2),
        ("FLOOR_3D", 3),
        ("MAN_2D", 4),  # 3.5, halves up
        ("MAN_3D", 5),
        ("MAX_2D", 3),  # each difference is rounded: 1 and 3
        ("MAX_3D", 3),
        ("ATT", 1),  # sqrt(7.25 / 10) = 0.85
        ("XRAY1", 250),
        ("XRAY2", 167),  # 100 * 2.5 / 1.5 = 166.7, above 100 * 1.5 / 1.15 and 100 / 1.25
    ],
)
def test_weights_of_differences(kind, weight):
    points = np.array([NEAR, FAR])[:, : COORDINATES[kind]]
    assert weights_of(kind, points).tolist() == [[0, weight], [weight, 0]]


def test_every_type_is_tested_here():
    assert set(COORDINATES) == {*(f"{a}_{b}D" for a in ("EUC", "CEIL", "FLOOR", "MAN", "MAX") for b in (2, 3)), *OTHERS}


OTHERS = ("ATT", "GEO", "XRAY1", "XRAY2")


def test_pseudo_euclidean_weights_are_rounded_up():
    """Nodes 1 and 2 of att48, and one for which the nearest whole number is below."""
    points = np.array([[6734.0, 1453.0], [2233.0, 10.0], [6734.0, 1463.0]])
    table = weights_of("ATT", points)
    assert table[0, 1] == 1495  # sqrt((4501^2 + 1443^2) / 10) = 1494.7
    assert table[0, 2] == 4  # sqrt(10) = 3.2, whose nearest whole number is 3


def test_geographic_weights_are_those_of_ulysses():
    """Rows of degrees.minutes; the first row of the matrix of ulysses16."""
    points = np.array([[38.24, 20.42], [39.57, 26.15], [40.56, 25.32], [36.26, 23.12], [33.48, 10.54]])
    assert weights_of("GEO", points)[0].tolist() == [0, 509, 501, 312, 1019]


def test_geographic_weights_follow_the_formula():
    """South and west are below 0, minutes too: -33.30 is 33.5 degrees south."""
    points = np.array([[-33.30, -70.45], [51.30, 0.15]])
    pi = 3.141592
    (a, b), (c, d) = ((math.copysign(abs(x) // 1 + 5 * (abs(x) % 1) / 3, x) * pi / 180 for x in row) for row in points)
    q1, q2, q3 = math.cos(b - d), math.cos(a - c), math.cos(a + c)
    kilometres = 6378.388 * math.acos(0.5 * ((1 + q1) * q2 - (1 - q1) * q3))
    assert weights_of("GEO", points)[0, 1] == int(kilometres + 1)


def test_the_first_angle_of_a_diffractometer_goes_around():
    points = np.array([[1.0, 0.0, 0.0], [359.5, 0.0, 0.0]])
    assert weights_of("XRAY1", points)[0, 1] == 150
    assert weights_of("XRAY2", points)[0, 1] == 120


SYMMETRIC = [[0, 1, 2, 3], [1, 0, 4, 5], [2, 4, 0, 6], [3, 5, 6, 0]]
IN_LAYOUT = {
    "FULL_MATRIX": "0 1 2 3 1 0 4 5 2 4 0 6 3 5 6 0",
    "UPPER_ROW": "1 2 3 4 5 6",
    "LOWER_ROW": "1 2 4 3 5 6",
    "UPPER_DIAG_ROW": "9 1 2 3 9 4 5 9 6 9",
    "LOWER_DIAG_ROW": "9 1 9 2 4 9 3 5 6 9",
    "UPPER_COL": "1 2 4 3 5 6",
    "LOWER_COL": "1 2 3 4 5 6",
    "UPPER_DIAG_COL": "9 1 9 2 4 9 3 5 6 9",
    "LOWER_DIAG_COL": "9 1 2 3 9 4 5 9 6 9",
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_layouts_of_matrices(layout):
    numbers = [float(word) for word in IN_LAYOUT[layout].split()]
    assert len(numbers) == numbers_in(layout, 4)
    assert matrix_of(layout, 4, np.array(numbers)).tolist() == SYMMETRIC


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_file_with_a_matrix(layout, tmp_path):
    path = tmp_path / "four.tsp"
    head = "NAME: four\nTYPE: TSP\nDIMENSION: 4\nEDGE_WEIGHT_TYPE: EXPLICIT\n"
    words = IN_LAYOUT[layout].split()  # lines may break anywhere
    rows = f"{' '.join(words[:2])}\n  {' '.join(words[2:])}\n"
    path.write_text(f"{head}EDGE_WEIGHT_FORMAT: {layout}\nEDGE_WEIGHT_SECTION\n{rows}EOF\n", encoding="utf-8")
    mission = muster.load(path, salesmen=1)
    assert mission.rules.travel == "matrix"
    verdict = muster.verify(mission, {"r_0": ["2", "4", "3"]})
    assert verdict.valid
    assert verdict.total_cost == 1 + 5 + 6 + 2
    assert len({task.position for task in mission.tasks}) == 3  # places on a circle, for pictures


def test_a_matrix_need_not_be_symmetric(tmp_path):
    path = tmp_path / "three.atsp"
    text = "TYPE: ATSP\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: EXPLICIT\nEDGE_WEIGHT_FORMAT: FULL_MATRIX\n"
    path.write_text(f"{text}EDGE_WEIGHT_SECTION\n9999 1 2\n10 9999 20\n100 200 9999\n", encoding="utf-8")
    mission = muster.load(path, salesmen=2, depot="2")
    assert mission.name == "three-2"
    assert muster.verify(mission, {"r_0": ["1", "3"]}).total_cost == 10 + 2 + 200
    assert muster.verify(mission, {"r_0": ["3"], "r_1": ["1"]}).total_cost == 20 + 200 + 10 + 1


def test_places_of_a_matrix_are_for_display(tmp_path):
    path = tmp_path / "three.tsp"
    text = "TYPE: TSP\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: EXPLICIT\nEDGE_WEIGHT_FORMAT: UPPER_ROW\nEDGE_WEIGHT_SECTION\n"
    path.write_text(f"{text}7 8\n9\nDISPLAY_DATA_SECTION\n1 5 5\n2 1.5 0\n3 0 1\n", encoding="utf-8")
    mission = muster.load(path, salesmen=1)
    assert [task.position for task in mission.tasks] == [(1.5, 0), (0, 1)]
    assert muster.verify(mission, {"r_0": ["2", "3"]}).total_cost == 24


@pytest.mark.parametrize("kind", COORDINATES)
def test_a_file_of_every_type(kind, tmp_path):
    path = tmp_path / "three.tsp"
    points = [NEAR, FAR, (2.0, 7.0, 3.0)]
    rows = "".join(f"{k} {' '.join(map(str, p[: COORDINATES[kind]]))}\n" for k, p in enumerate(points, 1))
    head = f"NAME: three\nTYPE: TSP\nDIMENSION: 3\nEDGE_WEIGHT_TYPE: {kind}\n"
    path.write_text(f"{head}NODE_COORD_SECTION\n{rows}EOF\n", encoding="utf-8")
    mission = muster.load(path, salesmen=1)
    total = muster.verify(mission, {"r_0": ["2", "3"]}).total_cost
    if kind == "EUC_2D":
        assert mission.rules.travel is None
        assert total == pytest.approx(math.hypot(1, 2.5) + math.hypot(1, 4.5) + math.hypot(2, 7))
        return
    table = weights_of(kind, np.array([point[: COORDINATES[kind]] for point in points]))
    assert total == table[0, 1] + table[1, 2] + table[2, 0]
    assert muster.solve(mission, "greedy").objective_value is not None


def test_coordinates_that_are_too_large_are_told(tmp_path):
    path = tmp_path / "two.tsp"
    text = "TYPE: TSP\nDIMENSION: 2\nEDGE_WEIGHT_TYPE: CEIL_2D\nNODE_COORD_SECTION\n1 1e300 0\n2 0 0\n"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(MissionError, match="numbers too large; expected coordinates for which CEIL_2D is a finite"):
        muster.load(path, salesmen=1)
