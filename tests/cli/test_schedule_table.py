from tests.carry_charge import battery, charger, judged, mission, robot, task

from muster.cli.tables.plan import print_figures
from muster.cli.tables.schedule import print_schedule
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Route
from muster.verification import verify

ROBOTS = (Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 4)))
PLAN = Plan(routes=(Route("r", ("a",)), Route("s", ("a", "b"))))


def printed(tasks, capsys, **keys):
    given = Mission(name="m", robots=ROBOTS, tasks=tasks, **keys)
    print_schedule(given, verify(given, PLAN))
    return [line.split() for line in capsys.readouterr().out.splitlines()]


def test_rows_say_arrival_begin_end_waiting_lateness_and_the_others_of_the_team(capsys):
    lines = printed(
        (Task(id="a", position=(3, 0), robots_needed=2, duration_s=2, due_s=6), Task(id="b", position=(3, 2))), capsys
    )
    assert ["r", "a", "3.00", "5.00", "7.00", "2.00", "1.00", "s"] in lines
    assert ["s", "a", "5.00", "5.00", "7.00", "1.00", "r"] in lines
    assert ["s", "b", "9.00", "9.00", "9.00"] in lines


def test_times_are_clock_times_where_the_mission_has_a_start(capsys):
    tasks = (Task(id="a", position=(3, 0), robots_needed=2, window_s=((60, 90),)), Task(id="b", position=(3, 2)))
    lines = printed(tasks, capsys, starts_at="2027-03-01T08:00:00+01:00")
    assert ["r", "a", "08:00:03", "08:01:00", "08:01:00", "57.00", "s"] in lines


def test_routes_alone_need_no_schedule(capsys):
    given = Mission(name="m", robots=ROBOTS, tasks=(Task(id="a", position=(3, 0)),))
    print_schedule(given, verify(given, Plan(routes=(Route("r", ("a",)),))))
    assert capsys.readouterr().out == ""


def test_rows_of_stations_say_what_is_charged_and_how_much_energy_and_load_there_is_after_each_stop(capsys):
    given = mission(
        [robot(battery=battery(30), load_capacity=4)],
        [task("a", 10, load=3), task("b", 25, delivers="a")],
        [charger(x=12)],
    )
    verdict = judged(given, r="a dock b")
    print_schedule(given, verdict)
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["r", "a", "10.00", "10.00", "10.00", "20.00", "3"] in lines
    assert ["r", "[dock]", "12.00", "12.00", "24.00", "12.00", "30.00", "3"] in lines
    assert ["r", "b", "37.00", "37.00", "37.00", "17.00", "0"] in lines
    print_figures(verdict)
    assert "at stations       1 time, 12.00 m charged" in capsys.readouterr().out.splitlines()


def test_waiting_for_a_slot_is_waiting(capsys):
    given = mission(
        [robot("q", battery=battery(9)), robot("r", battery=battery(9))], [task("a", 6), task("b", 6)], [charger(x=5)]
    )
    print_schedule(given, judged(given, q="dock a", r="dock b"))
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["r", "[dock]", "5.00", "10.00", "15.00", "5.00", "5.00", "9.00"] in lines
