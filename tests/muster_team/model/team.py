"""The team of the model: three robots, two tasks of which one is at-most-once, and two operators who contradict."""

from tests.muster_team.model.explorer import Explorer
from tests.muster_team.model.replicas import Replicas
from tests.muster_team.model.world import Bounds, Model
from tests.muster_team.networks import line_mission

from muster import Task
from muster.allocation.auctions.auction import Parameters
from muster.model.problem import Problem
from muster_team.membership.members import Timeouts
from muster_team.negotiators.participation import negotiator_of

ONCE = frozenset({"0"})
TIMES = Timeouts(heartbeat_s=1.0, retry_s=1.0, suspect_s=2.0, bid_s=3.0, exclusion_s=2.0)
"""In quanta. Timers of the core are compared with its time alone, so that between two quanta nothing becomes due."""

ORDERS = (
    (0, lambda node: node.announce(Task(id="x", position=(50.0, 5.0)))),
    (2, lambda node: node.announce(Task(id="x", position=(150.0, 5.0)))),
)
"""Two operators give a task of the same name at two places: the whole team has to take one and the same of them."""

PROBLEM = Problem.compile(line_mission(robots=3, tasks=2, once=ONCE)).ready()
ROBOTS = [robot.id for robot in PROBLEM.robots]


def negotiator(robot, **how):
    return negotiator_of(PROBLEM, Parameters(), ROBOTS[robot], timeouts=TIMES, **{"incarnation": 1, **how})


def model(bounds: Bounds):
    """The model of the shipped core within bounds."""
    return Model(Replicas(ROBOTS, negotiator, ORDERS), bounds, ONCE)


def explorer(bounds: Bounds, **how):
    """An exploration that has not begun."""
    return Explorer(model(bounds), {"1"}, **how)


PARTS = {
    "two orders": Bounds(quanta=2, orders=2),
    "a crash and an order": Bounds(quanta=3, crashes=1, orders=1),
    "two crashes": Bounds(quanta=4, crashes=2),
    "a crash and a start": Bounds(quanta=3, crashes=1, restarts=1, forgets=True),
    "at most once": Bounds(epochs=4, quanta=4, crashes=1, work=True),
    "a lost message and an order": Bounds(quanta=2, losses=1, orders=1),
    "a late message and one twice": Bounds(quanta=1, delays=1, repeats=1),
    "every order of arrival": Bounds(quanta=0, any_order=True),
    "two crashes and two orders": Bounds(quanta=3, crashes=2, orders=2),
}
"""What is explored. Every part is small enough to be exhausted, the last one within five minutes of a core."""
