"""`muster run` of a fleet whose robots outlive the command: interrupted, refused, resumed, brought home."""

import json
import re
import signal

import pytest
from tests.running.test_live import WorldAsFleet, mission

import muster
from muster.cli.exits import BAD_INPUT, DONE, INTERRUPTED, STILL_MOVING
from muster.cli.main import run
from muster.execution.final_state import FinalState, RobotsLeftError
from muster.mission.yaml_writer import yaml_text
from muster.running.fleet_registry import FLEETS
from muster.running.fleet_type import ABILITIES, FleetType
from muster.running.journal_file import journal_place, read_journal
from muster_robots.cli.going_on import GoingOn


class Lasting(WorldAsFleet):
    """Ctrl-C comes when so many robots were told where to go."""

    interrupts_at = None

    def advance(self, until_s):
        if self.interrupts_at is not None and self.time_s >= self.interrupts_at:
            self.interrupts_at = None
            signal.raise_signal(signal.SIGINT)
        return super().advance(until_s)

    def stop(self):
        for port in self.ports.values():
            port.cancel()


@pytest.fixture
def there(tmp_path):
    made = mission()
    (tmp_path / "m.yaml").write_text(yaml_text(made), encoding="utf-8")
    return muster.load(tmp_path / "m.yaml")


@pytest.fixture
def fleet(there):
    """A fleet of another package, opened again and again."""
    world = Lasting(there)

    def open_yard(mission, settings, halt, again):
        return world, lambda: None

    FLEETS.add("yard", FleetType(name="yard", open=open_yard, abilities=ABILITIES, claims=lambda _: ["the yard"]))
    yield world
    FLEETS.remove("yard")


@pytest.fixture
def call(tmp_path, fleet, capsys):
    def called(*more):
        code = run(["run", str(tmp_path / "m.yaml"), "--fleet", "yard", "--iterations", "20", *more])
        return code, *capsys.readouterr()

    return called


@pytest.fixture
def place(fleet):
    return journal_place("yard", ["the yard"])


@pytest.fixture
def interrupted(fleet, call, place):
    """Two tasks are done, then comes Ctrl-C."""
    fleet.interrupts_at = 10.0
    code, _, err = call()
    assert code == INTERRUPTED
    assert f"journal: {place}: by it --resume goes on with the run" in err
    return read_journal(place)


def test_what_was_interrupted_is_refused_with_what_helps(interrupted, call, place):
    code, out, err = call()
    assert (code, out) == (BAD_INPUT, "")
    last = err.splitlines()[-1]
    assert last.startswith(f'{place}: the run of mission "mission", begun ')
    assert re.search(
        r"did not end \(\d tasks? done\), and has left r_0: stands; at \(.*\), \d\.\d m from its start", last
    )
    assert "expected --resume, which goes on with it, or --recover, which brings everyone home" in last


def test_it_is_resumed(interrupted, call, place):
    done = sum(entry["kind"] == "ends" for entry in interrupted.entries)
    code, out, err = call("--resume", "--format", "json")
    assert code == DONE
    assert len(json.loads(out)["tasks_done"]) == 4
    assert f"journal: {place}: goes on with the run of" in err
    assert err.count("has done task") == 4 - done
    assert read_journal(place).ended
    assert call("--resume")[0] == BAD_INPUT


def test_it_is_resumed_by_a_copy_of_its_journal_and_by_its_record(interrupted, call, place, tmp_path):
    copy = tmp_path / "copy.journal"
    copy.write_bytes(place.read_bytes())
    assert call("--resume", str(copy))[0] == DONE
    assert not read_journal(place).ended
    assert call("--resume", str(tmp_path / "m.yaml"))[2].endswith(
        "expected a journal as Muster writes it (muster-journal/1)\n"
    )


def test_a_record_names_its_journal_and_is_not_written_over(fleet, call, place, tmp_path):
    fleet.interrupts_at, record = 10.0, str(tmp_path / "r.mcap")
    call("--record", record)
    code, _, err = call("--resume", record, "--record", record)
    assert code == BAD_INPUT
    assert "the record of the run that is resumed; expected another file" in err
    assert call("--resume", record, "--record", str(tmp_path / "second.mcap"))[0] == DONE


def test_robots_are_brought_home_and_a_new_run_begins(interrupted, call, fleet, there):
    code, out, err = call("--recover", "--format", "json")
    assert code == DONE
    told = json.loads(out)
    assert [row["robot"] for row in told["robots"]] == ["r_0", "r_1"]
    assert told["not_home"] == {}
    assert err.splitlines()[-2].startswith("r_0: stands; at (")
    assert fleet.ports["r_0"].telemetry().position[:2] == pytest.approx((0.0, 0.0), abs=0.5)
    assert call()[0] == DONE


def test_on_their_way_home_robots_stay_at_ctrl_c_and_the_run_goes_on(interrupted, call, fleet, there):
    fleet.interrupts_at = fleet.time_s + 1.0
    code, _, err = call("--recover")
    assert code == INTERRUPTED
    assert "interrupted; robots were told to stay where they are" in err
    assert call()[0] == BAD_INPUT
    assert call("--resume")[0] == DONE


def test_robots_are_brought_home_without_a_journal(fleet, call, place):
    fleet.interrupts_at = 10.0
    call()
    place.unlink()
    assert call("--recover")[0] == DONE
    assert fleet.ports["r_1"].telemetry().position[:2] == pytest.approx((0.0, 3.0), abs=0.5)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--resume", "--recover"), "--recover given with --resume; expected one of them"),
        (("--plan", "p.json", "--resume"), "--plan given with --resume; expected no plan"),
        (("--resume",), "No such file or directory; expected a journal as Muster writes it"),
        (("--resume", "nowhere"), "nowhere: No such file or directory; expected a journal"),
    ],
)
def test_what_does_not_go_together_is_refused(more, said, call, tmp_path):
    (tmp_path / "p.json").write_text('{"schema": "muster-plan/1", "routes": []}')
    code, _, err = call(*(str(tmp_path / word) if word.endswith(".json") else word for word in more))
    assert code == BAD_INPUT
    assert said in err


def test_the_journal_of_another_mission_is_refused(interrupted, call, tmp_path, there):
    text = (tmp_path / "m.yaml").read_text()
    (tmp_path / "m.yaml").write_text(text.replace("id: t_3", "id: t_9"))
    code, _, err = call("--resume")
    assert code == BAD_INPUT
    assert re.search(r'\.journal: tasks: those of mission "mission", begun 2.*; expected the tasks of .*m\.yaml', err)


def test_who_was_sent_off_and_is_not_heard_any_more_counts_as_moving(interrupted, there, place):
    known = GoingOn(there, place, "yard", ["the yard"], True, False, before=interrupted)
    never, heard = FinalState("r_9", "not heard", None, False), FinalState("r_0", "stands", (0.0, 0.0, 0.0), False)
    (lost, *others) = known.judged([FinalState("r_0", "not heard", None, False), never, heard])
    assert (lost.moving, lost.state) == (True, "not heard since the stop: it may be armed, or move")
    assert others == [never, heard]


def test_robots_that_a_refusal_leaves_armed_are_named(there, tmp_path, capsys):
    def open_sky(mission, settings, halt, again):
        raise RobotsLeftError(
            "r_0: stands far away", [FinalState("r_0", "hovers, armed", (1.0, 2.0, 3.0), moving=True)]
        )

    FLEETS.add("sky", FleetType(name="sky", open=open_sky, abilities=ABILITIES, claims=lambda _: ["the sky"]))
    code = run(["run", str(tmp_path / "m.yaml"), "--fleet", "sky", "--iterations", "5"])
    FLEETS.remove("sky")
    assert code == STILL_MOVING
    assert capsys.readouterr().err.splitlines()[-2:] == [
        "r_0: hovers, armed; at (1.00, 2.00, 3.00)",
        "r_0: stands far away",
    ]
