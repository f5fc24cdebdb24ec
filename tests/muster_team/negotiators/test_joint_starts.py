"""What one robot states of tasks that several robots begin at the same moment."""

from functools import partial

from muster_team.knowledge.facts import Knowledge
from muster_team.negotiators.joint_starts import JointStarts

UNIT = ("4", "6")
"""These begin together."""


def joint_starts(known):
    return JointStarts("r_1", known, lambda task, kind, content: known.say(task, "r_1", kind, content))


def left(known):
    return {fact.task for fact in known.facts if fact.kind == "left"}


def state_ready(joint, task):
    joint.state_ready(task, UNIT, (("r_0", "6" if task == "4" else "4"), ("r_1", task)), 0.0, 1.0)


def test_who_has_gone_over_to_the_other_task_of_a_unit_does_not_leave_it_again():
    known = Knowledge()
    joint = joint_starts(known)
    state_ready(joint, "6")
    joint.leave_all_but("4")
    assert left(known) == {"6"}
    state_ready(joint, "4")
    facts = set(known.facts)
    for _ in range(3):
        joint.leave_of_last_life(lambda task: UNIT)
    assert known.facts == facts


def test_after_a_restart_it_leaves_where_it_was_ready_last():
    known = Knowledge()
    before = joint_starts(known)
    state_ready(before, "6")
    before.leave_all_but("4")
    state_ready(before, "4")
    after = joint_starts(known)
    leave = partial(after.leave_of_last_life, lambda task: UNIT)
    leave()
    assert left(known) == {"6", "4"}
    facts = set(known.facts)
    leave()
    assert known.facts == facts
