from muster.cli.schedule_table import print_schedule
from muster.mission.model import Mission, Robot, Task
from muster.mission.plan import Plan, Route
from muster.verification import verify

ROBOTS = (Robot(id="r", position=(0, 0)), Robot(id="s", position=(0, 4)))
PLAN = Plan(routes=(Route("r", ("a",)), Route("s", ("a", "b"))))


def printed(tasks, capsys, **keys):
    mission = Mission(name="m", robots=ROBOTS, tasks=tasks, **keys)
    print_schedule(mission, verify(mission, PLAN))
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
    mission = Mission(name="m", robots=ROBOTS, tasks=(Task(id="a", position=(3, 0)),))
    print_schedule(mission, verify(mission, Plan(routes=(Route("r", ("a",)),))))
    assert capsys.readouterr().out == ""
