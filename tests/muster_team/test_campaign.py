"""The first seeds of the campaign; `make campaign-auction` runs thousands."""

from collections import Counter

import pytest
from tests.muster_team.campaign.calm import calm, like_the_centre
from tests.muster_team.campaign.carried_out import carried_out
from tests.muster_team.campaign.mutants import plant
from tests.muster_team.campaign.trial import trial
from tests.muster_team.networks import line_mission, settled_team
from tests.muster_team.trials import replay
from tests.muster_team.trials.observer import Observer
from tests.muster_team.trials.scenario import scenario_of

from muster.model.problem import Problem
from muster_team.auctions.capabilities import AGREED
from muster_team.negotiators.negotiator import Negotiator

RUNS = 15


@pytest.mark.long
@pytest.mark.parametrize("timed", [False, True], ids=["untimed", "with rules of time"])
def test_nothing_fails(timed):
    assert {seed: what for seed in range(RUNS) if (what := trial(seed, timed=timed).failures)} == {}


def test_missions_with_rules_of_time_have_all_of_them():
    words = Counter(word for seed in range(90) for word in Problem.compile(scenario_of(seed, timed=True).mission).asked)
    assert all(words[word] > 5 for word in AGREED)
    assert {task.id for task in scenario_of(3, timed=True).mission.tasks} == {
        task.id for task in scenario_of(3).mission.tasks
    }


def test_a_run_is_the_same_each_time():
    runs = [list(replay(11).lines()) for _ in range(2)]
    assert runs[0] == runs[1]
    assert runs[0][0].startswith("seed 11: ")
    assert runs[0][-1] == "nothing failed"


def test_an_owner_too_many_is_seen(monkeypatch):
    net = settled_team(line_mission())
    claims = net.nodes["r_0"].route
    monkeypatch.setattr(Negotiator, "route", claims)
    watching = Observer(net.nodes, set())
    watching.look("r_0")
    watching.look("r_1")
    assert watching.broken == [f"r_1 and r_0 both own {claim.task}" for claim in sorted(claims, key=lambda c: c.task)]


def test_a_task_begun_twice_is_seen():
    watching = Observer({}, {"0"})
    watching.begins("a", "0", again=False)
    watching.begins("a", "0", again=True)
    assert watching.broken == []
    watching.gone("a")
    watching.begins("b", "0", again=False)
    assert watching.broken == ["b begins 0, begun by a"]


def test_an_error_is_a_failure(monkeypatch):
    monkeypatch.setattr(Negotiator, "handle", lambda node, message, now: 1 / 0)
    assert "ZeroDivisionError" in trial(0).failures[0]


def timed(seed):
    return trial(seed, timed=True)


PLANTED = {  # which seed finds the fault, or one soon after it, and what it is: module, right, wrong
    "half of the team is enough": (
        12,
        "knowledge.rules",
        "len(self.robots) // 2 + 1",
        "(len(self.robots) + 1) // 2",
    ),
    "nobody need know what is begun": (
        36,
        "negotiators.owned_tasks",
        "declared.knows for declared in tell",
        "99 for declared in tell",
    ),
    "who begins need not have said so": (15, "negotiators.owned_tasks", "return said and sum", "return sum"),
    "who has forgotten counts": (102, "negotiators.participant", "Memory(knows=not self.forgot)", "Memory(knows=True)"),
    "a clock that was set back is not noticed": (
        0,
        "negotiators.participant",
        "if self._identity.renumber_above(heartbeat) or",
        "if False and",
    ),
    "what is waived stays closed": (77, "knowledge.facts", 'fact.kind == "waived"}', 'fact.kind == ""}'),
}


@pytest.mark.parametrize("fault", PLANTED)
def test_a_fault_of_the_protocol_is_found(monkeypatch, fault):
    """A test of the campaign; where other scenes take the place of these, other seeds will do."""
    first, *where = PLANTED[fault]
    plant(monkeypatch, *where)
    assert any(trial(seed).failures for seed in range(first, first + 30))


_SOLD = "self._auction = CoalitionAuction(problem, terms, routes)"


def _with_tasks(**keys):
    """The line that opens the sales, of tasks `t` with other keys."""
    tasks = ", ".join(f"{key}={value}" for key, value in keys.items())
    tasks = f"tuple(__import__('dataclasses').replace(t, {tasks}) for t in problem.tasks)"
    problem = f"__import__('dataclasses').replace(problem, tasks={tasks}, known=problem.measured)"
    return _SOLD.replace("(problem", f"({problem}")


_LATER = "None if t.deadline_s is None else t.deadline_s + 1.0"
PLANTED_IN_TIME = {  # which run finds the fault with which seed, or soon after it, and what it is: module, right, wrong
    "bids ignore windows": (like_the_centre, 0, "auctions.unit_sales", _SOLD, _with_tasks(window_s="()")),
    "bids ignore deadlines": (like_the_centre, 0, "auctions.unit_sales", _SOLD, _with_tasks(deadline_s="None")),
    "deadlines are off by one": (timed, 10, "auctions.unit_sales", _SOLD, _with_tasks(deadline_s=_LATER)),
    "bids ignore lags": (like_the_centre, 0, "auctions.unit_sales", _SOLD, _with_tasks(lags="{}")),
    "the worst bid wins": (
        like_the_centre,
        0,
        "auctions.unit_sales",
        "sorted(alone, key",
        "sorted(alone, reverse=True, key",
    ),
    "a team begins when its first robot could": (
        calm,
        0,
        "knowledge.joint_statements",
        "max(presence.from_s for",
        "min(presence.from_s for",
    ),
    "who learns of a begin too late begins too": (
        carried_out,
        6,
        "negotiators.joint_starts",
        "if now > begin(start.from_s)",
        "if False",
    ),
    "what was lost is not told again": (
        carried_out,
        0,
        "negotiators.repairs",
        "if message.known != known.digest and",
        "if False and",
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("fault", PLANTED_IN_TIME)
def test_a_fault_in_time_is_found(monkeypatch, fault):
    tried, first, *where = PLANTED_IN_TIME[fault]
    plant(monkeypatch, *where)
    assert any(tried(seed).failures for seed in range(first, first + 20))


@pytest.mark.long
@pytest.mark.parametrize("tried", [like_the_centre, calm], ids=lambda tried: tried.__name__)
def test_nothing_fails_of_teams_at_work(tried):
    """For those that carry a mission out see test_carried_out."""
    assert {seed: what for seed in range(4) if (what := tried(seed).failures)} == {}


@pytest.mark.long
@pytest.mark.parametrize(
    ("tried", "seed"), [(carried_out, 120), (carried_out, 1091), (calm, 368), (like_the_centre, 836)]
)
def test_what_failed_once_holds(tried, seed):
    """Who goes over to a tied task; a task given back until it is too late; a better bid found by fewer robots."""
    assert tried(seed).failures == []


def test_scenes_have_everything():
    scenes = [scenario_of(seed) for seed in range(300)]
    kinds = Counter(kind for one in scenes for kind in {incident.kind for incident in one.incidents})
    kinds_there = ("crash", "restart", "forget", "cut", "block", "heal", "announce", "cancel", "release", "withdraw")
    for kind in kinds_there:
        assert kinds[kind] > 15
    assert 30 < sum(one.links is not None for one in scenes) < 150
    assert 90 < sum(one.work_s is not None for one in scenes) < 240
    assert 45 < sum(one.method == "consensus-bundle" for one in scenes) < 105
    assert max(one.conditions.loss for one in scenes) > 0.45
    assert max(one.conditions.jitter_s for one in scenes) > 2 * min(one.conditions.delay_s for one in scenes)
    assert any(one.conditions.duplication for one in scenes)
    assert any(task.across_partition == "at-most-once" for one in scenes for task in one.mission.tasks)
    dying = [{i.robot for i in one.incidents if i.kind == "crash"} for one in scenes]
    assert any(len(dead) == len(one.mission.robots) - 1 for dead, one in zip(dying, scenes, strict=True))
