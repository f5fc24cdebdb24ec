"""False suspicions: what is measured is what the chance of losing all heartbeats for so long lets expect."""

import pytest
from tests.muster_team.simulated_figures import suspicion

from muster_team.membership.members import Timeouts
from muster_team.network.memory_network import TICK_S


def expected(loss, heartbeats):
    """How often an hour so many words in a row are lost, when there is one every 0.2 to 0.25 s."""
    return [
        3600 / gap_s * (1 - loss) * loss**heartbeats
        for gap_s in (Timeouts().heartbeat_s + TICK_S, Timeouts().heartbeat_s)
    ]


@pytest.mark.long
def test_the_rate_is_that_of_runs_of_lost_beats():
    seen = suspicion.rate(0.5, runs=6, seed=1)
    assert expected(0.5, 20)[0] < seen.low < seen.mean < seen.high < expected(0.5, 15)[1]


@pytest.mark.long
def test_at_30_percent_loss_fewer_than_one_in_10000_pair_hours():
    seen = suspicion.rate(0.3, runs=6, seed=2)
    assert 0 < seen.low < seen.high < 1e-4
    assert suspicion.bound(0.3) < 1e-4


def test_more_patience_fewer_suspicions():
    assert suspicion.bound(0.3, Timeouts(suspect_s=6.0)) < suspicion.bound(0.3) / 1000
