import numpy as np

from muster.report.figures.labels import line_obstacles, mark_obstacles, place_labels

PAGE = np.array([(0.0, 0.0), (100.0, 100.0)])
NOTHING = np.empty((0, 3))


def place(anchors, obstacles, size=(12.0, 6.0)):
    points = np.array(anchors, dtype=float)
    return place_labels(points, np.full((len(points), 2), size), 5.0, obstacles, PAGE)


def test_right_of_the_point_where_nothing_is_in_the_way():
    np.testing.assert_allclose(place([(50, 50)], NOTHING), [(5 + 6, 0)])


def test_not_upon_a_line():
    line = line_obstacles(np.array([(50.0, 50.0), (90.0, 50.0)]))
    np.testing.assert_allclose(place([(50, 50)], line), [(-11, 0)])


def test_not_upon_a_mark():
    np.testing.assert_allclose(place([(50, 50)], mark_obstacles(np.array([(62.0, 50.0)]), 4.0)), [(-11, 0)])


def test_not_off_the_page():
    np.testing.assert_allclose(place([(95, 50)], NOTHING), [(-11, 0)])


def test_labels_of_one_point_do_not_cover_one_another():
    centres = place([(50, 50)] * 5, NOTHING) + 50
    for k, one in enumerate(centres):
        for other in centres[:k]:
            assert np.any(np.abs(one - other) >= (12.0, 6.0))


def test_lines_are_sampled_along_their_parts_and_not_across_gaps():
    line = np.array([(0, 0), (9, 0), (np.nan, np.nan), (50, 50), (50, 53)])
    points = line_obstacles(line, step=3.0)[:, :2]
    assert not np.isnan(points).any()
    assert np.all((points[:, 1] == 0) | (points[:, 0] == 50))
    assert points[points[:, 1] == 0][:, 0].max() == 9
    assert len(line_obstacles(np.empty((0, 2)))) == 0
