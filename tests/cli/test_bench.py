"""`muster bench`: which benches there are; what they measure is in `tests/studies`."""

import re

from muster.studies.bench import BENCHES


def test_the_help_names_all_benches(muster):
    code, out, _ = muster("bench", "--help")
    assert code == 0
    (named,) = re.findall(r"Some of: ([^.]*)\.", out)
    assert "".join(named.split()).split(",") == list(BENCHES)


def test_a_bench_that_there_is_not(muster):
    code, out, err = muster("bench", "--only", "gready-small")
    assert (code, out) == (2, "")
    assert "expected greedy-small, genetic, " in err
    assert "did you mean 'greedy-small'" in err
