"""Greedy task allocation against the printed tables of the TCF thesis, sequences and values."""

import pytest

import muster

UNCONSTRAINED = ("prerequisites", "suitability", "skills", "capacity")
PREREQUISITES_ONLY = ("suitability", "skills", "capacity")
SUITABILITY_ONLY = ("prerequisites", "capacity")
ALL_RULES = ()
ALL_BUT_CAPACITY = ("capacity",)

# Table, mission, rules ignored, sequences, usages, C, F. Misprints of the tables are put right: 3.17, 3R44-3R26, r_0.
PRINTED = [
    (
        "3.5", "31T-6R", UNCONSTRAINED,
        [[6, 13, 12, 11, 20, 2, 1], [9, 19, 29], [5, 15, 23, 16], [26, 25, 27], [18, 7, 17, 3, 22, 4, 14, 0, 30],
         [10, 8, 21, 24, 28]],
        [21.93, 33.06, 41.96, 28.27, 34.19, 40.03], 199.43, 241.39,
    ),
    (
        "3.5", "16T-3R", UNCONSTRAINED,
        [[6, 7, 8, 3, 2], [13, 12, 14, 15, 5, 1, 0], [9, 10, 11, 4]],
        [83.94, 105.30, 70.17], 259.41, 364.71,
    ),
    (
        "3.5", "24T-5R", UNCONSTRAINED,
        [[5, 4, 20, 1], [13, 3, 2, 12], [16, 6, 18, 10, 23, 19, 9], [22, 7, 11, 17], [0, 14, 15, 8, 21]],
        [33.452, 24.27, 35.541, 30.49, 28.41], 152.163, 187.704,
    ),
    (
        "3.8", "31T-6R", PREREQUISITES_ONLY,
        [[6, 20, 27, 1], [19, 15, 30], [28, 18, 9, 3, 22, 14], [26, 25, 17, 7, 10, 8, 16], [4, 23, 12, 13, 11, 2, 0],
         [21, 24, 29, 5]],
        [36.12, 37.55, 34.70, 47.87, 34.38, 38.62], 229.25, 277.12,
    ),
    (
        "3.8", "16T-3R", PREREQUISITES_ONLY,
        [[13, 12, 14, 11, 10, 4, 2], [5, 15, 6, 0], [7, 8, 3, 9, 1]],
        [98.18, 85.73, 89.78], 273.68, 371.87,
    ),
    (
        "3.8", "24T-5R", PREREQUISITES_ONLY,
        [[16, 6, 23, 18], [3, 2, 12, 1, 21, 8], [10, 11, 22, 5, 20], [4, 17, 7, 13], [19, 14, 15, 9, 0]],
        [28.91, 44.10, 39.68, 38.94, 35.02], 186.66, 230.76,
    ),
    (
        "3.13", "31T-6R-as-run", SUITABILITY_ONLY,
        [[9, 5, 15, 16], [6, 12, 2, 25, 28], [10, 8, 21, 24, 19], [26, 13, 11, 20, 1, 27], [17, 4, 0, 30, 29],
         [18, 7, 3, 22, 14, 23]],
        [36.69, 51.94, 21.43, 39.29, 54.13, 17.89], 221.39, 275.53,
    ),
    (
        "3.13", "16T-3R", SUITABILITY_ONLY,
        [[6, 7, 8, 9, 10, 4, 3], [0, 1, 2], [13, 12, 14, 15, 5, 11]],
        [111.19, 99.16, 48.68], 259.03, 370.22,
    ),
    (
        "3.13", "24T-5R", SUITABILITY_ONLY,
        [[5, 4, 17, 2, 12], [13, 3, 20, 7], [19, 23, 10, 18, 11], [22, 16, 6, 14, 1], [0, 21, 8, 15, 9]],
        [49.09, 29.97, 27.42, 45.08, 32.26], 183.83, 232.91,
    ),
    (
        "3.17", "31T-6R50-as-run", ALL_RULES,
        [[20, 11, 13, 1], [25, 27], [19, 0, 2], [26, 15, 30], [6, 4, 23, 12, 28], [21, 24, 3, 17, 7, 18]],
        [26.62, 29.69, 26.77, 35.42, 48.21, 30.59], 197.32, 245.53,
    ),
    (
        "3.17", "31T-3R44-3R26-as-run", ALL_RULES,
        [[20, 11, 13, 30], [25, 27], [19, 12, 1], [26, 15, 3], [6, 4, 23, 0, 2], [21, 24]],
        [37.71, 29.69, 32.95, 23.98, 23.51, 16.13], 163.98, 201.69,
    ),
    (
        "3.17", "31T-2R65-4R25-as-run", ALL_RULES,
        [[20, 11, 13], [25, 27, 2, 16], [19, 0], [26, 15, 1], [6, 4, 23, 12, 30, 14], [21, 24, 5]],
        [19.57, 57.37, 24.96, 24.37, 47.35, 21.35], 194.98, 252.35,
    ),
    ("6.8", "6T-2R", UNCONSTRAINED, [[2, 0, 5], [4, 1, 3]], [8.23, 9.81], 18.04, 27.85),
]  # fmt: skip

# Mission, rules ignored, C, F: known by recomputation with the same rules, not printed.
RECOMPUTED = [
    ("eil51-5-thesis", ALL_RULES, 632.94, 799.22),  # F is printed, in Table 3.2
    ("eil51-5", ALL_RULES, 661.19, 819.08),
    ("eil51-3-thesis", ALL_RULES, 596.19, 819.37),
    ("eil51-7-thesis", ALL_RULES, 723.11, 849.31),
    ("berlin52-5-thesis", ALL_RULES, 11282.06, 14690.39),
    ("eil76-7-thesis", ALL_RULES, 980.36, 1144.49),
    ("31T-6R-as-run", ALL_BUT_CAPACITY, 267.68, 321.63),
    ("16T-3R", ALL_RULES, 305.87, 436.16),
    ("24T-5R", ALL_RULES, 206.31, 252.58),
    ("11T-2R", ALL_RULES, 18.540, 27.822),
]

# Table 3.21, MinCost: C, C + max u, equality index.
MIN_COST = [("31T-6R", 160.40, 234.82, 0.42), ("16T-3R", 239.04, 478.08, 0.33), ("24T-5R", 146.57, 182.85, 0.83)]

# The thesis prints two digits, rounded or cut off.
PRINTED_TO = 0.011


@pytest.mark.parametrize(
    ("table", "name", "ignore", "sequences", "usages", "total", "f"), PRINTED, ids=[f"{p[0]}-{p[1]}" for p in PRINTED]
)
def test_printed_sequences_and_values(table, name, ignore, sequences, usages, total, f):
    mission = muster.load(name)
    plan = muster.solve(mission, "greedy", ignore=ignore)
    verdict = muster.verify(mission, plan, ignore)
    assert verdict.valid
    assert [[int(task) for task in route.tasks] for route in plan.routes] == sequences
    assert [route.usage for route in verdict.routes] == pytest.approx(usages, abs=PRINTED_TO)
    assert verdict.total_cost == pytest.approx(total, abs=PRINTED_TO)
    assert verdict.value("total+max") == pytest.approx(f, abs=PRINTED_TO)


@pytest.mark.parametrize(("name", "ignore", "total", "f"), RECOMPUTED, ids=[r[0] for r in RECOMPUTED])
def test_recomputed_values(name, ignore, total, f):
    mission = muster.load(name)
    verdict = muster.verify(mission, muster.solve(mission, "greedy", ignore=ignore), ignore)
    assert verdict.valid
    assert (verdict.total_cost, verdict.value("total+max")) == pytest.approx((total, f), abs=PRINTED_TO)


@pytest.mark.parametrize(("name", "total", "f", "equality"), MIN_COST, ids=[m[0] for m in MIN_COST])
def test_min_cost(name, total, f, equality):
    mission = muster.load(name)
    plan = muster.solve(mission, "greedy", ignore=UNCONSTRAINED, objective="total")
    verdict = muster.verify(mission, plan, UNCONSTRAINED, "total")
    assert verdict.value() == verdict.total_cost == pytest.approx(total, abs=PRINTED_TO)
    assert verdict.value("total+max") == pytest.approx(f, abs=PRINTED_TO)
    assert verdict.equality_index == pytest.approx(equality, abs=0.006)


def test_ties_go_to_the_lowest_task_then_the_lowest_robot():
    mission = muster.Mission(
        robots=tuple(muster.Robot(id=name, position=(0, 0)) for name in ("firefly2", "firefly10", "firefly1")),
        tasks=(muster.Task(id="10", position=(3, 0)), muster.Task(id="9", position=(-3, 0))),
    )
    plan = muster.solve(mission, "greedy")
    assert {route.robot: route.tasks for route in plan.routes} == {
        "firefly1": ("9",),
        "firefly10": ("10",),
        "firefly2": (),
    }


def test_a_task_with_more_or_nearer_dependants_is_preferred():
    """Figure 3.2: (a) a task with three dependants before a nearer one without; (b) of two equally far, the one whose
    dependants are nearer."""
    robots = (muster.Robot(id="r_0", position=(0, 0)),)

    def chosen_first(first, second, *dependants):
        tasks = [muster.Task(id="1", position=first), muster.Task(id="2", position=second)]
        tasks += [
            muster.Task(id=str(number), position=position, prerequisites=(of,))
            for number, (of, position) in enumerate(dependants, start=3)
        ]
        (route,) = muster.solve(muster.Mission(robots=robots, tasks=tuple(tasks)), "greedy").routes
        return route.tasks[0]

    near_second = [("2", (1.3, 0.1)), ("2", (1.3, -0.1)), ("2", (1.4, 0))]
    assert chosen_first((-1, 0), (1.2, 0)) == "1"
    assert chosen_first((-1, 0), (1.2, 0), *near_second) == "2"
    far_from_first = [("1", (-4, 1)), ("1", (-4, -1)), ("1", (-5, 0))]
    assert chosen_first((-1.2, 0), (1.2, 0), *far_from_first, *near_second) == "2"
