"""Each verb prints its help with the core install alone; each study makes its first table with its own extras alone."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import muster
from muster.cli.main import VERBS, other_verbs
from muster.mission.yaml_writer import yaml_text
from muster_studies.registry import STUDIES

PARTIAL_INSTALL = Path(__file__).parent.parent / "partial_install.py"
FIRST_TABLE = {"allocators": "6T-2R", "flown": "random", "thesis-6.1": "sizes"}
"""Instead of the first: that of `allocators` is made of all others, the others are made sooner."""
SMALLER = {
    "flown": "from muster_studies.flown import study as s; s.SETTINGS, s._QUICK_PER_SETTING = s.SETTINGS[-1:], 1",
    "jams": "from muster_studies.jams import study; study._QUICK_SCENES = study._QUICK_SCENES[:1]",
    "peers": "from muster_studies.peers import study; study._SHORT = study.Limits(0.2, 0.2, 0.2)",
}
"""What makes less of a quick study than a user can: of settings the last, which has a map; of scenes the smallest."""
EXTRAS = sorted({study.extras for study in STUDIES.values()})


def with_extras(extras, *calls):
    """Exit code, standard output and standard error of each call of the command, with these extras alone."""
    command = [sys.executable, PARTIAL_INSTALL, ",".join(extras), *map(json.dumps, calls)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_every_verb_says_its_help_with_the_core_install_alone():
    verbs = [*VERBS, *other_verbs()]
    assert {"study", "bench"} <= set(verbs)
    calls = [
        ["--help"],
        *([verb, "--help"] for verb in verbs),
        ["bench", "peers", "--help"],
        ["bench", "peers-timed", "--help"],
        ["study", "--list"],
    ]
    for call, (code, out, err) in zip(calls, with_extras((), *calls), strict=True):
        assert (code, err) == (0, ""), call
        assert "cannot be loaded" not in out
    assert all(name in out for name in STUDIES)  # of the last call


def of_first_table(name):
    """The call that makes one table of a study with little effort."""
    table = FIRST_TABLE.get(name, STUDIES[name].tables[0])
    call = ["study", name, "--tables", table, "--quick", "--seeds", "1", "--workers", "1", "--format", "json", "-q"]
    return call if name.startswith("peers") else [*call, "--iterations", "20"]  # solvers of peers have the same time


@pytest.mark.parametrize("extras", EXTRAS, ids=lambda extras: ",".join(extras) or "none")
def test_the_first_table_needs_the_extras_of_its_study_alone(extras):
    names = [name for name, study in STUDIES.items() if study.extras == extras]
    calls = [of_first_table(name) for name in names]
    smaller = [SMALLER[name] for name in names if name in SMALLER]
    for call, (code, out, err) in zip(calls, with_extras(extras, *smaller, *calls), strict=True):
        assert (code, err) == (0, ""), call
        assert call[3] in [made["number"] for made in json.loads(out)["tables"]]


def test_a_drone_finds_a_tag_in_the_physics_world_with_that_extra_alone(tmp_path):
    """As in the tables of `thesis-6.1` that take long; only pictures of a study import later than it does."""
    mission = muster.load("six-tags")
    file = tmp_path / "one-tag.yaml"
    file.write_text(yaml_text(replace(mission, tasks=mission.tasks[:1], tags=mission.tags[:1])))
    call = ["simulate", str(file), "--world", "physics", "--allocator", "greedy", "--format", "json", "-q"]
    ((code, out, err),) = with_extras(("physics",), call)
    assert (code, err) == (0, "")
    (found,) = json.loads(out)["found"]
    assert found["tag"] == 1
    assert found["error_m"] < 0.01


def test_an_extra_is_absent_in_such_an_environment():
    """Else these tests could not fail."""
    (code, _, err), (missing, _, why) = with_extras(
        (), ["study", "thesis-6.1"], ["solve", "6T-2R", "--plot", "plan.png", "-q"]
    )
    assert (code, missing) == (2, 2)
    assert "muster-robotics[physics]" in err
    assert "muster-robotics[plot]" in why
