"""What the documents say is so."""

import json
import re
import tomllib
from dataclasses import fields
from pathlib import Path

import pytest

from muster.allocation.bounds.of_objective import WHY
from muster.allocation.registry import ALLOCATORS
from muster.allocation.search import search
from muster.cli.main import run, verbs
from muster.mission.model import Battery, Map, Mission, Robot, Rules, Station, Task, Zone
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.records import specified
from muster.mission.system.clock import ProcessorClock
from muster.planning.options import DEFAULT_ALLOCATOR

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
MISSION_FILE = (ROOT / "docs" / "mission-file.md").read_text(encoding="utf-8")


def blocks(text, language):
    return re.findall(rf"```{language}\n(.*?)```", text, flags=re.DOTALL)


@pytest.mark.long
def test_the_python_example_of_the_readme_runs(tmp_path, monkeypatch):
    example = blocks(README, "python")[0]  # the other one: tests/examples/test_ways_in.py
    monkeypatch.chdir(tmp_path)
    exec(compile(example.replace("time_limit=1.0", "iterations=50"), "README.md", "exec"), {})
    assert (tmp_path / "plan.json").stat().st_size > 0
    assert (tmp_path / "plan.png").stat().st_size > 0


def test_the_python_example_of_the_records_runs(tmp_path, monkeypatch):
    pytest.importorskip("mcap")
    (example,) = blocks((ROOT / "docs" / "records.md").read_text(encoding="utf-8"), "python")
    monkeypatch.chdir(tmp_path)
    exec(compile(example, "records.md", "exec"), {})
    assert (tmp_path / "replay.html").stat().st_size > 0


def test_the_topics_of_a_record_are_described():
    from muster.report.record.schemas import TOPICS

    text = (ROOT / "docs" / "records.md").read_text(encoding="utf-8")
    assert dict(re.findall(r"^\| `(/[a-z/]+)` \| `([A-Za-z.]+)` \|", text, flags=re.MULTILINE)) == TOPICS


def test_the_verbs_that_are_shown_are_those_of_the_command():
    text = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    used = {
        line.split()[1]
        for block in blocks(text, "sh")
        for line in block.splitlines()
        if line.startswith("muster ") and not line.startswith("muster --")
    }
    assert used == {*verbs()}


@pytest.mark.parametrize("verb", verbs())
def test_every_verb_has_help(verb, capsys):
    assert run([verb, "--help"]) == 0
    assert f"muster {verb}" in capsys.readouterr().out


def test_every_allocator_is_described():
    text = (ROOT / "docs" / "algorithms.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([a-z+-]+)`( \(default\))? \|", text, flags=re.MULTILINE)
    assert {name for name, _ in rows} == set(ALLOCATORS)
    assert [name for name, default in rows if default] == [DEFAULT_ALLOCATOR]


def test_the_parameters_of_search_are_described():
    text = (ROOT / "docs" / "search.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`[a-z_`, ]+`) \| ([0-9., ]+|none) \|", text, flags=re.MULTILINE)
    described = {
        name.strip(" `"): default if default == "none" else float(default)
        for names, defaults in rows
        for name, default in zip(names.split(","), defaults.split(","), strict=True)
    }
    assert described == {f.name: f.default for f in fields(search.Parameters)}


def test_every_argument_of_a_bound_is_described():
    rows = re.findall(
        r"^\| ([a-z ]+) \|", (ROOT / "docs" / "bounds.md").read_text(encoding="utf-8"), flags=re.MULTILINE
    )
    assert set(WHY) - set(rows) == {"no tasks", "a task that nobody can do"}


def test_the_outputs_of_what_can_be_done(tmp_path, monkeypatch, capsys):
    pytest.importorskip("ortools")
    monkeypatch.setattr(
        "muster.allocation.remedies.conflicts.SystemClock", ProcessorClock
    )  # the load of the machine counts not
    text = (ROOT / "docs" / "what-can-be-done.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    for mission in blocks(text, "yaml"):
        Path(f"{parse_yaml(mission, Path('example.yaml')).name}.yaml").write_text(mission, encoding="utf-8")
    shown = [part for block in blocks(text, "console") for part in block.split("$ muster ")[1:]]
    assert len(shown) >= 7
    for part in shown:
        command, *output = part.splitlines()
        code = run(command.split())
        printed = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
        assert [line for line in printed if line] == output
        assert code == (3 if any("can never be done" in line for line in output[:1]) else 0)


def test_every_key_of_a_mission_is_described():
    keys = {f.name for model in (Mission, Rules, Robot, Task, Station, Battery) for f in specified(model)}
    described = set(re.findall(r"`([a-z_0-9]+)`", MISSION_FILE))
    assert keys - described == set()


def test_the_example_missions_are_missions():
    whole = [example for example in blocks(MISSION_FILE, "yaml") if example.startswith("schema:")]
    assert len(whole) == 12
    assert all(parse_yaml(example, Path("example.yaml")).tasks for example in whole)


def test_the_example_of_motion_runs():
    (example,) = blocks((ROOT / "docs" / "motion.md").read_text(encoding="utf-8"), "python")
    names = {}
    exec(compile(example, "motion.md", "exec"), names)
    assert names["motion"].positions[-1].tolist() == [4, 4]


DOCUMENTS = sorted(str(file.relative_to(ROOT)) for folder in (ROOT, ROOT / "docs") for file in folder.glob("*.md"))


@pytest.mark.parametrize("name", DOCUMENTS)
def test_links_lead_somewhere(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text):
        assert ((ROOT / name).parent / target).exists(), target


def test_pictures_of_the_readme_are_there():
    for name in re.findall(r"!\[[^]]*\]\(([^)]+)\)", README):
        assert (ROOT / name).stat().st_size > 0


def test_the_examples_of_maps():
    pytest.importorskip("shapely")
    import numpy as np

    from muster.motion.map_world import World

    text = (ROOT / "docs" / "maps.md").read_text(encoding="utf-8")
    rest = "\nschema: muster/1\nrobots: [{id: r_0, position: [1, 1]}]\ntasks: []\n"
    *parts, doors = blocks(text, "yaml")
    *images, polygons = [parse_yaml(part + rest, Path("m.yaml")) for part in parts]
    assert World.of(parse_yaml(doors, Path("m.yaml"))).closed == {"north"}
    assert [(m.map.ros_yaml, m.map.image) for m in images] == [("floor.yaml", None), (None, "floor.png")]
    assert World.of(polygons).clearance(np.array([[1.0, 1.0]]), "ground") == 1
    (example,) = blocks(text, "python")
    names = {}
    exec(compile(example, "maps.md", "exec"), names)
    points = np.array([[3.0, 3.0, 0.0], [14.2, 20.0, 0.0], [10.0, 20.0, 0.0]])
    assert names["free"](names["space"], points).tolist() == [True, False, True]
    assert names["world"].clearance(points, "ground")[2] == 4


def test_the_example_of_paths_runs():
    pytest.importorskip("shapely")
    (example,) = blocks((ROOT / "docs" / "paths.md").read_text(encoding="utf-8"), "python")
    names = {}
    exec(compile(example, "paths.md", "exec"), names)
    assert names["answer"].length_m > names["finder"].path((2, 2), (36, 20)).length_m > 38


def test_the_example_of_avoidance_runs(capsys):
    (example,) = blocks((ROOT / "docs" / "avoidance.md").read_text(encoding="utf-8"), "python")
    names = {}
    exec(compile(example, "avoidance.md", "exec"), names)
    assert (names["ways"].arrivals_s < 60).all()
    assert len(names["ways"].contacts) == 0
    assert capsys.readouterr().out


def test_every_key_of_a_map_is_described():
    section = MISSION_FILE.split("## Map", 1)[1].split("\n## ", 1)[0]
    assert {f.name for model in (Map, Zone) for f in specified(model)} <= set(re.findall(r"`([a-z_0-9]+)`", section))


def test_the_index_links_to_every_document():
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    documents = {file.name for file in (ROOT / "docs").glob("*.md")}
    assert set(re.findall(r"\]\(([a-z0-9-]+\.md)", index)) == documents - {"index.md"}
    assert "](docs/index.md)" in README


def test_the_index_lists_every_extra():
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8").split("## Extras", 1)[1]
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    described = set(re.findall(r"^\| `([a-z0-9]+)` \|", index, flags=re.MULTILINE))
    assert described == {name for name, needs in project["optional-dependencies"].items() if needs}


def test_the_readme_is_short():
    assert len(README.split()) <= 900


@pytest.mark.parametrize(
    "name", ["allocators", *(f"benchmarks{of}" for of in ("", "-timed", "-routes", "-waiting", "-goods", "-scale"))]
)
def test_pages_that_a_command_writes_are_as_it_wrote_them(name):
    stored = json.loads((ROOT / "docs" / "measured" / f"{name}.json").read_text(encoding="utf-8"))
    text = (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
    assert text.splitlines() == stored["output"]
    assert f"Made by `{stored['command']}`" in text
