"""Records to be looked at, and the browser that does."""

import pytest
from tests.report.page.browser import Browser, browser_found
from tests.report.voyages import carry_out, shipped

import muster
from muster.report.page import write_page
from muster.report.record import RecordWriter, read_record

MORE = (
    (20.0, "robot_fails", {"robot": "r_5"}),
    (20.0, "new_task", {"task": {"id": "late <b>", "type": "D", "position": [-9, -9]}}),
    (25.0, "move_task", {"task": "late <b>", "position": [-8, -9]}),
    (30.0, "lost", {"task": "late <b>", "reason": "capacity"}),
    (40.0, "cancel_task", {"task": "22"}),
    (45.0, "contact", {"robots": ["r_0", "r_1"], "distance_m": 0.125}),
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
