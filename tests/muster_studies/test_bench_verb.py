"""`muster bench`: which benches there are; what they measure is in `tests/muster_studies`."""

import json
import re

from muster.mission.errors import MissingExtraError
from muster_studies import bench_verb
from muster_studies.benches import BENCHES, bench_named
from muster_studies.benches.measurement import Measurement


def test_the_help_names_all_benches(muster):
    code, out, _ = muster("bench", "--help")
    assert code == 0
    (named,) = re.findall(r"Some of: ([^.]*)\.", out)
    assert "".join(named.split()).split(",") == list(BENCHES)


def test_each_bench_is_a_function():
    assert all(callable(bench_named(name)) for name in BENCHES)


def test_a_bench_that_there_is_not(muster):
    code, out, err = muster("bench", "--only", "gready-small")
    assert (code, out) == (2, "")
    assert "expected greedy-small, genetic, " in err
    assert "did you mean 'greedy-small'" in err


def test_a_bench_that_needs_what_is_not_installed_is_skipped_unless_it_was_asked_for(muster, monkeypatch):
    def absent(runs):
        raise MissingExtraError("ros1", "ROS 1")

    one = Measurement.over_runs("there", "s", [1.0], "", "")
    benches = {"gone": absent, "there": lambda runs: [one]}
    monkeypatch.setattr(bench_verb, "BENCHES", benches)
    monkeypatch.setattr(bench_verb, "bench_named", benches.__getitem__)
    code, out, err = muster("bench", "--format", "json", "-q")
    assert (code, [row["name"] for row in json.loads(out)]) == (0, ["there"])
    assert err == "skipped gone: ROS 1 needs an optional part: pip install 'muster-robotics[ros1]'\n"
    assert muster("bench", "--only", "gone", "-q")[0] == 2
