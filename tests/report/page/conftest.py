"""Records to be looked at, and the browser that does."""

import pytest
from tests.report.page.browser import Browser, browser_found
from tests.report.voyages import carry_out, shipped

import muster
from muster.mission.reading.plan_reader import plan_of
from muster.report.page import write_page
from muster.report.record import RecordWriter, read_record

MORE = (
    (20.0, "robot_fails", {"robot": "r_5"}),
    (20.0, "new_task", {"task": {"id": "late <b>", "type": "D", "position": [-9, -9]}}),
    (25.0, "move_task", {"task": "late <b>", "position": [-8, -9]}),
    (30.0, "lost", {"task": "late <b>", "reason": "capacity"}),
    (40.0, "cancel_task", {"task": "22"}),
    (45.0, "traffic_jam", {"robots": ["r_0", "r_1"], "position": [1.0, 2.0], "since_s": 40.0}),
)


@pytest.fixture(scope="session")
def recorded(tmp_path_factory):
    """Makes the record of a shipped mission, carried out straight along a greedy plan, and reads it."""
    made = {}

    def record(name, **how):
        key = (name, *sorted(how))
        if key not in made:
            file = tmp_path_factory.mktemp("records") / f"{name}.mcap"
            mission = shipped(name)
            with RecordWriter(file, mission) as writer:
                carry_out(mission, muster.solve(mission, "greedy"), writer, **how)
            made[key] = read_record(file)
        return made[key]

    return record


@pytest.fixture(scope="session")
def page(recorded, tmp_path_factory):
    """Writes the page of a record; gives its file."""

    def write(name, **how):
        file = tmp_path_factory.mktemp("pages") / f"{name}.html"
        write_page(file, recorded(name, **how))
        return file

    return write


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    if browser_found() is None:
        pytest.skip("no browser: tools/browser.sh installs one")
    browser = Browser(tmp_path_factory.mktemp("browser"))
    yield browser
    browser.close()


TIMED = """
schema: muster/1
name: timed
starts_at: 2027-03-01T09:58:00+01:00
rules: {objective: lateness}
robots:
  - {id: crawler, position: [0, 0]}
  - {id: hauler, position: [0, 10]}
tasks:
  - {id: boiler, position: [40, 0], duration_s: 60, window: ["10:00", "10:30"], due: "10:00:30"}
  - {id: beam, position: [20, 10], duration_s: 60, robots_needed: 2, deadline: "10:00:50"}
  - {id: far, position: [0, 20], window: ["11:00", "12:00"], deadline: "13:00"}
"""
TIMED_ROUTES = {"crawler": ["beam", "boiler"], "hauler": ["beam"]}


ADDED = (
    (5.0, "new_task", {"task": {"id": "new", "position": [0, 0], "window_s": [[60, 120]], "due_s": 100}}),
    (90.0, "sets_out", {"robot": "hauler", "task": "new"}),
    (100.0, "starts", {"robot": "hauler", "task": "new"}),
    (115.0, "ends", {"robot": "hauler", "task": "new"}),
)


@pytest.fixture(scope="session")
def timed_page(tmp_path_factory):
    """The page of a mission with a window, a deadline, a task that is late, and a team; and a task that was added."""
    folder = tmp_path_factory.mktemp("timed")
    (folder / "timed.yaml").write_text(TIMED, encoding="utf-8")
    mission = muster.load(folder / "timed.yaml")
    with RecordWriter(folder / "timed.mcap", mission) as writer:
        carry_out(mission, plan_of(TIMED_ROUTES), writer, more=ADDED)
    write_page(folder / "timed.html", read_record(folder / "timed.mcap"))
    return folder / "timed.html"
