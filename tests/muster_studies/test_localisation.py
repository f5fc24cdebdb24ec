"""Study `localisation`: its tables say what the filters do."""

import pytest

from muster_studies.effort import Effort
from muster_studies.registry import study_named

pytest.importorskip("scipy")
pytestmark = pytest.mark.long


def table(number):
    (made,) = study_named("localisation").run(Effort(quick=True, seeds=1, tables=(number,))).tables
    return made.records()


def test_a_map_keeps_the_error_bounded_and_scans_are_better_than_wheels():
    odometry, scans, particles = table("tracking")
    assert max(particles["mean error m"], scans["mean error m"]) < odometry["mean error m"]
    assert particles["greatest m"] < 0.5


def test_a_robot_finds_out_where_it_is():
    (row,) = table("global")
    assert row["found"] == row["runs"] == 1


def test_a_teammate_helps():
    alone, together = table("team")
    assert together["mean error m"] < alone["mean error m"]
