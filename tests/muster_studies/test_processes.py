"""Runs in several processes give what they give in one, and end when they should."""

import pytest

from muster_studies.processes import run_cases
from muster_studies.runs import Case

SHORT = [
    Case(mission="6T-2R", allocator="greedy"),
    Case(mission="6T-2R", allocator="greedy+genetic", iterations=20),
    Case(mission="6T-2R", allocator="hill-climbing", iterations=30),
]


def plans(samples):
    return {
        case: [(o.seed, o.iterations, tuple(route.tasks for route in o.verdict.routes)) for o in sample.outcomes]
        for case, sample in samples.items()
    }


@pytest.mark.long
def test_any_number_of_workers_gives_the_same():
    counts = []
    one = run_cases([*SHORT, SHORT[1]], 3, 1, lambda done, whole: counts.append((done, whole)))
    assert counts == [(done, 7) for done in range(1, 8)]  # greedy once, no case twice
    assert plans(run_cases(SHORT, 3, 2)) == plans(one)
    assert list(one) == SHORT
    assert [outcome.seed for outcome in one[SHORT[1]].outcomes] == [0, 1, 2]


def test_an_interruption_ends_runs_that_have_not_finished():
    def interrupt(done, whole):
        raise KeyboardInterrupt

    endless = Case(mission="6T-2R", allocator="greedy+genetic", iterations=10**12)
    with pytest.raises(KeyboardInterrupt):
        run_cases([endless, SHORT[0]], 1, 2, interrupt)
