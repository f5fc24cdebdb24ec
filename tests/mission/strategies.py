"""Random missions for Hypothesis: `missions()` has every key of the format, `plain_missions()` what a CSV can say,
`salesmen()` what TSPLIB can say, `tiny_missions()` few tasks on a small grid with every rule at work.
"""

import math
from itertools import combinations

from hypothesis import settings
from hypothesis import strategies as st

from muster.mission.model import (
    OBJECTIVES,
    Action,
    Camera,
    DelayedTask,
    Event,
    Lag,
    Lane,
    Lanes,
    Map,
    Mission,
    MovedTask,
    Origin,
    Robot,
    Rules,
    Task,
    TeamPart,
    TravelTable,
    Zone,
)


def examples(count: int) -> settings:
    """So many examples, where the profile has 100; more where it has more (`HYPOTHESIS_PROFILE=search`)."""
    assert settings.default is not None
    return settings(max_examples=max(1, count * settings.default.max_examples // 100))


TRICKY = (
    *("no", "on", "yes", "y", "off", "true", "True", "null", "~", "Null", "NULL", "nan", ".nan", ".inf", "-.inf"),
    *("1:30", "0777", "007", "0", "-0", "+5", "1e3", "1.", ".5", "1_000", "0x1F", "0o17", "12", "1.10", "2026-10-07"),
    *("-", "- a", "a: b", "a:", "a #b", "#x", "[1]", "{a}", "&a", "*a", "!t", "%d", "@x", "`", "'", '"', "a,b", "="),
    *("?", "|", ">", "\\", "é", "日本", "a b", " a", "a ", "r_0", "firefly10", "a/b", "a.b", "A+", "x" * 200, "²", "٣"),
    *("inf", "<<", "schema"),
)
"""Words that a reader or writer could take for something else."""


# Strategies are made once, here: making them anew in each example takes most of the time.

printable = st.characters(exclude_categories=("C", "Zl", "Zp", "Zs"), include_characters=" ")
words = st.one_of(
    st.integers(0, 10**17).map(str),
    st.builds("{}_{}".format, st.sampled_from(("r", "task", "firefly")), st.integers(0, 12)),
    st.sampled_from(TRICKY),
    st.text(printable, min_size=1, max_size=12).filter(lambda text: text.strip() and text.isprintable()),
)
"""Names: ids, types, skills."""

plain_words = st.text("abcxyzABC0123456789_.:+#'\"é日-", min_size=1, max_size=12)
"""Names without spaces, commas, semicolons, brackets: what survives every file."""

WORDS = {"any": words, "plain": plain_words}

numbers = st.one_of(st.integers(-50, 50).map(float), st.floats(allow_nan=False, allow_infinity=False))
not_negative = numbers.map(abs)
positive = not_negative.filter(lambda number: number > 0)
maybe_positive = st.none() | positive
shares = st.one_of(st.floats(0, 1), st.sampled_from([0.0, 0.65, 1.0]))
POINTS = {dimensions: st.tuples(*[numbers] * dimensions) for dimensions in (2, 3)}
MAYBE_POINTS = {dimensions: st.none() | point for dimensions, point in POINTS.items()}
TABLES = {
    kind: st.none()
    | st.dictionaries(names, st.dictionaries(names, shares, min_size=1, max_size=3), min_size=1, max_size=3)
    for kind, names in WORDS.items()
}
"""Suitability: 1 to 3 types of robot; rows may lack types of task that others have."""

origins = st.builds(
    Origin, lat_deg=st.floats(-90, 90), lon_deg=st.floats(-180, 180), alt_m=st.sampled_from([0.0, -3.5, 120.0])
)
all_rules = st.builds(
    Rules,
    objective=st.sampled_from(OBJECTIVES),
    usage=st.sampled_from(["distance", "time"]),
    min_suitability=shares,
    return_to_start=st.booleans(),
    travel=st.sampled_from([None, "euclidean"]),
    capacity_reserve=st.floats(0, 1, exclude_max=True),
    stability=st.none() | st.integers(0, 9),
    timing=st.sampled_from(["profile", "constant"]),
    makespan_includes_return=st.booleans(),
)
corners = st.lists(POINTS[2], min_size=3, max_size=5).map(tuple)
zones = st.lists(
    st.builds(
        Zone,
        polygon=corners,
        floor_m=st.none() | st.floats(-9, 0),
        ceiling_m=st.none() | st.floats(1, 9),
        forbidden_to=st.sampled_from([("ground",), ("air",), ("ground", "air"), ("air", "ground")]),
    ),
    max_size=2,
).map(tuple)
maps = st.one_of(
    st.builds(Map, ros_yaml=words, zones=zones),
    st.builds(Map, image=words, resolution_m=positive, origin=MAYBE_POINTS[3], zones=zones),
    st.builds(Map, boundary=corners, zones=zones),
)
skills = st.lists(words, max_size=2).map(tuple)
ACTIONS = {
    dimensions: st.one_of(
        st.just(Action(name="go-to-goal")),
        st.builds(Action, name=st.just("sensor-activation"), duration_s=not_negative),
        st.builds(Action, name=st.just("stationary-observation"), width_m=positive, heading_deg=st.none() | numbers),
        st.builds(Action, name=st.just("raster-search"), side_m=positive, height_m=positive, spacing_m=positive),
        st.builds(Action, name=st.just("ground-patrol"), side_m=positive),
        st.builds(Action, name=st.just("delivery"), pickup=point),
    )
    for dimensions, point in POINTS.items()
}
ROBOT_KEYS = {
    dimensions: st.fixed_dictionaries(
        {"position": point},
        optional={
            "work_capacity": st.none() | not_negative,
            "skills": skills,
            "speed_mps": positive,
            "efficiency": positive,
            "return_to_start": st.none() | st.booleans(),
            "end_position": MAYBE_POINTS[dimensions],
            "available_from_s": st.floats(0, 50),
            "available_until_s": st.none() | st.floats(50, 1e300),
            "abilities": st.none() | st.dictionaries(words, not_negative, min_size=1, max_size=2),
            "climb_mps": maybe_positive,
            "heading_deg": numbers,
            "radius_m": not_negative,
            "kind": st.sampled_from(["ground", "air"]),
            "kinematics": st.sampled_from(["holonomic", "differential-drive", "quadcopter", "hexacopter"]),
            "yaw_rate_radps": maybe_positive,
            "acceleration_mps2": maybe_positive,
            "avoidance_priority": not_negative,
            "camera": st.builds(Camera, fov_deg=st.floats(1, 179), tilt_deg=st.floats(-90, 90), mount=POINTS[3]),
        },
    )
    for dimensions, point in POINTS.items()
}
ends = st.lists(st.integers(0, 99), min_size=2, max_size=6, unique=True).map(sorted)
windows = st.one_of(
    st.just(()),
    st.tuples(not_negative, st.none()),
    ends.map(lambda times: tuple(zip(times[::2], times[1::2], strict=False))),
)
"""None, one that is open, or some that are apart."""

TIMES = st.fixed_dictionaries(
    {},
    optional={
        "duration_s": st.none() | not_negative,
        "window_s": windows,
        "deadline_s": st.none() | not_negative,
        "due_s": st.none() | not_negative,
        "robots_needed": st.none() | st.integers(1, 9),
    },
)
"""What a row of a task list may say besides."""

lags = st.builds(Lag, after_s=st.sampled_from([0.0, 2.5]), within_s=st.none() | st.floats(2.5, 1e9))
teams = st.one_of(
    st.just({}),
    st.just({}),
    st.builds(dict, robots_needed=st.integers(1, 4)),
    st.builds(dict, needs=st.dictionaries(words, positive, min_size=1, max_size=2)),
    st.builds(
        dict,
        team=st.lists(
            st.builds(
                TeamPart,
                count=st.integers(1, 3),
                type=st.none() | words,
                kind=st.sampled_from([None, "ground", "air"]),
                requires=skills,
            ),
            min_size=1,
            max_size=2,
        ),
    ),
)
moments = st.sampled_from([None, None, "2027-03-01T08:00:00+01:00", "2027-03-01T08:00", "2027-03-01T23:59:59.25Z"])
TASK_KEYS = {
    dimensions: st.fixed_dictionaries(
        {"position": point},
        optional={
            "actuation_cost": not_negative,
            "requires": skills,
            "duration_s": st.none() | not_negative,
            "priority": positive,
            "entry": MAYBE_POINTS[dimensions],
            "exit": MAYBE_POINTS[dimensions],
            "action": ACTIONS[dimensions],
            "across_partition": st.sampled_from(["at-least-once", "at-most-once"]),
            "window_s": windows,
            "deadline_s": st.none() | not_negative,
            "due_s": st.none() | not_negative,
        },
    )
    for dimensions, point in POINTS.items()
}
flags = st.booleans()
LANE_KEYS = st.fixed_dictionaries(
    {},
    optional={
        "both_ways": flags,
        "capacity": st.none() | st.integers(1, 5),
        "speed_mps": maybe_positive,
        "width_m": maybe_positive,
    },
)
dimension = st.sampled_from([2, 2, 3])
seldom = st.sampled_from([False, False, False, True])
robot_ids = {kind: st.lists(names, min_size=1, max_size=4, unique=True) for kind, names in WORDS.items()}
task_ids = {kind: st.lists(names, max_size=6, unique=True) for kind, names in WORDS.items()}


@st.composite
def missions(draw) -> Mission:
    """Missions with every key of the format, valid but not always sensible."""
    size = draw(dimension)
    robots, tasks = draw(robot_ids["any"]), draw(task_ids["any"])
    suitability = draw(TABLES["any"])
    robot_type, task_type = types_of(draw, suitability, words)
    work = [
        Task(
            id=name,
            type=task_type(),
            only_robots=some_of(draw, robots) or None,
            **depending(draw, tasks[:k]),
            **draw(teams),
            **consistent(draw(TASK_KEYS[size])),
        )
        for k, name in enumerate(tasks)
    ]
    return Mission(
        name=draw(words),
        origin_wgs84=draw(origins) if draw(seldom) else None,
        starts_at=draw(moments),
        rules=draw(all_rules),
        map=draw(maps) if draw(seldom) else None,
        lanes=draw(lane_graphs()) if draw(seldom) else None,
        suitability=suitability,
        robots=tuple(Robot(id=name, type=robot_type(), **draw(ROBOT_KEYS[size])) for name in robots),
        tasks=tuple(work if draw(flags) else work[::-1]),
        events=tuple(
            draw(events(size, robots, tasks, robot_type, task_type, k)) for k in range(3 if draw(seldom) else 0)
        ),
    )


@st.composite
def lane_graphs(draw) -> Lanes:
    """Lanes between a few nodes, each way once at most."""
    nodes = draw(st.dictionaries(words, st.tuples(numbers, numbers), min_size=2, max_size=4).filter(apart))
    ends = list(combinations(nodes, 2))
    some = draw(st.lists(st.sampled_from(ends), min_size=1, unique=True))
    ids = draw(st.lists(words, min_size=len(some), max_size=len(some), unique=True))
    return Lanes(
        nodes=nodes,
        edges=tuple(
            Lane(start=a, end=b, **draw(LANE_KEYS), id=name if draw(flags) else None)
            for (a, b), name in zip(some, ids, strict=True)
        ),
    )


def apart(nodes) -> bool:
    return len(set(nodes.values())) == len(nodes)


def types_of(draw, suitability, names):
    """What draws types of robots and of tasks that go with a table, or with none."""
    if suitability is None:
        return (lambda: draw(names) if draw(flags) else None,) * 2
    rows = list(suitability)
    columns = sorted({column for row in suitability.values() for column in row})
    return lambda: one_of(draw, rows), lambda: one_of(draw, columns)


def one_of(draw, items):
    return items[draw(st.integers(0, len(items) - 1))]


def some_of(draw, items) -> tuple[str, ...]:
    """None of them most of the time, otherwise some."""
    if not items or not draw(seldom):
        return ()
    return tuple(item for item in items if draw(flags))


def depending(draw, earlier):
    """Prerequisites with and without lags, and relations to others of the earlier tasks, all of which can be kept."""
    before = some_of(draw, earlier)
    related = some_of(draw, [name for name in earlier if name not in before])
    relation = draw(st.sampled_from(["other_robot_than", "same_robot_as"]))
    kept = {name: draw(lags) for name in before if draw(flags)}
    return {"prerequisites": before, "lags": kept, "other_robot_than": related} | (
        {"other_robot_than": (), relation: related[:1]} if draw(flags) else {}
    )


def consistent(values):
    """Without the costs and durations that an action excludes."""
    action = values.get("action")
    excluded = set()
    if action is not None and action.has_geometry:
        excluded.add("actuation_cost")
    if action is not None and action.duration_s is not None:
        excluded.add("duration_s")
    return {key: value for key, value in values.items() if key not in excluded}


@st.composite
def events(draw, size, robots, tasks, robot_type, task_type, number) -> Event:
    kind = draw(st.integers(0, 7 if tasks else 4))
    if kind < 3:
        happening = {("robot_fails", "robot_silent", "robot_returns")[kind]: one_of(draw, robots)}
    elif kind == 3:
        joins = Robot(id=f"joins-{number}-{draw(words)}", position=draw(POINTS[size]), type=robot_type())
        happening = {"robot_joins": joins}
    elif kind == 4:
        new = Task(id=f"new-{number}-{draw(words)}", position=draw(POINTS[size]), type=task_type())
        happening = {"new_task": new}
    elif kind == 5:
        happening = {"cancel_task": one_of(draw, tasks)}
    elif kind == 6:
        happening = {"move_task": MovedTask(task=one_of(draw, tasks), position=draw(POINTS[size]))}
    else:
        happening = {"delay_task": DelayedTask(task=one_of(draw, tasks), by_s=draw(not_negative))}
    return Event(at_s=draw(not_negative), **happening)


@st.composite
def plain_missions(draw, names="plain") -> Mission:
    """Missions that a task-list CSV, a robots CSV and a suitability CSV can say."""
    point = POINTS[draw(dimension)]
    suitability = draw(TABLES[names])
    robot_type, task_type = types_of(draw, suitability, WORDS[names])
    tasks, timed = draw(task_ids[names]), draw(seldom)
    return Mission(
        name="tasks",
        robots=tuple(
            Robot(id=name, position=draw(point), type=robot_type(), work_capacity=draw(st.none() | not_negative))
            for name in draw(robot_ids[names])
        ),
        tasks=tuple(
            Task(
                id=name,
                position=draw(point),
                type=task_type(),
                actuation_cost=draw(not_negative),
                prerequisites=some_of(draw, tasks[:k]),
                **(draw(TIMES) if timed else {}),
            )
            for k, name in enumerate(tasks)
        ),
        suitability=suitability,
    )


depots_and_places = st.lists(POINTS[2], min_size=1, max_size=8)


@st.composite
def salesmen(draw) -> Mission:
    """Closed missions of salesmen as `read_tsplib` makes them of a file that is named `places`."""
    depot, *places = draw(depots_and_places)
    count = draw(st.integers(1, 4))
    return Mission(
        name=f"places-{count}",
        rules=Rules(return_to_start=True),
        robots=tuple(Robot(id=f"r_{k}", position=depot) for k in range(count)),
        tasks=tuple(Task(id=str(k), position=place) for k, place in enumerate(places, 2)),
    )


grid = st.integers(-4, 4).map(float)
quarters = st.integers(0, 12).map(lambda number: number / 4)


@st.composite
def tiny_missions(draw, max_robots=2, max_tasks=4, tabled=None) -> Mission:
    """1 or 2 robots, up to 4 tasks on a small grid: every rule is now and then what makes a task impossible.

    `tabled` tells whether travel is by table, some of whose ways do not exist; by default either.
    """
    by_table = draw(st.booleans()) if tabled is None else tabled
    point = st.tuples(grid, grid)
    portal = st.none() if by_table else st.none() | point
    skills = st.lists(st.sampled_from(["camera", "gripper"]), unique=True, max_size=2).map(tuple)
    robots = tuple(
        Robot(
            id=f"r_{k}",
            position=draw(point),
            type=draw(st.sampled_from(["beta", "tau"])),
            work_capacity=draw(st.none() | st.integers(0, 20)),
            skills=draw(skills),
            speed_mps=draw(st.sampled_from([0.5, 1, 2])),
            efficiency=draw(st.sampled_from([0.5, 1])),
            return_to_start=draw(st.none() | st.booleans()),
            end_position=draw(portal),
            available_from_s=draw(st.sampled_from([0, 3])),
        )
        for k in range(draw(st.integers(1, max_robots)))
    )
    robot_ids = [robot.id for robot in robots]
    tasks = []
    for k in range(draw(st.integers(1, max_tasks))):
        earlier = [task.id for task in tasks]
        tasks.append(
            Task(
                id=str(k),
                position=draw(point),
                type=draw(st.sampled_from(["D", "E"])),
                actuation_cost=draw(quarters),
                duration_s=draw(st.none() | quarters),
                prerequisites=tuple(draw(st.lists(st.sampled_from(earlier), unique=True, max_size=2))) if k else (),
                requires=draw(st.sampled_from([(), (), ("camera",), ("gripper",)])),
                only_robots=draw(st.none() | st.just((robot_ids[-1],))),
                entry=draw(portal),
                exit=draw(portal),
            )
        )
    rules = Rules(
        objective=draw(st.sampled_from(OBJECTIVES)),
        usage=draw(st.sampled_from(["distance", "time"])),
        return_to_start=draw(st.booleans()),
        travel="matrix" if by_table else None,
        capacity_reserve=draw(st.sampled_from([0, 0.25])),
    )
    suitability = {"beta": {"D": 0.9, "E": 0.5}, "tau": {"E": 0.7}} if draw(st.booleans()) else None
    places = (*robot_ids, *(task.id for task in tasks))
    metres = st.sampled_from([0.0, 1.0, 2.5, 4.0, 7.25, math.inf])
    row = st.tuples(*[metres] * len(places))
    kinds = ("beta", "tau") if by_table else ()
    return Mission(
        name="tiny",
        rules=rules,
        suitability=suitability,
        robots=robots,
        tasks=tuple(tasks),
        travel={kind: f"{kind}.csv" for kind in kinds} or None,
        travel_tables={kind: TravelTable(places, draw(st.tuples(*[row] * len(places)))) for kind in kinds},
    )
