"""Numbers in tables have units: none is guessed for energy and capacities, and what is taken elsewhere is told."""

import pytest
from tests.muster_files.sites import writers

from muster import MissionError, read_site


def read(folder, heading, cell, *, file="drones.csv", tasks=writers.CSV, quoted=True, **options):
    places, team = folder / "site.csv", folder / file
    places.write_text(tasks, encoding="utf-8")
    cell = f'"{cell}"' if quoted else cell
    team.write_text(f"id,lat,lon,Speed (m/s),{heading}\nd1,47.3768,8.5416,10,{cell}\n", encoding="utf-8")
    return read_site(places, robots=team, **options)


@pytest.mark.parametrize(
    ("heading", "cell", "seconds"),
    [
        ("Endurance (min)", "28", 1680),
        ("Flight time", "28 min", 1680),
        ("Flight time (min)", "28", 1680),
        ("Battery (min)", "28", 1680),
        ("Battery", "28 min", 1680),
        ("battery min", "28", 1680),
        ("endurance_s", "1680", 1680),
        ("Max flight time [h]", "0,5", 1800),
        ("Flugzeit (Minuten)", "28", 1680),
        ("Max. Flugzeit [min]", "28", 1680),
        ("Autonomía máxima (min)", "28", 1680),
        ("Autonomie", "1 h 30 min", 5400),
        ("Autonomía (min)", "28", 1680),
        ("Время полёта (мин)", "28", 1680),
        ("续航时间", "28 分钟", 1680),
        ("Battery life", "00:28", 1680),
    ],
)
def test_endurance_is_a_time(tmp_path, heading, cell, seconds):
    found = read(tmp_path, heading, cell)
    assert found.mission.robots[0].battery.capacity == pytest.approx(seconds)
    assert found.mission.rules.usage == "time"
    assert any("usage: time chosen" in note for note in found.notes)


@pytest.mark.parametrize(
    ("heading", "cell", "metres"),
    [
        ("Range (km)", "5", 5000),
        ("Range", "5 km", 5000),
        ("range_m", "5000", 5000),
        ("Reichweite (km)", "5,5", 5500),
        ("Portée (km)", "5", 5000),
        ("Alcance (m)", "5000", 5000),
        ("Zasięg (km)", "5", 5000),
        ("Дальность (км)", "5", 5000),
        ("航程", "5 公里", 5000),
        ("Battery (km)", "5", 5000),
        ("Max range (mi)", "3", 4828.032),
        ("Battery", "16000 ft", 4876.8),
    ],
)
def test_range_is_a_length(tmp_path, heading, cell, metres):
    found = read(tmp_path, heading, cell)
    assert found.mission.robots[0].battery.capacity == pytest.approx(metres)
    assert found.mission.rules.usage == "distance"


@pytest.mark.parametrize(
    ("heading", "cell"),
    [
        *(("Battery", cell) for cell in ("28", "28.5", "5000 mAh", "80 %", "90 Wh", "full", "28 kg")),
        *(("Endurance", cell) for cell in ("28", "5 km", "5000 mAh")),
        *(("Range", cell) for cell in ("5", "28 min")),
        *(
            (heading, "5000")
            for heading in ("Battery (mAh)", "Battery (%)", "Battery Wh", "Battery [kWh]", "Akku (Ah)")
        ),
        *((heading, "28") for heading in ("Akku", "Batterie", "Flugzeit", "Reichweite", "SoC", "电池", "батарея")),
        ("Capacity", "28"),
        ("Capacity (mAh)", "5000"),
        ("Budget", "28"),
    ],
)
@pytest.mark.parametrize("quoted", [True, False])
def test_numbers_that_do_not_say_of_what_are_refused_with_what_is_right(tmp_path, heading, cell, quoted):
    with pytest.raises(MissionError) as caught:
        read(tmp_path, heading, cell, quoted=quoted)
    (finding,) = caught.value.findings
    assert finding.file.endswith("drones.csv")
    assert heading in finding.field
    assert "Endurance (min)" in finding.expected
    assert "Range (km)" in finding.expected


def test_a_number_in_a_workbook_is_no_time(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.title = "Drones"
    for row in (["id", "lat", "lon", "Battery"], ["d1", 47.3768, 8.5416, 28]):
        book.active.append(row)
    tasks = book.create_sheet("Tasks")
    for row in (["id", "lat", "lon"], ["a", 47.377, 8.5417]):
        tasks.append(row)
    book.save(tmp_path / "site.xlsx")
    with pytest.raises(MissionError, match=r"Battery: 28.0; expected how long or how far"):
        read_site(tmp_path / "site.xlsx")


@pytest.mark.parametrize(
    ("tasks", "more"),
    [(writers.CSV, "work_capacity,"), (writers.CSV, "")],
)
def test_endurance_and_range_together_hold_both(tmp_path, tasks, more):
    places, team = tmp_path / "site.csv", tmp_path / "drones.csv"
    places.write_text(tasks, encoding="utf-8")
    team.write_text(
        f"id,lat,lon,speed,Range (km),Endurance (min),{more}\nd1,47.3768,8.5416,10 m/s,5,25,{'900,' if more else ''}\n",
        encoding="utf-8",
    )
    if more:
        with pytest.raises(MissionError, match=r"work_capacity: 900.0; expected none beside a robot's endurance"):
            read_site(places, robots=team)
    else:
        assert read_site(places, robots=team).mission.robots[0].battery.capacity == 500


def test_work_counts_against_a_range(tmp_path):
    tasks = writers.CSV.replace("lon\n", "lon,duration\n").replace("8.5417\n", "8.5417,5 min\n")
    found = read(tmp_path, "Range (km)", "5", tasks=tasks)
    assert (found.mission.rules.usage, found.mission.robots[0].battery.capacity) == ("time", 500)


def test_numbers_that_are_taken_in_si_units_are_told(tmp_path):
    places, team = tmp_path / "site.csv", tmp_path / "rovers.csv"
    places.write_text("id,x,y,duration,demand\na,1,2,90,3\n", encoding="utf-8")
    team.write_text("id,x,y,speed,radius\nr,0,0,2,0.3 m\n", encoding="utf-8")
    found = read_site(places, robots=team)
    assert f"{team}: numbers without a unit are taken so: speed in m/s" in found.notes
    assert f"{places}: numbers without a unit are taken so: duration in s, demand in kg or pieces" in found.notes
    team.write_text("id,x,y,speed_mps,radius\nr,0,0,2,0.3 m\n", encoding="utf-8")
    places.write_text("id,x,y,duration_s,load\na,1,2,90,3\n", encoding="utf-8")
    assert not any("without a unit" in note for note in read_site(places, robots=team).notes)


def test_sites_with_aircraft_return(tmp_path):
    drones = read(tmp_path, "Range (km)", "5")
    assert drones.mission.rules.return_to_start
    assert "return_to_start: true for robots in the air, which land where they started: d1" in drones.notes
    assert not read(tmp_path, "Range (km)", "5", file="rovers.csv").mission.rules.return_to_start
    told = read(tmp_path, "return_to_start", "no").mission
    assert told.robots[0].return_to_start is False
    places, team = tmp_path / "site.csv", tmp_path / "team.csv"
    team.write_text("id,lat,lon,kind\nd,47.3768,8.5416,air\nr,47.3768,8.5416,ground\n", encoding="utf-8")
    mixed = read_site(places, robots=team).mission
    assert [robot.return_to_start for robot in mixed.robots] == [True, None]
