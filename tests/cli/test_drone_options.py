"""--wind, --gusts, --rotors, --battery and --drain of `simulate`."""

import json
from importlib.util import find_spec

import pytest

from muster.cli.drone_options import conditions_of
from muster.cli.main import run as muster
from muster.mission.errors import ParameterError
from muster.simulation import Wind

CALM = ("6T-2R", "--iterations", "20", "-q", "--format", "json")


def test_options_become_arguments():
    assert conditions_of(None, None, (), (), rotors=False) == {}
    assert conditions_of("3,-1", 7.7, ("all=1", "r_0=0.5"), ("r_1=2",), rotors=True) == {
        "wind": Wind(velocity_mps=(3.0, -1.0, 0.0), gusts_mps=7.7),
        "batteries": {"all": 1.0, "r_0": 0.5},
        "drain": {"r_1": 2.0},
        "rotor_level": True,
    }
    assert conditions_of("1,2,3", None, (), (), rotors=False)["wind"].velocity_mps == (1.0, 2.0, 3.0)
    assert conditions_of(None, 5.0, (), (), rotors=False)["wind"].gusts_mps == 5.0


@pytest.mark.parametrize("wind", ["3", "a,b", "1,2,3,4", "nan,0"])
def test_winds_that_are_none_are_refused(wind):
    with pytest.raises(ParameterError, match="expected"):
        conditions_of(wind, None, (), (), rotors=False)


@pytest.mark.parametrize("batteries", [("0.5",), ("r_0=x",), ("r_0=1", "r_0=0.5")])
def test_batteries_that_are_none_are_refused(batteries):
    with pytest.raises(ParameterError, match="--battery"):
        conditions_of(None, None, batteries, (), rotors=False)


@pytest.mark.parametrize("drain", [("x",), ("r_0=1", "r_0=2")])
def test_drains_that_are_none_are_refused(drain):
    with pytest.raises(ParameterError, match="--drain"):
        conditions_of(None, None, (), drain, rotors=False)


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (("--wind", "1,1"), "has no wind"),
        (("--gusts", "5"), "has no wind"),
        (("--rotors",), "has no rotors"),
        (("--battery", "nobody=1"), "nobody"),
        (("--battery", "all=1"), "no work_capacity"),
    ],
)
def test_what_the_kinematic_world_does_not_have_is_refused(options, why, capsys):
    assert muster(["simulate", *CALM, *options]) == 2
    assert why in capsys.readouterr().err


def test_reports_have_charges(capsys):
    call = ["simulate", "31T-6R50", "--iterations", "20", "-q", "--battery", "all=0.9", "--battery", "r_1=1"]
    assert muster([*call, "--format", "json"]) == 0
    charges = {row["robot"]: row["charge"] for row in json.loads(capsys.readouterr().out)["robots"]}
    assert all(0 <= charge <= 1 for charge in charges.values())
    assert min(charges.values()) < 0.8
    assert muster(call) == 0
    assert f"{100 * charges['r_1']:.1f} %" in capsys.readouterr().out


@pytest.mark.skipif(find_spec("mujoco") is None, reason="the extra `physics` is not installed")
def test_drones_fly_in_wind(tmp_path, capsys):
    (tmp_path / "m.yaml").write_text(
        "schema: muster/1\nname: m\n"
        "robots: [{id: a, position: [0, 0, 1], kind: air, kinematics: hexacopter, radius_m: 0.35}]\n"
        "tasks: [{id: t, position: [2, 0, 1]}]\n"
    )
    call = ["simulate", str(tmp_path / "m.yaml"), "--world", "physics", "--wind", "4,1", "--gusts", "5"]
    assert muster([*call, "--battery", "a=1", "--iterations", "5", "-q", "--format", "json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["tasks_done"] == ["t"]
    assert 0.9 < report["robots"][0]["charge"] < 1
