"""Teams in narrow places get through whatever happens; `make disturbances-traffic` tries 2,000 missions."""

from collections import Counter

from tests.disturbances.traffic.script import STOPS
from tests.disturbances.traffic.trial import trial

SEEDS = range(4)


def test_teams_in_narrow_places_get_through_whatever_happens():
    reports = [trial(seed) for seed in SEEDS]
    assert [f"seed {report.seed}: {failure}" for report in reports for failure in report.failures] == []
    counts = sum((report.counts for report in reports), Counter())
    for kind in (*STOPS, "new task", "cancel", "joins", "returns"):
        assert counts[kind] > 0, kind
