"""Teams in narrow places get through whatever happens; `make disturbances-traffic` tries 2,000 missions."""

from collections import Counter

import pytest

from tests.disturbances.traffic.script import STOPS
from tests.disturbances.traffic.trial import trial

SEEDS = (
    3,
    8,
    10,
    12,
    16,
    20,
    22,
    24,
    85,
    94,
    96,
    102,
    192,
    260,
    333,
    922,
    1219,
    1363,
    1613,
    1694,
    3084,
    3154,
    3384,
    3438,
)
FEW = (102, 333, 1219)
"""Seeds of the short form; together they have every kind of disturbance."""


@pytest.mark.parametrize("seeds", [FEW, pytest.param(SEEDS, marks=pytest.mark.long)], ids=["few", "all"])
def test_teams_in_narrow_places_get_through_whatever_happens(seeds):
    reports = [trial(seed) for seed in seeds]
    assert [f"seed {report.seed}: {failure}" for report in reports for failure in report.failures] == []
    counts = sum((report.counts for report in reports), Counter())
    for kind in (*STOPS, "removed", "moved", "new task", "cancel", "joins", "returns", "closes", "opens"):
        assert counts[kind] > 0, kind
