"""Nothing is lost, done twice or begun early, whatever goes wrong; `make disturbances` tries 10,000 missions."""

from collections import Counter

import pytest

from tests.disturbances.trial import trial


@pytest.mark.parametrize("seeds", [range(15), pytest.param(range(15, 60), marks=pytest.mark.long)], ids=["few", "all"])
def test_missions_are_carried_out_whatever_happens(seeds):
    reports = [trial(seed) for seed in seeds]
    assert [f"seed {report.seed}: {failure}" for report in reports for failure in report.failures] == []
    counts = sum((report.counts for report in reports), Counter())
    assert counts["missions"] == len(seeds)
    told = ("ends", "replanned", "moved", "lost", "new_task", "cancel_task", "move_task", "delay_task")
    for kind in (*told, "robot_fails", "robot_silent", "robot_returns", "robot_joins"):
        assert counts[kind] > 0, kind
