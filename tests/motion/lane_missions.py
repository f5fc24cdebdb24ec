"""Random missions on lanes: small graphs, robots of many sorts, tasks on lanes and beside them."""

from __future__ import annotations

from hypothesis import strategies as st

from muster import Mission, Robot, Rules, Task
from muster.mission.lanes import Lane, Lanes
from muster.mission.site import Map, Zone

COORDINATES = st.floats(-20.0, 20.0).map(lambda c: round(c, 2)) | st.integers(-4, 4).map(lambda c: 5.0 * c)
PLACES = st.tuples(COORDINATES, COORDINATES)
LIMITS = ({}, {"acceleration_mps2": 0.8}, {"yaw_rate_radps": 1.1}, {"acceleration_mps2": 1.0, "yaw_rate_radps": 1.8})


def apart(places):
    """Whether no two places are so near to each other that they count as one in some respects and not in others."""
    return all(a == b or max(abs(x - y) for x, y in zip(a, b, strict=True)) > 0.1 for a in places for b in places)


@st.composite
def graphs(draw, speeds=(None, None, 0.3, 2.0), widths=(None, None, None, 0.7)):
    """A few nodes and lanes between some of them: one way and both ways, slow and narrow ones among them."""
    nodes = draw(st.lists(PLACES, min_size=2, max_size=7, unique=True).filter(apart))
    ends = st.tuples(*[st.integers(0, len(nodes) - 1)] * 2).filter(lambda pair: pair[0] != pair[1])
    pairs = draw(st.lists(ends, min_size=1, max_size=12, unique_by=lambda pair: tuple(sorted(pair))))
    edges = [
        Lane(
            start=f"n{a}",
            end=f"n{b}",
            both_ways=draw(st.booleans()),
            speed_mps=draw(st.sampled_from(speeds)),
            width_m=draw(st.sampled_from(widths)),
        )
        for a, b in pairs
    ]
    return Lanes(nodes={f"n{k}": place for k, place in enumerate(nodes)}, edges=tuple(edges))


@st.composite
def robots(draw, kinds=("ground", "ground", "air"), limits=LIMITS, most=3):
    """Robots on the ground and in the air, with and without limits of their motion."""
    found = []
    for k in range(draw(st.integers(1, most))):
        kind = draw(st.sampled_from(kinds))
        kinematics = "holonomic" if kind == "air" else draw(st.sampled_from(["holonomic", "differential-drive"]))
        found.append(
            Robot(
                id=f"r{k}",
                position=draw(PLACES),
                radius_m=draw(st.sampled_from([0.0, 0.3, 0.4])),
                speed_mps=draw(st.sampled_from([0.5, 1.0])),
                kind=kind,
                kinematics=kinematics,
                **draw(st.sampled_from(limits)),
            )
        )
    return tuple(found)


@st.composite
def missions(draw, with_map=False, **of_robots):
    """Missions on lanes, without a map or with a box in the way."""
    places = draw(st.lists(PLACES, min_size=1, max_size=5))
    tasks = [Task(id=f"t{k}", position=place, exit=draw(st.none() | PLACES)) for k, place in enumerate(places)]
    chart = None
    if with_map:
        x, y = draw(st.tuples(*[st.integers(-1500, 1200).map(lambda c: c / 100 + 0.005)] * 2))  # touches no lane
        box = Zone(polygon=((x, y), (x + 4, y), (x + 4, y + 3), (x, y + 3)))
        chart = Map(boundary=((-25.0, -25.0), (25.0, -25.0), (25.0, 25.0), (-25.0, 25.0)), zones=(box,))
    rules = Rules(usage=draw(st.sampled_from(["time", "distance"])))
    return Mission(rules=rules, lanes=draw(graphs()), robots=draw(robots(**of_robots)), tasks=tuple(tasks), map=chart)
