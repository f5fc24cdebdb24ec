"""Nothing is lost without a reason or done by too few; `make disturbances-timed` tries 2,000 missions."""

from collections import Counter

import pytest

from tests.disturbances.timed.trial import trial

SEEDS = (*range(50, 90), 138)  # in two a window is missed, as happens rarely; in the last a tail went to a weaker robot
FEW = (54, 65, 76, 138)
"""Seeds of the short form; together they have every kind of event."""


@pytest.mark.parametrize("seeds", [FEW, pytest.param(SEEDS, marks=pytest.mark.long)], ids=["few", "all"])
def test_missions_with_windows_and_teams_are_carried_out_whatever_happens(seeds):
    reports = [trial(seed) for seed in seeds]
    assert [f"seed {report.seed}: {failure}" for report in reports for failure in report.failures] == []
    counts = sum((report.counts for report in reports), Counter())
    for kind in ("work_broken_off", "window_missed", "robot_fails", "robot_silent", "new_task"):
        assert counts[kind] > 0, kind
    assert counts["team tasks done"] > 0
    assert counts["alternatives done"] > 0
