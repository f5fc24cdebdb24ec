"""Nothing is lost, done twice or begun early, whatever goes wrong; `make disturbances` tries 10,000 missions."""

from collections import Counter

import pytest

from tests.disturbances.trial import trial

PART = 30


@pytest.mark.parametrize("first", [0, pytest.param(PART, marks=pytest.mark.long)])
def test_missions_are_carried_out_whatever_happens(first):
    reports = [trial(seed) for seed in range(first, first + PART)]
    assert [f"seed {report.seed}: {failure}" for report in reports for failure in report.failures] == []
    counts = sum((report.counts for report in reports), Counter())
    assert counts["missions"] == PART
    told = ("ends", "replanned", "moved", "lost", "new_task", "cancel_task", "move_task", "delay_task")
    for kind in (*told, "robot_fails", "robot_silent", "robot_returns", "robot_joins"):
        assert counts[kind] > 0, kind
