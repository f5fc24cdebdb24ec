"""Study `localisation`: its tables say what the filters do."""

import pytest

from muster_studies.effort import Effort
from muster_studies.registry import study_named

pytest.importorskip("scipy")
pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def tables():
    report = study_named("localisation").run(Effort(quick=True, seeds=1, tables=("tracking", "global", "team")))
    return {table.number: table.records() for table in report.tables}


def test_a_map_keeps_the_error_bounded_and_scans_are_better_than_wheels(tables):
    odometry, scans, particles = tables["tracking"]
    assert max(particles["mean error m"], scans["mean error m"]) < odometry["mean error m"]
    assert particles["greatest m"] < 0.5


def test_a_robot_finds_out_where_it_is(tables):
    (row,) = tables["global"]
    assert row["found"] == row["runs"] == 1


def test_a_teammate_helps(tables):
    alone, together = tables["team"]
    assert together["mean error m"] < alone["mean error m"]
