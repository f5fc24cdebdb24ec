"""Random sites in many languages: no way of a plan or an export leads into what the source closes.

The sites are drawn here in degrees, and judged by Shapely on what was drawn: nothing of Muster is asked what is closed.
"""

import csv
import io
import json
import math
import random
from pathlib import Path

import pytest
import shapely
from tests.muster_files.sites import names, writers

from muster import MissionError, read_site, solve, verify
from muster.planning.export_formats import ExportOptions
from muster.planning.exporting import exported

LAT, LON = 47.265, 11.394
M_LAT = 111_200.0
M_LON = M_LAT * math.cos(math.radians(LAT))
WITHIN_M = 0.5
"""What the plane of the map frame, and this one, differ by at most."""
UNITS = (("m", 1.0), ("ft", 0.3048), ("km", 1000.0))


def degrees(place):
    return LON + place[0] / M_LON, LAT + place[1] / M_LAT


def metres(lat, lon):
    return (lon - LON) * M_LON, (lat - LAT) * M_LAT


def some(rng, listed):
    return rng.choice(names.listed(listed))


class Drawn:
    """A site as it is drawn: its boundary, closed areas with their shapes in metres, and the places to visit."""

    def __init__(self, rng):
        self.marks, self.closed = [], []
        self._mark(some(rng, names.BOUNDARY), ring=[(-500, -400), (500, -400), (500, 400), (-500, 400)])
        for _ in range(rng.randint(1, 4)):
            x, y, size = rng.uniform(-300, 250), rng.uniform(-250, 250), rng.uniform(20, 150)
            if rng.random() < 0.4:
                unit, factor = rng.choice(UNITS)
                self._mark(some(rng, names.CLOSED), point=(x, y), radius=f"{size / 2 / factor:.4f} {unit}")
                self.closed.append(shapely.Point(x, y).buffer(size / 2, quad_segs=64))
            else:
                ring = [(x, y), (x + size, y + rng.uniform(-20, 20)), (x + size, y + size), (x, y + size)]
                ring = [ring[k] for k in (0, 2, 1, 3)] if rng.random() < 0.2 else ring
                self._mark(some(rng, names.CLOSED), ring=ring)
                self.closed.append(shapely.make_valid(shapely.Polygon(ring)))
        for k in range(rng.randint(2, 6)):
            self._mark(f"{some(rng, names.PLACES)} {k}", point=(rng.uniform(-450, 450), rng.uniform(-350, 350)))
        rng.shuffle(self.marks)

    def _mark(self, name, ring=None, point=None, radius=None):
        self.marks.append((name, ring, point, radius))

    def as_geojson(self):
        features = []
        for name, ring, point, radius in self.marks:
            own = {"name": name} | ({"radius": radius} if radius else {})
            if ring:
                features.append(writers.area([degrees(place) for place in ring], **own))
            else:
                features.append(writers.feature("Point", list(degrees(point)), **own))
        return writers.geojson(*features)

    def as_kml(self):
        marks = []
        for name, ring, point, radius in self.marks:
            data = f"<ExtendedData><Data name='radius'><value>{radius}</value></Data></ExtendedData>" if radius else ""
            text = " ".join(f"{lon!r},{lat!r},0" for lon, lat in map(degrees, [*ring, ring[0]] if ring else [point]))
            shape = f"<coordinates>{text}</coordinates>"
            polygon = f"<Polygon><outerBoundaryIs><LinearRing>{shape}</LinearRing></outerBoundaryIs></Polygon>"
            marks.append(writers.placemark(name, data + (polygon if ring else f"<Point>{shape}</Point>")))
        return writers.kml(*marks)


def team_of(rng, closed):
    """A table of robots outside of closed areas: whether they fly, its rows, and whether a number has no unit."""
    air, bare = rng.random() < 0.7, rng.random() < 0.2
    word = some(rng, names.AIRCRAFT if air else names.GROUND)
    said_by = rng.choice(["file", "type", "id"])
    heading, cell = rng.choice(
        [("Endurance (min)", "60"), ("Battery", "60 min"), ("Range (km)", "30"), ("Range", "30 km")]
    )
    heading, cell = (
        rng.choice([("Battery", "28"), ("Range", "5"), ("Battery (mAh)", "5000")]) if bare else (heading, cell)
    )
    text = io.StringIO()
    rows = csv.writer(text)
    rows.writerow(["id", "type", "lat", "lon", "Speed (km/h)", heading])
    for k in range(rng.randint(1, 3)):
        while shapely.union_all(closed).distance(shapely.Point(place := (rng.uniform(-450, 450), -390 + k))) < 5:
            pass
        lon, lat = degrees(place)
        own = f"{word} {k}" if said_by == "id" else f"r{k}"
        rows.writerow([own, word if said_by == "type" else "", repr(lat), repr(lon), 36, cell])
    return air, bare, (f"{word}.csv" if said_by == "file" else "robots.csv"), text.getvalue()


def ways_of(files):
    """The ways in exported files, in metres of this test's plane."""
    for name, text in files.texts.items():
        if name.endswith(".plan"):
            data = json.loads(text)
            home = data["mission"]["plannedHomePosition"]
            items = [item for item in data["mission"]["items"] if item["command"] in (16, 21, 22)]
            spots = [home[:2], *(item["params"][4:6] for item in items if any(item["params"][4:6]))]
            spots += [home[:2]] if data["mission"]["items"][-1]["command"] == 20 else []
            yield [metres(lat, lon) for lat, lon in spots]
        else:
            for feature in json.loads(text)["features"]:
                if feature["properties"]["kind"] == "route":
                    yield [metres(lat, lon) for lon, lat, *_ in feature["geometry"]["coordinates"]]


def written(folder, rng, drawn, team, name):
    form = rng.choice(["geojson", "kml"])
    site = folder / f"site.{form}"
    site.write_text(drawn.as_kml() if form == "kml" else drawn.as_geojson(), encoding="utf-8")
    robots = folder / name.replace("/", "-")
    robots.write_text(team, encoding="utf-8")
    return [site, robots] if rng.random() < 0.5 else [robots, site]


def no_way_leads_into_a_closed_area(folder, seed):
    rng = random.Random(seed)
    drawn = Drawn(rng)
    air, bare, name, team = team_of(rng, drawn.closed)
    files = written(folder, rng, drawn, team, name)
    if bare:
        with pytest.raises(MissionError) as caught:
            read_site(*files)
        assert all("Endurance (min)" in finding.expected for finding in caught.value.findings)
        return
    found = read_site(*files)
    mission = found.mission
    assert {robot.kind for robot in mission.robots} == {"air" if air else "ground"}
    places = [point for _, _, point, radius in drawn.marks if point is not None and radius is None]
    assert len(mission.tasks) == len(places)
    plan = solve(mission, iterations=100, seed=1)
    verdict = verify(mission, plan)
    assert verdict.valid
    inner = shapely.union_all([area.buffer(-WITHIN_M) for area in drawn.closed])
    options = [("geojson", ExportOptions())]
    options += [("qgc", ExportOptions(altitude=60.0 if air else None))] if any(r.tasks for r in plan.routes) else []
    for form, chosen in options:
        made = exported(mission, verdict, form, chosen, plan)
        for way in ways_of(made):
            assert not shapely.intersects(inner, shapely.LineString([*way, way[0]][: max(2, len(way))])), (form, way)
        if form == "qgc":
            assert_fenced(made, drawn, air)
    reachable = [
        point
        for point in places
        if not any(area.buffer(WITHIN_M).contains(shapely.Point(point)) for area in drawn.closed)
    ]
    assert sum(len(route.tasks) for route in plan.routes) <= len(reachable)


def assert_fenced(made, drawn, air):
    for text in made.texts.values():
        data = json.loads(text)
        assert data["mission"]["vehicleType"] == (2 if air else 10)
        heights = [item["Altitude"] for item in data["mission"]["items"] if item["command"] == 16]
        assert not air or all(height > 59 for height in heights)
        fences = [p for p in data["geoFence"]["polygons"] if not p["inclusion"]]
        outside = shapely.union_all([shapely.Polygon([metres(*spot) for spot in fence["polygon"]]) for fence in fences])
        assert outside.buffer(WITHIN_M).covers(shapely.union_all(drawn.closed))


@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(6, 60), marks=pytest.mark.long)], ids=["6", "60"])
def test_no_way_leads_into_a_closed_area(tmp_path, seeds):
    for seed in seeds:
        folder = Path(tmp_path) / str(seed)
        folder.mkdir()
        no_way_leads_into_a_closed_area(folder, seed)
