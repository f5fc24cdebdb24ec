"""What must hold in every world, and what in those in which the robots agree and nothing is on its way."""

from itertools import combinations

from tests.muster_team.model.replicas import OFF
from tests.muster_team.model.world import PAIR, ROBOTS

from muster_team.knowledge.verdicts import Taken


def clash(looks, world):
    """What two robots own that have not lost each other; empty if that is nothing."""
    for one, other in combinations(range(ROBOTS), 2):
        if OFF in (world.states[one], world.states[other]) or world.lost & PAIR[one, other]:
            continue
        both = looks[world.states[one]].owned & looks[world.states[other]].owned
        if both:
            return f"robots {one} and {other} own {', '.join(sorted(both))}, and have not lost each other"
    return ""


def agree(looks, world):
    """Whether the robots that run are settled with each other and nobody else."""
    there = [looks[state] for state in world.states if state != OFF]
    alive = tuple(robot for robot, state in enumerate(world.states) if state != OFF)
    return all(
        look.settled and look.members == alive and (look.stage, look.known) == (there[0].stage, there[0].known)
        for look in there
    )


def wrong_when_quiet(looks, world, tasks):
    """What does not hold though the robots agree; `tasks` are those that somebody has to own."""
    there = [looks[state] for state in world.states if state != OFF]
    if not there:
        return
    owned = sorted(task for look in there for task in look.owned)
    yield from (f"{task} is owned {owned.count(task)} times" for task in sorted(set(owned)) if owned.count(task) > 1)
    taken = {fact for fact, verdict in there[0].verdicts if isinstance(verdict, Taken)}
    added = {fact.task for fact in taken}
    yield from (f"nobody owns {task}" for task in sorted({*tasks, *added}.difference(owned)))
    for look in there[1:]:
        if look.verdicts != there[0].verdicts:
            yield f"orders are refused differently: {look.verdicts}, {there[0].verdicts}"
        if look.plan != there[0].plan:
            yield f"views differ: {look.plan}, {there[0].plan}"
    for fact in taken:
        if fact.content not in there[0].added:
            yield f"{fact.task} of {fact.robot} is taken, and not so"
    for look in there if len(there) == ROBOTS else ():
        for fact, _ in look.verdicts:
            if fact not in look.final:
                yield f"the operator who gave {fact.task} to {fact.robot} is not answered"
