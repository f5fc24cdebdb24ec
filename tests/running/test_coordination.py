"""Coordinations of other packages: what `simulate` and the command ask of them."""

from typing import ClassVar

import click
import pytest
from click.testing import CliRunner

import muster
from muster.cli.options import coordination as coordination_options
from muster.execution import Report
from muster.mission.errors import ParameterError
from muster.mission.records import record, spec
from muster.mission.value_types import Number
from muster.running.coordination import COORDINATIONS, Coordination

MISSION = muster.Mission(
    robots=(muster.Robot(id="a", position=(0, 0)),), tasks=(muster.Task(id="t", position=(4, 0)),), name="small"
)


@record
class Lots(Coordination):
    """Draws lots."""

    summary: ClassVar = "No plan: robots draw lots."
    draws: float = spec(Number(minimum=1.0), "how often they draw", default=1.0)
    calls: ClassVar = []

    def refuse_mission(self, mission):
        if self.draws > 3:
            raise ParameterError("draws: expected at most 3")

    def carry_out(self, mission, request, recorder):
        self.calls.append((mission, request.seed, recorder is not None))
        return muster.simulate(mission, muster.solve(mission, time_limit=0.1))


@pytest.fixture
def lots(monkeypatch):
    monkeypatch.setattr(Lots, "calls", [])
    COORDINATIONS.add("draw-lots", Lots)
    yield Lots
    COORDINATIONS.remove("draw-lots")


def test_simulate_lets_any_coordination_carry_a_mission_out(lots, tmp_path):
    report = muster.simulate(MISSION, Lots(), seed=3, record=tmp_path / "run.mcap")
    assert isinstance(report, Report)
    assert lots.calls == [(MISSION, 3, True)]


def test_what_it_refuses_is_refused_before_any_file_is_opened(lots, tmp_path):
    with pytest.raises(ParameterError, match="draws: expected at most 3"):
        muster.simulate(MISSION, Lots(draws=4.0), record=tmp_path / "run.mcap")
    assert lots.calls == []
    assert not list(tmp_path.iterdir())


def test_the_registry_takes_classes_of_coordinations_alone(lots):
    assert {"negotiate", "draw-lots"} <= set(COORDINATIONS)
    with pytest.raises(ParameterError, match="expected a class made from Coordination"):
        COORDINATIONS.add("none", lambda mission: None)


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        ((), 0, "None"),
        (("--draw-lots", "--draws", "2"), 0, "('draw-lots', {'draws': 2})"),
        (("--draws", "2"), 1, "--draws given; expected it together with --draw-lots"),
        (("--draw-lots", "--negotiate"), 1, "--negotiate given; expected it without --draw-lots"),
    ],
)
def test_a_verb_gets_the_name_and_the_settings_of_the_one_asked_for(lots, monkeypatch, options, code, said):
    usable = {"draw-lots": Lots, "negotiate": COORDINATIONS["negotiate"]}
    monkeypatch.setattr(coordination_options, "_USABLE", usable)

    def shown(coordination):
        click.echo(str(coordination))

    verb = click.command()(coordination_options.coordination_options(shown))
    result = CliRunner().invoke(verb, options)
    assert result.exit_code == code
    assert said in (result.output if code == 0 else str(result.exception))
