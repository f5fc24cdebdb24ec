"""Tasks that can never be done: which, and why."""

import json
from dataclasses import replace
from itertools import permutations

import pytest
from hypothesis import assume, given
from tests.mission.strategies import examples, tiny_missions

from muster.allocation.bounds.feasibility import impossible
from muster.cli.main import run
from muster.mission.model import Mission, Robot, Rules, Task, TravelTable
from muster.mission.plan import Plan, Route
from muster.model.problem import Problem
from muster.verification import verify


def lost(mission, *ignored):
    """The impossible tasks, each with the reason of every robot."""
    found = impossible(Problem.compile(mission, ignored=ignored))
    return {item.task: {reason.robot: reason.reason for reason in item.reasons} for item in found}


def details(mission):
    return {item.task: {r.robot: r.detail for r in item.reasons} for item in impossible(Problem.compile(mission))}


def mission(robots, tasks, rules=None, **keys):
    return Mission(robots=tuple(robots), tasks=tuple(tasks), rules=rules or Rules(), **keys)


def robot(name="r_0", position=(0, 0), **keys):
    return Robot(id=name, position=position, **keys)


def task(name, x, y=0, **keys):
    return Task(id=name, position=(x, y), **keys)


# --- no robot may do it ----------------------------------------------------------------------------------------------


def test_skill():
    team = [robot("r_0", skills=("camera",)), robot("r_1")]
    work = [task("look", 1, requires=("camera",)), task("lift", 2, requires=("camera", "gripper"))]
    assert lost(mission(team, work)) == {"lift": {"r_0": "skill", "r_1": "skill"}}
    assert details(mission(team, work)) == {"lift": {"r_0": "lacks gripper", "r_1": "lacks camera, gripper"}}
    assert lost(mission(team, work), "skills") == {}


def test_skills_of_two_robots_do_not_add_up():
    team = [robot("r_0", skills=("camera",)), robot("r_1", skills=("gripper",))]
    assert "both" in lost(mission(team, [task("both", 1, requires=("camera", "gripper"))]))


def test_suitability():
    table = {"beta": {"D": 0.9, "E": 0.6}, "tau": {"D": 0.65}}
    team = [robot("r_0", type="beta"), robot("r_1", type="tau")]
    asked = mission(team, [task("1", 1, type="D"), task("2", 2, type="E")], suitability=table)
    assert lost(asked) == {"2": {"r_0": "suitability", "r_1": "suitability"}}
    assert details(asked)["2"] == {
        "r_0": "type beta scores 0.6 for E, below 0.65",
        "r_1": "type tau scores 0 for E, below 0.65",
    }
    assert lost(asked, "suitability") == {}
    assert lost(replace(asked, rules=Rules(min_suitability=0.6))) == {}


def test_least_suitability_of_0_allows_a_type_that_is_missing_from_a_row():
    table = {"beta": {"D": 0.9}, "tau": {"E": 0.9}}
    asked = mission([robot(type="beta")], [task("1", 1, type="E")], suitability=table)
    assert lost(asked) == {"1": {"r_0": "suitability"}}
    assert lost(replace(asked, rules=Rules(min_suitability=0))) == {}


def test_lock_on_a_robot_that_may_not_do_it():
    team = [robot("r_0"), robot("r_1", skills=("camera",))]
    asked = mission(team, [task("1", 1, requires=("camera",), only_robots=("r_0",))])
    assert lost(asked) == {"1": {"r_0": "skill", "r_1": "lock"}}
    assert details(asked)["1"]["r_1"] == "only r_0 may do it"
    assert lost(asked, "prerequisites", "suitability", "capacity") == lost(asked)
    assert lost(asked, "skills") == {}


# --- out of every robot's reach --------------------------------------------------------------------------------------


def test_capacity():
    team = [robot("r_0", work_capacity=9.9), robot("r_1", (2, 0), work_capacity=7.9)]
    asked = mission(team, [task("near", 4, actuation_cost=4), task("far", 10)])
    assert lost(asked) == {"far": {"r_0": "capacity", "r_1": "capacity"}}
    assert details(asked)["far"] == {
        "r_0": "takes at least 10.00 m, of 9.90 m",
        "r_1": "takes at least 8.00 m, of 7.90 m",
    }
    assert lost(asked, "capacity") == {}
    assert lost(replace(asked, robots=(*asked.robots, robot("r_2")))) == {}


def test_actuation_cost_counts():
    asked = mission([robot(work_capacity=9)], [task("1", 4, actuation_cost=5), task("2", 4, actuation_cost=5.01)])
    assert lost(asked) == {"2": {"r_0": "capacity"}}


def test_capacity_of_0_is_enough_where_the_robot_stands():
    assert lost(mission([robot(work_capacity=0)], [task("here", 0), task("there", 1)])) == {
        "there": {"r_0": "capacity"}
    }


def test_a_capacity_that_is_filled_exactly_is_enough():
    """2.2 + 1.1 is above 3.3 in float64 by its last bit; the judge takes the plan."""
    asked = mission([robot(work_capacity=3.3)], [task("1", 2.2, actuation_cost=1.1)])
    assert verify(asked, Plan(routes=(Route("r_0", ("1",)),))).valid
    assert lost(asked) == {}


@pytest.mark.parametrize(
    ("keys", "rules"),
    [
        ({}, Rules(return_to_start=True)),
        ({"return_to_start": True}, Rules()),
        ({"end_position": (0, 0)}, Rules()),
        ({"end_position": (0, 0), "return_to_start": False}, Rules()),
    ],
)
def test_the_way_back_counts(keys, rules):
    work = [task("near", 4), task("far", 6)]
    assert lost(mission([robot(work_capacity=10)], work)) == {}
    assert lost(mission([robot(work_capacity=10, **keys)], work, rules)) == {"far": {"r_0": "capacity"}}


def test_a_robot_that_need_not_return_though_the_others_must():
    team = [robot("r_0", work_capacity=10), robot("r_1", work_capacity=10, return_to_start=False)]
    assert lost(mission(team, [task("far", 6)], Rules(return_to_start=True))) == {}


def test_the_end_position_is_stronger_than_the_way_back():
    team = [robot(work_capacity=10, end_position=(9, 0), return_to_start=True)]
    assert lost(mission(team, [task("on the way", 6)], Rules(return_to_start=True))) == {}


def test_capacity_reserve():
    work = [task("1", 7.5), task("2", 7.6)]
    asked = mission([robot(work_capacity=10)], work, Rules(capacity_reserve=0.25))
    assert lost(asked) == {"2": {"r_0": "capacity"}}
    assert details(asked)["2"]["r_0"] == "takes at least 7.60 m, of 7.50 m"


def test_usage_in_seconds():
    team = [robot("slow", work_capacity=10, speed_mps=0.5), robot("fast", (0, 8), work_capacity=10, speed_mps=2)]
    work = [task("1", 8), task("2", 16), task("3", 4, duration_s=11), task("4", 4, duration_s=2)]
    asked = mission(team, work, Rules(usage="time"))
    assert lost(asked) == {
        "3": {"slow": "capacity", "fast": "capacity"},
    }
    assert details(asked)["3"]["slow"] == "takes at least 19.00 s, of 10.00 s"
    assert lost(replace(asked, robots=asked.robots[:1])) == {
        name: {"slow": "capacity"} for name in ("1", "2", "3")
    }  # 16 s, 32 s, 19 s; the fourth fills the capacity: 8 s and 2 s


def test_efficiency_counts_in_seconds_alone():
    work = [task("1", 4, duration_s=5)]
    for efficiency, found in ((1, {}), (0.5, {"1": {"r_0": "capacity"}})):
        team = [robot(work_capacity=10, efficiency=efficiency)]
        assert lost(mission(team, work, Rules(usage="time"))) == found
        assert lost(mission(team, work)) == {}


@pytest.mark.parametrize(
    ("work", "found"),
    [
        (task("1", 50, entry=(4, 0), exit=(6, 0)), {}),
        (task("1", 4, entry=(6, 0), exit=(6, 0)), {"1": {"r_0": "capacity"}}),
        (task("1", 1, exit=(9.5, 0)), {"1": {"r_0": "capacity"}}),
        (task("1", 9.5, entry=(1, 0)), {"1": {"r_0": "capacity"}}),
    ],
)
def test_the_way_goes_to_the_entry_and_home_from_the_exit(work, found):
    assert lost(mission([robot(work_capacity=10, return_to_start=True)], [work])) == found


def test_a_task_is_in_reach_through_another_one_that_ends_elsewhere():
    """A search that is entered near the start and left near the far task brings the robot there."""
    team = [robot(work_capacity=10)]
    search, far = task("search", 3, entry=(1, 0), exit=(20, 0), actuation_cost=2), task("far", 21)
    assert lost(mission(team, [far])) == {"far": {"r_0": "capacity"}}
    assert lost(mission(team, [search, far])) == {}
    forbidden = replace(search, requires=("camera",))
    assert set(lost(mission(team, [forbidden, far]))) == {"search", "far"}


def test_a_way_back_through_another_task():
    team = [robot(work_capacity=25, return_to_start=True)]
    lift, far = task("lift", 20, entry=(21, 0), exit=(1, 0)), task("far", 20)
    assert lost(mission(team, [far])) == {"far": {"r_0": "capacity"}}
    assert lost(mission(team, [lift, far])) == {}


# --- travel tables ---------------------------------------------------------------------------------------------------

INF = float("inf")


def tabled(metres, tasks, **keys):
    """One robot `r_0` and tasks whose ways are in a table."""
    table = TravelTable(("r_0", *(one.id for one in tasks)), metres)
    return Mission(
        robots=(robot(type="beta", **keys),),
        tasks=tuple(tasks),
        rules=Rules(travel="matrix"),
        travel={"beta": "beta.csv"},
        travel_tables={"beta": table},
    )


def test_no_way_there():
    asked = tabled(((0, 1, INF), (1, 0, INF), (1, 1, 0)), [task("1", 1), task("2", 1)])
    assert lost(asked) == {"2": {"r_0": "unreachable"}}
    assert details(asked) == {"2": {"r_0": "there is no way to it"}}
    assert lost(asked, "prerequisites", "suitability", "skills", "capacity") == lost(asked)


def test_no_way_back():
    ways = ((0, 1, 1), (1, 0, 1), (INF, INF, 0))
    assert lost(tabled(ways, [task("1", 1), task("2", 1)])) == {}
    assert lost(tabled(ways, [task("1", 1), task("2", 1)], return_to_start=True)) == {"2": {"r_0": "unreachable"}}


def test_a_way_through_another_task_where_there_is_none_straight():
    ways = ((0, 3, INF), (3, 0, 4), (INF, 4, 0))
    work = [task("1", 1, actuation_cost=1), task("2", 1)]
    assert lost(tabled(ways, work, work_capacity=8)) == {}
    assert lost(tabled(ways, work, work_capacity=7.9)) == {"2": {"r_0": "capacity"}}
    assert lost(tabled(ways, [replace(work[0], requires=("camera",)), work[1]])) == {
        "1": {"r_0": "skill"},
        "2": {"r_0": "unreachable"},
    }


def test_ways_that_differ_by_direction():
    ways = ((0, 2), (9, 0))
    assert lost(tabled(ways, [task("1", 1)], work_capacity=10)) == {}
    assert lost(tabled(ways, [task("1", 1)], work_capacity=10, return_to_start=True)) == {"1": {"r_0": "capacity"}}


def test_each_type_of_robot_has_its_table():
    places = ("r_0", "r_1", "1")
    near, none = ((0, 0, 1),) * 3, ((0, 0, INF), (0, 0, INF), (0, 0, 0))
    asked = Mission(
        robots=(robot("r_0", type="beta"), robot("r_1", type="tau", work_capacity=0.5)),
        tasks=(task("1", 1),),
        rules=Rules(travel="matrix"),
        travel={"beta": "beta.csv", "tau": "tau.csv"},
        travel_tables={"beta": TravelTable(places, none), "tau": TravelTable(places, near)},
    )
    assert lost(asked) == {"1": {"r_0": "unreachable", "r_1": "capacity"}}


# --- lost with a prerequisite ----------------------------------------------------------------------------------------


def test_what_waits_for_an_impossible_task_is_lost_with_it():
    work = [
        task("end", 1, prerequisites=("middle", "free")),
        task("middle", 1, prerequisites=("begin",)),
        task("begin", 1, requires=("camera",)),
        task("free", 1),
        task("waits for free", 1, prerequisites=("free",)),
    ]
    asked = mission([robot()], work)
    assert lost(asked) == {
        "end": {"r_0": "prerequisite"},
        "middle": {"r_0": "prerequisite"},
        "begin": {"r_0": "skill"},
    }  # in mission order
    assert list(lost(asked)) == ["end", "middle", "begin"]
    assert details(asked)["end"]["r_0"] == "middle comes before it and can never be done"
    assert list(lost(asked, "prerequisites")) == ["begin"]
    assert lost(asked, "skills") == {}


def test_a_robot_that_may_not_do_it_anyway_has_that_reason():
    team = [robot("r_0"), robot("r_1", skills=("camera",))]
    work = [
        task("first", 1, only_robots=("r_0",), requires=("camera",)),
        task("second", 1, requires=("camera",), prerequisites=("first",)),
    ]
    assert lost(mission(team, work))["second"] == {"r_0": "skill", "r_1": "prerequisite"}


def test_long_chain():
    work = [
        task(str(k), 1, prerequisites=(str(k - 1),) if k else (), requires=() if k else ("x",)) for k in range(3000)
    ]
    assert len(lost(mission([robot()], work))) == 3000


# --- the command -----------------------------------------------------------------------------------------------------

CHAIN = """\
schema: muster/1
name: chain
robots:
  - {id: r_0, position: [0, 0], work_capacity: 10}
tasks:
  - {id: 1, position: [4, 0]}
  - {id: 2, position: [5, 0], requires: [camera]}
  - {id: 3, position: [6, 0], prerequisites: [2]}
"""


@pytest.fixture
def chain(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "chain.yaml").write_text(CHAIN, encoding="utf-8")
    return "chain.yaml"


def test_check_names_them(chain, capsys):
    assert run(["check", chain]) == 3
    out, err = capsys.readouterr()
    assert err == ""
    words = [line.split() for line in out.splitlines() if line.strip()]
    assert " ".join(words[0]) == "chain: 1 robot, 3 tasks; 2 of 3 tasks can never be done"
    assert " ".join(words[1]) == "2 tasks that can never be done, by reason: prerequisite 1, skill 1"
    assert ["2", "r_0", "skill", "lacks", "camera"] in words
    assert ["3", "r_0", "prerequisite", "2", "comes", "before", "it", "and", "can", "never", "be", "done"] in words


def test_check_names_them_in_json(chain, capsys):
    assert run(["check", chain, "--format", "json"]) == 3
    out, err = capsys.readouterr()
    assert err == ""
    data = json.loads(out)
    keys = ("conflict", "unknown", "shortfalls", "remedies", "unseen", "blocked", "cut_off")
    assert [data.pop(key) for key in keys] == [None, False, [], [], [], [], []]
    assert data == {
        "errors": [],
        "impossible": [
            {"task": "2", "reasons": [{"robot": "r_0", "reason": "skill", "detail": "lacks camera"}]},
            {
                "task": "3",
                "reasons": [
                    {
                        "robot": "r_0",
                        "reason": "prerequisite",
                        "detail": "2 comes before it and can never be done",
                    }
                ],
            },
        ],
    }


def test_rows_are_grouped_by_reason(tmp_path, capsys):
    tasks = [f"{{id: s{k}, position: [{k}, 0], requires: [camera]}}" for k in range(30)]
    tasks += [f"{{id: l{k}, position: [{k + 1}, 0], deadline_s: {k / 100}}}" for k in range(20)]
    robots = "[{id: a, position: [-1, 0]}, {id: b, position: [-1, 0]}]"
    text = f"schema: muster/1\nname: many\nrobots: {robots}\ntasks: [{', '.join(tasks)}]"
    (tmp_path / "many.yaml").write_text(text)
    assert run(["check", str(tmp_path / "many.yaml")]) == 3
    out = capsys.readouterr().out
    assert "many: 2 robots, 50 tasks; 50 of 50 tasks can never be done" in out
    assert "by reason: skill 30, deadline 20" in " ".join(out.split())
    rows = [line.split() for line in out.splitlines()]
    assert sum("lacks camera" in line for line in out.splitlines()) == 1  # for all 30 tasks and both robots
    assert sum(row[:1] == ["..."] for row in rows) == 1
    assert "and 8 more rows; --format json has all" in " ".join(out.split())


@pytest.mark.parametrize("verb", [["check"], ["solve", "--iterations", "5"], ["solve", "-a", "greedy"]])
@pytest.mark.parametrize("form", ["table", "json"])
def test_require_complete(verb, form, chain, capsys):
    asked = [*verb, chain, "--format", form]
    assert run(asked) == (3 if verb == ["check"] else 0)
    without = capsys.readouterr().out
    assert run([*asked, "--require-complete"]) == 3
    out, err = capsys.readouterr()
    assert err == ""
    assert len(out.splitlines()) == len(without.splitlines())
    assert run([*asked, "--require-complete", "--ignore", "skills"]) == 0
    assert run([*asked, "--require-complete", "--ignore", "prerequisites"]) == 3
    assert run([*asked, "--require-complete", "--ignore", "prerequisites,skills"]) == 0


def test_nothing_impossible(capsys):
    assert run(["check", "31T-6R50", "--require-complete"]) == 0
    assert capsys.readouterr().out == "31T-6R50: 6 robots, 31 tasks; no errors\na plan for all tasks was found\n"


# --- against all plans there are -------------------------------------------------------------------------------------


def all_routes(mission):
    """Every way to give some of the tasks to robots, in every order."""
    names = [one.id for one in mission.tasks]
    for count in range(1, len(names) + 1):
        for chosen in permutations(names, count):
            if len(mission.robots) == 1:
                yield (chosen,)
            else:
                yield from ((chosen[:cut], chosen[cut:]) for cut in range(count + 1))


def in_some_admissible_plan(mission, ignored):
    """The tasks that are in a plan which the judge admits, by trying all."""
    robots = [one.id for one in mission.robots]
    done = set()
    for routes in all_routes(mission):
        tasks = {name for route in routes for name in route}
        if not tasks <= done:
            plan = Plan(routes=tuple(map(Route, robots, routes)))
            done |= tasks if verify(mission, plan, ignored).valid else set()
    return done


RULES = [(), ("capacity",), ("skills", "suitability")]


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("ignored", RULES)
@examples(70)
@given(asked=tiny_missions())
def test_an_impossible_task_is_in_no_admissible_plan(ignored, asked):
    possible = in_some_admissible_plan(asked, ignored)
    assert possible.isdisjoint(lost(asked, *ignored))


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("ignored", RULES)
@examples(70)
@given(asked=tiny_missions())
def test_without_prerequisites_and_fixed_ends_every_other_task_is_in_one(ignored, asked):
    """The shortest way to a task leads through tasks that the robot may do, none of them twice: it is a route.

    Not so where the route must end somewhere: the shortest ways there and back may lead through the same task.
    """
    free = replace(
        asked,
        rules=replace(asked.rules, return_to_start=False),
        robots=tuple(replace(one, return_to_start=None, end_position=None) for one in asked.robots),
    )
    ignored = (*ignored, "prerequisites")
    possible = in_some_admissible_plan(free, ignored)
    assert possible == {one.id for one in free.tasks} - set(lost(free, *ignored))


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("ignored", RULES)
@examples(100)
@given(asked=tiny_missions(max_tasks=6, tabled=False))
def test_where_the_straight_way_is_the_shortest_every_other_task_can_be_done_alone(ignored, asked):
    """Without prerequisites, and each task left where it is entered: the robot goes there, and on."""
    plain = replace(asked, tasks=tuple(replace(one, entry=None, exit=None, prerequisites=()) for one in asked.tasks))
    impossible_ones = lost(plain, *ignored)
    for one in plain.tasks:
        alone = [Plan(routes=(Route(r.id, (one.id,)),)) for r in plain.robots]
        assert any(verify(plain, plan, ignored).valid for plan in alone) == (one.id not in impossible_ones)


@examples(100)
@given(asked=tiny_missions(max_tasks=6, tabled=False))
def test_without_capacity_every_other_task_can_be_done_with_its_prerequisites(asked):
    """Each of them by a robot that may, in one order that all robots keep: nothing waits in a circle."""
    ignored = ("capacity",)
    impossible_ones = lost(asked, *ignored)
    assume(len(impossible_ones) < len(asked.tasks))
    by_id = {one.id: one for one in asked.tasks}
    for one in asked.tasks:
        if one.id in impossible_ones:
            continue
        needed, waiting = {one.id}, [one.id]
        while waiting:
            for name in by_id[waiting.pop()].prerequisites:
                if name not in needed:
                    needed.add(name)
                    waiting.append(name)
        routes = {r.id: [] for r in asked.robots}
        for name in sorted(needed, key=int):  # prerequisites are always among the earlier tasks
            routes[first_that_may(asked, name, ignored)].append(name)
        plan = Plan(routes=tuple(Route(r, tuple(tasks)) for r, tasks in routes.items()))
        assert verify(asked, plan, ignored).violations == ()


def first_that_may(asked, name, ignored):
    """A robot that may do the task, prerequisites aside."""
    rules = (*ignored, "prerequisites")
    plans = {r.id: Plan(routes=(Route(r.id, (name,)),)) for r in asked.robots}
    return next(r for r, plan in plans.items() if verify(asked, plan, rules).valid)
