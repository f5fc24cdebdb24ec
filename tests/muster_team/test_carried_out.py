"""The first seeds of the campaign of teams at work; `make campaign-auction CAMPAIGN_FLAGS=--timed` runs thousands."""

from collections import Counter

import pytest
from tests.muster_team.campaign.carried_out import carried_out
from tests.muster_team.campaign.team_missions import team_scene

SEEDS, CHUNK = 12, 6


@pytest.mark.long
@pytest.mark.parametrize("first", range(0, SEEDS, CHUNK))
def test_no_team_is_too_small_or_apart_and_nothing_is_left_without_a_reason(first):
    failures = {seed: what for seed in range(first, first + CHUNK) if (what := carried_out(seed).failures)}
    assert failures == {}


@pytest.mark.long
def test_a_team_whose_parts_were_done_before_it_lost_each_other_tells_later_that_it_has_ended():
    """Its robots are apart when they have done their parts, and break off; then each hears of the other's part."""
    assert carried_out(195).failures == []
    assert carried_out(254).failures == []


def test_scenes_have_everything():
    scenes = [team_scene(seed) for seed in range(200)]
    kinds = Counter(fault.kind for scene in scenes for fault in scene.faults)
    assert all(kinds[kind] > 15 for kind in ("crash", "restart", "forget", "cut", "block", "heal", "told"))
    tasks = [task for scene in scenes for task in scene.mission.tasks]
    for key in ("robots_needed", "team", "needs", "starts_with", "prerequisites", "lags", "window_s", "deadline_s"):
        assert sum(bool(getattr(task, key)) for task in tasks) > 15, key
    assert max(scene.conditions["loss"] for scene in scenes) > 0.45
