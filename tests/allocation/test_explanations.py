"""Reasons and alternatives where a route of the plan lacks a way, as a plan from elsewhere may."""

import math

from muster.allocation.reasons.explanations import Alternative, alternatives, unassigned
from muster.mission.model import Mission, Robot, Rules, Task, TravelTable
from muster.mission.plan import Reason
from muster.model.problem import Problem

INF = math.inf


def problem():
    """From the start to a, from a to c, from c to b, and from a start to d; no other ways."""
    places = ("r_0", "r_1", "a", "b", "c", "d")
    legs = {("r_0", "a"): 1, ("a", "c"): 2, ("c", "b"): 3, ("r_0", "d"): 4, ("r_1", "d"): 5}
    rows = tuple(tuple(0.0 if a == b else float(legs.get((a, b), INF)) for b in places) for a in places)
    return Problem.compile(
        Mission(
            rules=Rules(travel="matrix", objective="total"),
            robots=tuple(Robot(id=name, type="x", position=(0, 0)) for name in ("r_0", "r_1")),
            tasks=tuple(Task(id=name, position=(0, 0)) for name in "abcd"),
            travel={"x": "x.csv"},
            travel_tables={"x": TravelTable(places, rows)},
        )
    )


A_THEN_B = [[0, 1], []]


def test_a_task_that_brings_the_way_back_fits():
    c, d = unassigned(problem(), A_THEN_B)
    assert c.reasons == (
        Reason("r_0", "not-chosen", "fits as number 2, for 6.00 m in all"),
        Reason("r_1", "unreachable", "there is no way to it"),
    )
    assert d.reasons == (
        Reason("r_0", "unreachable", "there is no way along its route"),
        Reason("r_1", "not-chosen", "fits as number 1, for 5.00 m in all"),
    )


def test_alternatives_have_no_objective_while_another_route_lacks_a_way():
    assert alternatives(problem(), A_THEN_B, 2)[0] == Alternative("r_0", 2, 6.0, None)
    assert alternatives(problem(), A_THEN_B, 3)[1] == Alternative("r_1", 1, None, None)


def test_a_task_without_which_its_route_lacks_a_way():
    assert alternatives(problem(), [[0, 2, 1], []], 2)[0] == Alternative("r_0", 2, 6.0, None)
