"""The checked model within small bounds; `make campaign-model` explores large ones. And faults that it has to find."""

import re
from pathlib import Path

import pytest
from tests.muster_team.campaign.mutants import plant
from tests.muster_team.model.explorer import Explorer
from tests.muster_team.model.team import PARTS, ROBOTS, explorer, model, negotiator
from tests.muster_team.model.world import Bounds

from muster_team.negotiators.negotiator import Negotiator

SMALL = [Bounds(quanta=2, crashes=1), Bounds(quanta=0, orders=1), Bounds(quanta=0, work=True)]


@pytest.mark.parametrize(
    "bounds", [*SMALL, *(pytest.param(part, marks=pytest.mark.long) for part in list(PARTS.values())[1:2])], ids=str
)
def test_every_promise_holds_in_every_world(bounds):
    found = explorer(bounds).explore()
    assert (found.fault, found.trace, found.left) == ("", [], 0)
    assert found.healed > 0


@pytest.mark.long
@pytest.mark.parametrize("part", ["two orders", "two crashes", "a crash and a start"])
def test_the_documentation_has_its_figures(part):
    page = (Path(__file__).parents[2] / "docs" / "negotiation.md").read_text(encoding="utf-8")
    (row,) = re.findall(rf"^\| {part} \| [^|]* \| ([\d,]+) \| ([\d,]+) \| ([\d,]+) \|$", page, re.MULTILINE)
    found = explorer(PARTS[part]).explore()
    assert (found.fault, found.left) == ("", 0)
    assert row == tuple(f"{figure:,}" for figure in (found.worlds, found.steps, found.states))


def test_an_exploration_is_the_same_each_time():
    one, other = (explorer(SMALL[1], most=150).explore() for _ in range(2))
    assert one == other


def test_an_exploration_that_is_cut_says_how_much_is_left():
    found = explorer(SMALL[0], most=50).explore()
    assert found.worlds == 50
    assert found.left > 0


@pytest.mark.long
@pytest.mark.parametrize(
    "bounds",
    [
        SMALL[0],
        *(
            pytest.param(bounds, marks=pytest.mark.long)
            for bounds in (
                *SMALL[1:],
                Bounds(quanta=2, crashes=2),
                Bounds(quanta=1, crashes=1, restarts=1, forgets=True),
            )
        ),
    ],
    ids=str,
)
def test_the_reduction_misses_no_quiet_world(bounds):
    shared = model(bounds)
    worlds = [[], []]
    for reduced, into in zip((True, False), worlds, strict=True):
        Explorer(shared, {"1"}, reduced=reduced, watch=into.append).explore()
    reduced, whole = ({world for world in seen if shared.is_quiet(world)} for seen in worlds)
    assert reduced == whole
    assert len(worlds[0]) <= len(worlds[1])


def test_a_negotiator_that_was_stored_goes_on_as_one_that_was_not():
    shared = model(Bounds(quanta=2, orders=2))
    nodes = [negotiator(robot) for robot in range(len(ROBOTS))]
    for node in nodes:
        node.start(0.0)
    world, steps = shared.first(), 0
    while after := next(shared.steps(world), None) or ((("time",), later) if (later := shared.time(world)) else None):
        (what, *about), world = after
        if what == "deliver":
            nodes[about[0][1]].handle(shared.replicas.messages[about[1]], float(world.now))
        elif what == "tick":
            nodes[about[0]].tick(float(world.now))
        elif what == "order":
            shared.replicas.give(nodes[shared.replicas.orders[about[0]][0]], about[0])
        for node, number in zip(nodes, world.states, strict=True):
            assert shared.replicas.looks[number].memory == shared.replicas.memories.index(node.memory)
            assert shared.replicas.is_in(ROBOTS.index(node.robot), number, node)
        steps += 1
    assert steps > 60


PLANTED = {  # what the core does wrong: module, right, wrong, and bounds within which it is found
    "an order is taken though there is a task of its name": (
        "knowledge.orders",
        'if fact.kind == "added" and self._is_known(task.id):',
        'if fact.kind == "added" and task.id in self.rules.tasks:',
        Bounds(quanta=1, orders=2),
        "x of r_2 is taken, and not so",
    ),
    "an operator is not answered": (
        "negotiators.negotiator",
        "self.rules.robots.keys() - self.revoked <= base.routes.keys()",
        "len(base.routes) > len(self.rules.robots)",
        Bounds(quanta=1, orders=1),
        "is not answered",
    ),
    "facts are not admitted": (
        "knowledge.admission",
        "if fact.kind not in FACTS or type(",
        "if fact.kind in FACTS or type(",
        Bounds(quanta=1, orders=1),
        "do not agree",
    ),
    "an owner does not release what another owns": (
        "knowledge.epoch_base",
        "keep = begun or (min(claimants)[3],)",
        "keep = begun or tuple(claim[3] for claim in claimants)",
        PARTS["a crash and a start"],
        "stands twice",
    ),
    "nobody need know what is begun": (
        "negotiators.owned_tasks",
        "return said and sum(declared.knows for declared in tell) >= rules.majority",
        "return True",
        PARTS["at most once"],
        "which is at-most-once, and was begun",
    ),
}


@pytest.mark.parametrize(
    "fault", [*list(PLANTED)[:2], *(pytest.param(fault, marks=pytest.mark.long) for fault in list(PLANTED)[2:])]
)
def test_a_planted_fault_is_found(monkeypatch, fault):
    module, right, wrong, bounds, seen = PLANTED[fault]
    plant(monkeypatch, module, right, wrong)
    found = explorer(bounds).explore()
    assert seen in found.fault
    assert found.trace


def test_an_error_in_the_core_is_a_fault(monkeypatch):
    monkeypatch.setattr(Negotiator, "handle", lambda node, message, now: 1 / 0)
    assert "ZeroDivisionError" in explorer(SMALL[0]).explore().fault
