"""No load is lost or delivered twice, and no robot is empty in the field; `make campaign-goods` tries 2,000."""

from collections import Counter

import pytest

from tests.disturbances.goods.trial import trial

SEEDS = range(50)
FEW = (0, 12, 28, 37)
"""Seeds of the short form; together they have every kind of event."""


@pytest.mark.parametrize("seeds", [FEW, pytest.param(SEEDS, marks=pytest.mark.long)], ids=["few", "all"])
def test_missions_with_goods_and_batteries_are_carried_out_whatever_happens(seeds):
    reports = [trial(seed) for seed in seeds]
    assert [f"seed {report.seed}: {failure}" for report in reports for failure in report.failures] == []
    counts = sum((report.counts for report in reports), Counter())
    for kind in (
        "load_lies",
        "energy_low",
        "service_ends",
        "station_fails",
        "station_returns",
        "robot_fails",
        "new_task",
        "alternatives done",
        "times on board limited",
        "calls at stations for some",
    ):
        assert counts[kind] > 0, kind
