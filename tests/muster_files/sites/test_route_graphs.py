"""Route graphs of Nav2 are lanes: directed, in the frame of the map."""

import json

import pytest

import muster
from muster.mission.errors import MissionError

CRS = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}


def node(name, x, y, **more):
    geometry = {"type": "Point", "coordinates": [x, y]}
    return {"type": "Feature", "properties": {"id": name, "frame": "map", **more}, "geometry": geometry}


def edge(name, start, end, **more):
    geometry = {"type": "MultiLineString", "coordinates": [[[0.0, 0.0], [0.0, 9.0]]]}
    properties = {"id": name, "startid": start, "endid": end, **more}
    return {"type": "Feature", "properties": properties, "geometry": geometry}


NODES = (node(0, 0.0, 0.0), node(1, 0.0, 100.0), node(2, 20.0, 100.0))
EDGES = (edge(10, 0, 1), edge(11, 1, 2, metadata={"abs_speed_limit": 0.5}), edge(12, 2, 0))


def read(tmp_path, *features, **options):
    data = {"type": "FeatureCollection", "name": "graph", "crs": CRS, "features": features}
    (tmp_path / "graph.geojson").write_text(json.dumps(data), encoding="utf-8")
    (tmp_path / "robots.csv").write_text("id,x,y\nr_0,0,0\n", encoding="utf-8")
    return muster.read_site(tmp_path / "graph.geojson", robots=tmp_path / "robots.csv", **options)


@pytest.mark.parametrize("options", [{}, {"origin": (0.0, 0.0)}])
def test_edges_are_one_way_lanes_in_metres(tmp_path, options):
    found = read(tmp_path, *NODES, *EDGES, **options)
    lanes = found.mission.lanes
    assert lanes.nodes == {"0": (0, 0), "1": (0, 100), "2": (20, 100)}
    assert [(lane.start, lane.end, lane.both_ways) for lane in lanes.edges] == [
        ("0", "1", False),
        ("1", "2", False),
        ("2", "0", False),
    ]
    assert [lane.speed_mps for lane in lanes.edges] == [None, 0.5, None]
    assert (found.mission.tasks, found.mission.travel_rule) == ((), "lanes")
    assert [row.told for row in found.ledger.not_read if not row.minor] == []


def test_it_is_added_to_a_mission(tmp_path):
    robots, tasks = (muster.Robot(id="r", position=(1.0, 50.0)),), (muster.Task(id="t", position=(10.0, 101.0)),)
    muster.Mission(robots=robots, tasks=tasks).save(tmp_path / "m.yaml")
    read(tmp_path, *NODES, *EDGES)
    mission = muster.read_site(tmp_path / "m.yaml", tmp_path / "graph.geojson").mission
    assert muster.solve(mission, "greedy").total_cost == pytest.approx(1 + 50 + 10 + 1)


@pytest.mark.parametrize(
    ("features", "told"),
    [
        ((*NODES, edge(10, 0, 7)), r"features\[3\].properties.endid: 7; expected the id of a node"),
        ((*NODES, node(1, 5, 5), *EDGES), r"features\[3\].properties.id: 1; expected an id that no node before has"),
        ((NODES[0], node(1, 0, 9, frame="odom"), EDGES[0]), "frame: map and odom; expected one frame"),
        ((*NODES, {"type": "Feature", "properties": {}, "geometry": None}, *EDGES), "expected a node"),
    ],
)
def test_what_is_no_graph_is_refused(tmp_path, features, told):
    with pytest.raises(MissionError, match=told):
        read(tmp_path, *features)
