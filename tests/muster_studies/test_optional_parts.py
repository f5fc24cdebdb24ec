"""Each verb prints its help with the core install alone; each study makes its first table with its own extras alone."""

import json
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

import muster
from muster.cli.main import verbs
from muster.mission.yaml_writer import yaml_text
from muster_studies.registry import STUDIES

PARTIAL_INSTALL = Path(__file__).parent.parent / "partial_install.py"
FIRST_TABLE = {"allocators": "6T-2R", "flown": "random", "thesis-6.1": "sizes"}
"""Instead of the first: that of `allocators` is made of all others, the others are made sooner."""
STEERED_ONCE = """
from dataclasses import replace
from muster_studies.market_5.searches import Search
steered, once = Search._steered, []
def first(search, mission, localise):
    if not once:
        once.append(steered(replace(search, world="physics"), mission, localise))
    return once[0]
Search._steered = first
"""
SMALLER = {
    "flown": "from muster_studies.flown import study as s; s.SETTINGS, s._QUICK_PER_SETTING = s.SETTINGS[-1:], 1",
    "jams": "from muster_studies.jams import study; study._QUICK_SCENES = study._QUICK_SCENES[:1]",
    "market-5": STEERED_ONCE,
    "peers": "from muster_studies.peers import study; study._SHORT = study.Limits(0.2, 0.2, 0.2)",
}
"""What makes less of a quick study than a user can: of settings the last, which has a map; of scenes the smallest; of
four runs that in the physics world with all sensors."""
EXTRAS = sorted({study.extras for study in STUDIES.values()})
HELP = [
    ["--help"],
    *([verb, "--help"] for verb in verbs()),
    ["bench", "peers", "--help"],
    ["bench", "peers-timed", "--help"],
    ["bench", "peers-routes", "--help"],
    ["bench", "peers-waiting", "--help"],
    ["bench", "peers-goods", "--help"],
    ["study", "--list"],
]
LACKING = {"physics": ["study", "thesis-6.1"], "plot": ["solve", "6T-2R", "--plot", "plan.png", "-q"]}
"""What cannot be done with the core install alone, by the extra that it needs."""
FAST = ((),)
"""The sets of extras whose studies the fast suite runs; each set costs a process with its imports."""


def group(extras):
    """Tests that look at what one process answers are run by one of xdist's."""
    return pytest.mark.xdist_group("extras " + ",".join(extras))


@pytest.fixture(scope="module")
def one_tag(tmp_path_factory):
    """The call that lets a drone look for one tag in the physics world."""
    mission = muster.load("six-tags")
    file = tmp_path_factory.mktemp("tags") / "one-tag.yaml"
    file.write_text(yaml_text(replace(mission, tasks=mission.tasks[:1], tags=mission.tags[:1])))
    return ["simulate", str(file), "--world", "physics", "--allocator", "greedy", "--format", "json", "-q"]


@pytest.fixture(scope="module")
def answers(one_tag):
    """Gives of each call its exit code, standard output and standard error: one process for each set of extras."""

    @cache
    def of(extras):
        names = names_with(extras)
        others = {(): [*LACKING.values(), *HELP], ("physics",): [one_tag]}.get(extras, [])
        calls = [*others, *map(of_first_table, names)]
        smaller = [SMALLER[name] for name in names if name in SMALLER]
        command = [sys.executable, PARTIAL_INSTALL, ",".join(extras), *map(json.dumps, [*smaller, *calls])]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, "")
        told = map(json.loads, done.stdout.splitlines())
        return {tuple(call): answer for call, answer in zip(calls, told, strict=True)}

    return lambda extras, call: of(extras)[tuple(call)]


def names_with(extras):
    """The studies that need just these extras."""
    return [name for name, study in STUDIES.items() if study.extras == extras]


def of_first_table(name):
    """The call that makes one table of a study with little effort."""
    table = FIRST_TABLE.get(name, STUDIES[name].tables[0])
    call = ["study", name, "--tables", table, "--quick", "--seeds", "1", "--workers", "1", "--format", "json", "-q"]
    return call if name.startswith("peers") else [*call, "--iterations", "20"]  # solvers of peers have the same time


@pytest.mark.long
@group(())
def test_every_verb_says_its_help_with_the_core_install_alone(answers):
    assert {"study", "bench"} <= {call[0] for call in HELP}
    for call in HELP:
        code, out, err = answers((), call)
        assert (code, err) == (0, ""), call
        assert "cannot be loaded" not in out
    assert all(name in out for name in STUDIES)  # of the last call


@pytest.mark.parametrize(
    "extras",
    [
        pytest.param(
            extras,
            marks=[group(extras)] if extras in FAST else [group(extras), pytest.mark.long],
            id=",".join(extras) or "none",
        )
        for extras in EXTRAS
    ],
)
def test_the_first_table_needs_the_extras_of_its_study_alone(answers, extras):
    for call in map(of_first_table, names_with(extras)):
        code, out, err = answers(extras, call)
        assert (code, err) == (0, ""), call
        assert call[3] in [made["number"] for made in json.loads(out)["tables"]]


@group(("physics",))
@pytest.mark.long
def test_a_drone_finds_a_tag_in_the_physics_world_with_that_extra_alone(answers, one_tag):
    """As in the tables of `thesis-6.1` that take long; only pictures of a study import later than it does."""
    code, out, err = answers(("physics",), one_tag)
    assert (code, err) == (0, "")
    (found,) = json.loads(out)["found"]
    assert found["tag"] == 1
    assert found["error_m"] < 0.01


@group(())
@pytest.mark.parametrize("extra", LACKING)
def test_an_extra_is_absent_in_such_an_environment(answers, extra):
    """Else these tests could not fail."""
    code, _, err = answers((), LACKING[extra])
    assert code == 2
    assert f"muster-robotics[{extra}]" in err
