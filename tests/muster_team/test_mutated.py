"""A short form of the campaign of mutated messages; `make campaign-mutated` feeds a million. And what it finds."""

import pytest

pytest.importorskip("cryptography", reason="the extra `net` is not installed")

from tests.muster_team.mutated.trial import Trial

from muster_team.knowledge.verdicts import TAKEN
from muster_team.negotiators import participant
from muster_team.network.codec import OtherVersionError
from muster_team.processes import node


def test_no_mutated_message_harms_a_team():
    report = Trial(2, words=20).run()
    assert report.failures == []
    assert report.counts["mutated messages"] > 400
    assert report.counts["of these not_admitted"] > 5


def found(what, **how):
    """Whether the campaign finds this in some seed."""
    return any(what in failure for seed in range(10) for failure in Trial(seed, **how).run().failures)


def test_without_admission_the_campaign_finds_what_is_kept(monkeypatch):
    monkeypatch.setattr(participant, "admit", lambda *said: TAKEN)
    assert found("has kept what is refused", phases=5, words=60)


def test_the_campaign_finds_what_is_raised(monkeypatch):
    monkeypatch.setattr(node, "MalformedError", OtherVersionError)
    assert found("raises MalformedError", phases=2, words=20)
