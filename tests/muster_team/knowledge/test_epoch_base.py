"""The base of an epoch, for any declarations."""

from collections import Counter
from dataclasses import replace

from hypothesis import example, given
from hypothesis import strategies as st

from muster import Task
from muster_team.knowledge.epoch_base import agreed
from muster_team.knowledge.messages import Claim, Declaration, Fact
from muster_team.knowledge.new_tasks import content_of
from muster_team.knowledge.rules import Rules

ROBOTS = ("a", "b", "c", "d")
TASKS = tuple("012345")
RULES = Rules(
    robots={name: k for k, name in enumerate(ROBOTS)},
    tasks={name: k for k, name in enumerate(TASKS)},
    prerequisites={name: TASKS[:k:3] if k % 2 else () for k, name in enumerate(TASKS)},
    once=frozenset("45"),
)

claims = st.builds(Claim, st.sampled_from(TASKS), st.sampled_from((0.0, 1.0, 2.5)), st.integers(0, 9), st.booleans())
routes = st.lists(claims, max_size=5, unique_by=lambda claim: claim.task).map(tuple)
facts = st.builds(
    Fact,
    st.sampled_from(TASKS),
    st.sampled_from(ROBOTS),
    st.sampled_from(("done", "begun", "waived", "cancelled")),
    st.integers(0, 5),
)


@st.composite
def declarations(draw):
    members = tuple(sorted(draw(st.sets(st.sampled_from(ROBOTS), min_size=1))))
    return [
        Declaration(
            robot,
            draw(st.integers(1, 2)),
            3,
            members,
            draw(routes),
            tuple(draw(st.lists(facts, max_size=3, unique=True))),
            draw(st.integers(0, 9)),
            (1,) * len(members),
            draw(st.booleans()),
        )
        for robot in members
    ]


@given(declarations(), st.randoms())
def test_the_order_of_declarations_and_facts_does_not_matter(said, random):
    shuffled = [replace(one, facts=tuple(random.sample(one.facts, len(one.facts)))) for one in said]
    random.shuffle(shuffled)
    assert agreed(shuffled, RULES) == agreed(said, RULES)


@given(declarations())
def test_each_task_has_one_owner_or_was_begun_by_all_of_them(said):
    base = agreed(said, RULES)
    owned = Counter(claim.task for route in base.routes.values() for claim in route)
    for task, count in owned.items():
        assert count == 1 or (
            base.twice[task] == tuple(r for r in base.twice[task] if any(c.task == task for c in base.routes[r]))
            and len(base.twice[task]) == count
            and all(claim.begun for route in base.routes.values() for claim in route if claim.task == task)
        )


@given(declarations())
def test_what_was_begun_is_kept_and_stands_first(said):
    base = agreed(said, RULES)
    for one in said:
        begun = tuple(claim for claim in one.route if claim.begun)
        assert base.routes[one.robot][: len(begun)] == begun


@given(declarations())
def test_nothing_is_owned_that_was_not_claimed_and_what_is_lost_is_told(said):
    base = agreed(said, RULES)
    claimed = Counter((one.robot, claim.task) for one in said for claim in one.route)
    kept = Counter((robot, claim.task) for robot, route in base.routes.items() for claim in route)
    assert claimed == kept + Counter(base.dropped)


def waivers(base):
    """What robots say next: they waive what they had announced to begin, and have lost."""
    return {
        replace(fact, kind="waived")
        for fact in base.facts
        if fact.kind == "begun" and (fact.robot, fact.task) in base.dropped
    }


def both_have_announced(*orders):
    """Both robots have announced to begin one task, and own it."""
    return [
        Declaration(robot, 1, 3, ("a", "c"), (Claim("0", 1.0, 1),), (Fact("0", robot, "begun", order),))
        for robot, order in zip("ac", orders, strict=True)
    ]


@given(declarations())
@example(both_have_announced(1, 2))
@example(both_have_announced(2, 1))
def test_it_is_idempotent(said):
    base = agreed(said, RULES)
    waived = waivers(base)
    again = agreed([replace(d, route=base.routes[d.robot], facts=(*d.facts, *waived)) for d in said], RULES)
    assert again.routes == base.routes
    assert again.dropped == ()
    assert again.closed <= base.closed
    assert base.closed - again.closed <= {fact.task for fact in waived}


@given(declarations())
def test_no_task_waits_for_itself_or_for_one_that_nobody_does(said):
    base = agreed(said, RULES)
    done = {fact.task for fact in base.done}
    begun = {claim.task for route in base.routes.values() for claim in route if claim.begun}
    finished, routes_left = set(done), {r: [c.task for c in route] for r, route in base.routes.items()}
    moved = True
    while moved:
        moved = False
        for route in routes_left.values():
            while route and (route[0] in begun or finished.issuperset(RULES.prerequisites[route[0]])):
                finished.add(route.pop(0))
                moved = True
    assert not any(routes_left.values())


@given(declarations())
def test_what_was_done_or_cancelled_is_not_for_sale_and_of_few_nothing_that_may_be_begun_once(said):
    base = agreed(said, RULES)
    assert base.closed >= {fact.task for fact in base.facts if fact.kind in ("done", "cancelled")}
    assert sum(one.knows for one in said) >= RULES.majority or base.closed >= RULES.once


@given(declarations())
def test_other_declarations_have_another_digest(said):
    base = agreed(said, RULES)
    other = [replace(said[0], rounds=said[0].rounds + 1), *said[1:]]
    assert agreed(other, RULES).digest != base.digest


def test_a_task_goes_to_who_has_begun_it_then_to_the_lowest_price_then_by_tie_order():
    def owner(**claimed):
        said = [Declaration(r, 1, 1, tuple(sorted(claimed)), (claim,)) for r, claim in claimed.items()]
        return [robot for robot, route in agreed(said, RULES).routes.items() if route]

    low, high = Claim("0", 1.0, 1), Claim("0", 2.0, 1)
    assert owner(a=high, b=low) == ["b"]
    assert owner(a=low, b=low) == ["a"]
    assert owner(a=low, b=replace(high, begun=True)) == ["b"]
    assert owner(a=replace(low, begun=True), b=replace(high, begun=True)) == ["a", "b"]


def test_a_task_reserved_by_one_who_is_not_here_is_neither_owned_nor_sold():
    said = [Declaration("a", 1, 1, ("a",), (Claim("4", 1.0, 1),), (Fact("4", "b", "begun", 1),))]
    base = agreed(said, RULES)
    assert base.routes["a"] == ()
    assert "4" in base.closed


def test_tasks_that_were_added_belong_to_the_base_of_two_of_one_name_the_first():
    one, other = (content_of(Task(id="n", position=(x, 0.0))) for x in (1.0, 2.0))
    facts = (Fact("n", "b", "added", 1, one), Fact("n", "a", "added", 2, other))
    base = agreed([Declaration("a", 1, 1, ("a",), (Claim("n", 1.0, 1),), facts)], RULES)
    assert [fact.content for fact in base.added] == [one]
    assert [claim.task for claim in base.routes["a"]] == ["n"]


def test_who_claims_a_task_without_knowing_that_it_has_moved_loses_it_unless_it_has_begun():
    there = Fact("0", "b", "moved", 1, content_of(Task(id="0", position=(9.0, 0.0))))
    claim = Claim("0", 1.0, 1)

    def owners(mine, *facts):
        said = [Declaration("a", 1, 1, ("a", "b"), (mine,), facts), Declaration("b", 1, 1, ("a", "b"), (), (there,))]
        return [robot for robot, route in agreed(said, RULES).routes.items() if route]

    assert owners(claim) == []
    assert owners(claim, there) == ["a"]
    assert owners(replace(claim, begun=True)) == ["a"]
