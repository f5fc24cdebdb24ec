"""Each kind of violation: a plan that has this one and no other, and its neighbour that has none."""

import math

import pytest

from muster.mission.errors import ParameterError
from muster.mission.model import Action, Map, Mission, Robot, Rules, Task, TravelTable
from muster.mission.plan import Plan, Route, Unassigned
from muster.verification import Verdict, Violation, verify
from muster.verification.verdict import KINDS


def judge(mission: Mission, *routes: tuple[str, list[str]], ignore=(), **plan) -> Verdict:
    stated = Plan(routes=tuple(Route(robot, tuple(tasks)) for robot, tasks in routes), **plan)
    return verify(mission, stated, ignore)


def found(verdict: Verdict) -> list[tuple[str, str | None, str | None]]:
    assert verdict.valid == (not verdict.violations)
    assert all(violation.kind in KINDS and violation.detail for violation in verdict.violations)
    return [(violation.kind, violation.robot, violation.task) for violation in verdict.violations]


def pair(*tasks: Task, **rules) -> Mission:
    """Robots r and s at 0, and tasks 1 m and 2 m away, unless others are given."""
    default = (Task(id="a", position=(1, 0)), Task(id="b", position=(2, 0)))
    robots = (Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 0)))
    return Mission(rules=Rules(**rules), robots=robots, tasks=tasks or default)


def test_a_good_plan_has_none():
    assert found(judge(pair(), ("r", ["a"]), ("s", ["b"]))) == []


def test_unknown_robot():
    verdict = judge(pair(), ("t", ["a"]), ("s", ["b"]))
    assert found(verdict) == [("unknown-robot", "t", None)]
    assert verdict.tasks_completed == 1


def test_unknown_task():
    verdict = judge(pair(), ("r", ["a", "z", "b"]))
    assert found(verdict) == [("unknown-task", "r", "z")]
    assert verdict.routes[0].tasks == ("a", "b")
    assert verdict.total_cost == 2


def test_repeated_robot():
    verdict = judge(pair(), ("r", ["a"]), ("s", []), ("r", ["b"]))
    assert found(verdict) == [("repeated-robot", "r", None)]
    assert verdict.routes[0].tasks == ("a",)


@pytest.mark.parametrize("second", ["r", "s"])
def test_repeated_task(second):
    routes = {"r": ["a", "b"], "s": []}
    routes[second].append("a")
    verdict = judge(pair(), *routes.items())
    assert found(verdict) == [("repeated-task", second, "a")]
    assert "route of r" in verdict.violations[0].detail
    assert verdict.tasks_completed == 2
    assert verdict.total_cost == 2


def test_skill():
    mission = Mission(
        robots=(
            Robot(id="r", position=(0, 0), skills=("camera",)),
            Robot(id="s", position=(0, 0), skills=("gripper",)),
        ),
        tasks=(Task(id="a", position=(1, 0), requires=("gripper",)), Task(id="b", position=(1, 0))),
    )
    assert found(judge(mission, ("r", ["a", "b"]))) == [("skill", "r", "a")]
    assert found(judge(mission, ("s", ["a", "b"]))) == []
    assert found(judge(mission, ("r", ["a", "b"]), ignore=("skills",))) == []


def test_suitability():
    mission = Mission(
        suitability={"beta": {"D": 0.64, "E": 0.65}, "tau": {"D": 1, "F": 1}},
        robots=(Robot(id="r", position=(0, 0), type="beta"), Robot(id="s", position=(0, 0), type="tau")),
        tasks=tuple(Task(id=kind.lower(), position=(1, 0), type=kind) for kind in "DEF"),
    )
    assert found(judge(mission, ("r", ["e"]), ("s", ["d", "f"]))) == []
    assert found(judge(mission, ("r", ["d", "e"]), ("s", ["f"]))) == [("suitability", "r", "d")]
    # a task type that is missing from a row scores 0
    assert found(judge(mission, ("s", ["d", "e"]))) == [("suitability", "s", "e")]
    assert found(judge(mission, ("s", ["d", "e"]), ignore=("suitability",))) == []


def test_no_score_is_needed_where_the_least_is_zero():
    mission = Mission(
        rules=Rules(min_suitability=0),
        suitability={"beta": {"D": 0.5}},
        robots=(Robot(id="r", position=(0, 0), type="beta"),),
        tasks=(Task(id="d", position=(1, 0), type="D"),),
    )
    assert found(judge(mission, ("r", ["d"]))) == []


def test_lock():
    mission = pair(Task(id="a", position=(1, 0), only_robots=("s",)))
    assert found(judge(mission, ("r", ["a"]))) == [("lock", "r", "a")]
    assert found(judge(mission, ("s", ["a"]))) == []
    others = ("prerequisites", "suitability", "skills", "capacity")
    assert found(judge(mission, ("r", ["a"]), ignore=others)) == [("lock", "r", "a")]
    assert found(judge(mission, ("r", ["a"]), ignore=("lock",))) == []


def island(**rules) -> Mission:
    """From the start to a 1 m, a to b 2 m, back from a 4 m; nothing leads to b but from a, and nothing leads from b."""
    inf = math.inf
    table = TravelTable(("r", "a", "b"), ((0, 1, inf), (4, 0, 2), (inf, inf, 0)))
    return Mission(
        rules=Rules(travel="matrix", **rules),
        travel={"beta": "beta.csv"},
        travel_tables={"beta": table},
        robots=(Robot(id="r", position=(0, 0), type="beta"),),
        tasks=(Task(id="a", position=(0, 0), actuation_cost=0.5), Task(id="b", position=(0, 0), actuation_cost=0.25)),
    )


def test_unreachable_task():
    verdict = judge(island(), ("r", ["b"]))
    assert found(verdict) == [("unreachable", "r", "b")]
    assert (verdict.total_cost, verdict.makespan_s) == (0.25, 0.25)  # the leg is left out of the figures
    assert found(judge(island(), ("r", ["b", "a"]))) == [("unreachable", "r", "b"), ("unreachable", "r", "a")]
    assert judge(island(), ("r", ["a", "b"])).value() == 2 * 3.75


def test_unreachable_end():
    verdict = judge(island(return_to_start=True), ("r", ["a", "b"]))
    assert found(verdict) == [("unreachable", "r", None)]
    assert verdict.total_cost == 3.75
    assert judge(island(return_to_start=True), ("r", ["a"])).total_cost == 5.5


def loaded(capacity: float, reserve: float = 0) -> Mission:
    return Mission(
        rules=Rules(capacity_reserve=reserve, return_to_start=True),
        robots=(Robot(id="r", position=(0, 0), work_capacity=capacity),),
        tasks=(Task(id="a", position=(3, 4), actuation_cost=2),),
    )


@pytest.mark.parametrize(
    ("capacity", "reserve", "holds"),
    [
        (12, 0, True),
        (11.999, 0, False),
        (12 - 1e-9, 0, True),  # within 1e-9 relative
        (12 - 1e-7, 0, False),
        (20, 0.4, True),
        (20, 0.41, False),
        (0, 0, False),
    ],
)
def test_capacity(capacity, reserve, holds):
    verdict = judge(loaded(capacity, reserve), ("r", ["a"]))
    assert found(verdict) == ([] if holds else [("capacity", "r", None)])
    assert found(judge(loaded(capacity, reserve), ("r", []))) == []
    assert found(judge(loaded(capacity, reserve), ("r", ["a"]), ignore=("capacity",))) == []


def test_prerequisite():
    tasks = (
        Task(id="a", position=(1, 0), prerequisites=("b", "c")),
        Task(id="b", position=(1, 0)),
        Task(id="c", position=(1, 0)),
    )
    assert found(judge(pair(*tasks), ("r", ["b", "a"]))) == [("prerequisite", "r", "a")]
    assert found(judge(pair(*tasks), ("r", ["a"]))) == [("prerequisite", "r", "a")] * 2
    assert found(judge(pair(*tasks), ("r", ["a"]), ignore=("prerequisites",))) == []
    assert found(judge(pair(*tasks), ("r", ["a"]), ("s", ["b", "c"]))) == []
    # a route that nobody drives does no prerequisites
    ghost = judge(pair(*tasks), ("r", ["b", "a"]), ("ghost", ["c"]))
    assert found(ghost) == [("unknown-robot", "ghost", None), ("prerequisite", "r", "a")]


def left_out(*names: str) -> tuple[Unassigned, ...]:
    return tuple(Unassigned(name, ()) for name in names)


@pytest.mark.parametrize(
    ("routes", "plan", "expected"),
    [
        # a plan from elsewhere need not say what it leaves out
        ([("r", ["a"])], {}, []),
        ([("r", ["a"])], {"unassigned": left_out("b")}, []),
        ([("r", ["a"])], {"unassigned": left_out("a", "b")}, [("unassigned", "r", "a")]),
        ([("r", [])], {"unassigned": left_out("b")}, [("unassigned", None, "a")]),
        ([("r", ["a"])], {"unassigned": left_out("b", "b")}, [("unassigned", None, "b")]),
        ([("r", ["a"])], {"unassigned": left_out("b", "z")}, [("unknown-task", None, "z")]),
        ([("r", ["a"])], {"tasks_completed": 1}, [("unassigned", None, "b")]),
        ([("r", ["a"])], {"total_cost": 1.0}, [("unassigned", None, "b")]),
        ([("r", ["a", "b"])], {"tasks_completed": 2}, []),
        # the list and the routes agree, whoever the routes are for
        ([("t", ["a"])], {"unassigned": left_out("b")}, [("unknown-robot", "t", None)]),
    ],
)
def test_unassigned(routes, plan, expected):
    assert found(judge(pair(), *routes, **plan)) == expected


def test_a_stated_usage_asks_for_the_list_of_tasks_left_out():
    plan = Plan(routes=(Route("r", ("a",), 1.0),))
    assert found(verify(pair(), plan)) == [("unassigned", None, "b")]


def test_many_violations_come_in_order_and_as_json():
    mission = Mission(
        robots=(Robot(id="r", position=(0, 0), work_capacity=1), Robot(id="s", position=(0, 0))),
        tasks=(
            Task(id="a", position=(2, 0), requires=("x",), only_robots=("s",), prerequisites=("c",)),
            Task(id="b", position=(1, 0), prerequisites=("a",)),
            Task(id="c", position=(1, 0)),
        ),
    )
    verdict = judge(mission, ("q", []), ("r", ["b", "a", "?"]), total_cost=4.0)
    assert found(verdict) == [
        ("unknown-robot", "q", None),
        ("unknown-task", "r", "?"),
        ("skill", "r", "a"),
        ("lock", "r", "a"),
        ("prerequisite", "r", "a"),
        ("capacity", "r", None),
        ("deadlock", None, None),
        ("unassigned", None, "c"),
        ("figure", None, None),
    ]
    data = verdict.as_dict()
    assert (data["valid"], data["objective"], data["makespan_s"]) == (False, 4, None)
    assert (data["total_cost"], data["max_usage"]) == (2, 2)
    assert data["violations"][1] == {
        "kind": "unknown-task",
        "robot": "r",
        "task": "?",
        "detail": "no task of the mission",
    }


def test_details_are_sentences_with_the_numbers():
    verdict = judge(loaded(11), ("r", ["a"]))
    assert verdict.violations == (Violation("capacity", "r", None, "usage 12 m, at most 11 m"),)


def test_a_map_beside_euclidean_travel_and_plain_actions_are_judged():
    mission = Mission(
        map=Map(boundary=((0, 0), (9, 0), (9, 9))),
        rules=Rules(travel="euclidean"),
        robots=(Robot(id="r", position=(0, 0)),),
        tasks=(Task(id="a", position=(1, 0), action=Action(name="go-to-goal"), actuation_cost=2),),
    )
    assert judge(mission, ("r", ["a"])).total_cost == 3


def test_unknown_words_of_the_caller_are_refused():
    with pytest.raises(ParameterError, match=r"locks.*did you mean 'lock'"):
        judge(pair(), ignore=("locks",))
    with pytest.raises(ParameterError, match="shortest"):
        verify(pair(), Plan(routes=()), objective="shortest")


def test_a_plan_cannot_excuse_itself():
    """Rules are ignored by the caller alone, whatever the plan says of itself."""
    mission = loaded(11)
    assert found(judge(mission, ("r", ["a"]), ignored=("capacity",))) == [("capacity", "r", None)]
    verdict = judge(mission, ("r", ["a"]), ignored=("capacity",), ignore=("capacity",))
    assert (verdict.valid, verdict.ignored, verdict.as_dict()["ignored"]) == (True, ("capacity",), ["capacity"])
    assert judge(loaded(12), ("r", ["a"]), ignored=("capacity",)).valid, "it does not need it"


@pytest.mark.parametrize("name", ["total", "shortest"])
def test_the_objective_is_the_missions_unless_the_caller_names_another(name):
    assert found(judge(pair(), ("r", ["a"]), objective=name)) == [("objective", None, None)]
    plan = Plan(objective="total", objective_value=3.0, routes=(Route("r", ("a",)), Route("s", ("b",))))
    verdict = verify(pair(), plan, objective="total")
    assert (verdict.valid, verdict.objective_name, verdict.value()) == (True, "total", 3)
    assert found(verify(pair(), plan, objective="max")) == [("objective", None, None)]


@pytest.mark.parametrize(("named", "refused"), [("pair", False), (None, False), ("other", True)])
def test_a_plan_that_names_another_mission(named, refused):
    mission = Mission(name="pair", robots=(Robot(id="r", position=(0, 0)),), tasks=(Task(id="a", position=(1, 0)),))
    found = verify(mission, Plan(mission=named, routes=(Route("r", ("a",)),))).violations
    said = Violation("mission", None, None, "the plan is of other; expected pair, or no name")
    assert found == ((said,) if refused else ())
