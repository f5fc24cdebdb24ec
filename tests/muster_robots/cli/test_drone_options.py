"""--wind, --gusts, --rotors, --battery and --drain of `simulate`."""

import json
from importlib.util import find_spec

import pytest

from muster.cli.main import run as muster
from muster.mission.errors import ParameterError
from muster.simulation import Wind

CALM = ("6T-2R", "--iterations", "20", "-q", "--format", "json")


@pytest.fixture
def asked(monkeypatch):
    """Gives the request that `muster simulate` makes of options."""
    from muster.cli.local_backend import LocalBackend

    def of(*options):
        made = []

        def take(self, mission, plan, request, on_line):
            made.append(request)
            raise ParameterError("enough")

        monkeypatch.setattr(LocalBackend, "simulate", take)
        assert muster(["simulate", *CALM, *options]) == 2
        return made[0] if made else None

    return of


def test_options_become_fields(asked):
    assert asked().as_settings().keys() == {"planning"}
    request = asked("--wind=3,-1", "--gusts=7.7", "--battery=all=1", "--battery=r_0=0.5", "--drain=r_1=2", "--rotors")
    assert request.wind == Wind(velocity_mps=(3.0, -1.0, 0.0), gusts_mps=7.7)
    assert (request.batteries, request.drain, request.rotor_level) == ({"all": 1.0, "r_0": 0.5}, {"r_1": 2.0}, True)
    assert asked("--wind=1,2,3").wind.velocity_mps == (1.0, 2.0, 3.0)
    assert asked("--gusts=5").wind.gusts_mps == 5.0
    assert asked("--drain=2").drain == {"all": 2.0}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        *((("--wind", wind), "wind.velocity_mps: ") for wind in ("3", "a,b", "1,2,3,4", "nan,0")),
        *((("--battery", given), "--battery: ") for given in ("0.5", "=1")),
        (("--battery", "r_0=x"), 'batteries.r_0: "x"; expected a finite number, at least 0 and at most 1'),
        (("--battery", "r_0=1", "--battery", "r_0=0.5"), "--battery: r_0=0.5; expected ROBOT=SHARE, each name at most"),
        (("--drain", "x"), 'drain.all: "x"; expected a finite number, above 0'),
        (("--drain", "r_0=1", "--drain", "r_0=2"), "--drain: r_0=2; expected [ROBOT=]FACTOR, each name at most once"),
    ],
)
def test_conditions_that_are_none_are_refused(asked, capsys, options, message):
    assert asked(*options) is None
    assert capsys.readouterr().err.startswith(message)


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


@pytest.mark.long
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
