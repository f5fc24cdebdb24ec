"""The README's three ways in, with its own commands and files: a researcher, a plant, a warehouse."""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from tools.docs_check.consoles import elided_lines

import muster

ROOT = Path(__file__).parents[2]
PLANT = pytest.mark.xdist_group("plant")  # they share what the README's commands made
README = (ROOT / "README.md").read_text(encoding="utf-8")


def block(title):
    """The code below a title of the README."""
    after = README.split(f"**{title}.**", 1)[1]
    return re.search(r"```\w+\n(.*?)```", after, re.DOTALL)[1]


@pytest.fixture(scope="module")
def run():
    """Runs commands of a shell in a folder, each with its output."""
    path = os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]])

    def run(commands, folder):
        done = subprocess.run(
            ["bash", "-e", "-c", commands],
            cwd=folder,
            capture_output=True,
            encoding="utf-8",
            check=False,
            env=os.environ | {"PATH": path, "COLUMNS": "80"},
        )
        assert done.returncode == 0, done.stdout + done.stderr
        assert elided_lines(done.stdout) == []
        return done.stdout

    return run


@pytest.fixture(scope="module")
def plant(tmp_path_factory, run):
    folder = tmp_path_factory.mktemp("ways") / "plant"
    shutil.copytree(ROOT / "examples" / "plant", folder)
    run(block("Inspect a plant"), folder)
    return folder


@pytest.mark.long
def test_a_researcher_compares_an_allocator_of_her_own(tmp_path):
    code = block("Compare methods")
    (tmp_path / "notebook.py").write_text(code, encoding="utf-8")
    narrow = os.environ | {"COLUMNS": "80"}
    done = subprocess.run(
        [sys.executable, "notebook.py"], cwd=tmp_path, capture_output=True, text=True, check=False, env=narrow
    )
    assert done.returncode == 0, done.stderr
    assert elided_lines(done.stdout) == []
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert all(name in done.stdout for name in ("one_after_another", "greedy", "search", "gap_mean"))
    with (tmp_path / "comparison.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert {row["allocator"] for row in rows} == {"one_after_another", "greedy", "search"}
    assert len(rows) == 10 * 3 * 2
    assert {row["status"] for row in rows} == {"done"}
    assert (tmp_path / "profile.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.long
@PLANT
def test_a_plant_is_inspected_within_its_windows(plant):
    mission, plan = muster.load(plant / "plant.yaml"), muster.read_plan(plant / "plan.json")
    assert len(mission.tasks) == 80 + 4 + 2
    assert muster.verify(mission, plan).valid
    assert plan.tasks_completed == plan.tasks_total
    report = muster.simulate(mission, plan)
    assert not report.tasks_lost
    windows = {task.id: task.window_s for task in mission.tasks if task.window_s}
    assert len(windows) == 84
    assert all(any(low <= report.starts_s[name] <= high for low, high in windows[name]) for name in windows)


@pytest.mark.long
@PLANT
def test_a_plant_gets_sheets_and_flights(plant):
    assert (plant / "sheets.pdf").read_bytes().startswith(b"%PDF")
    flights = [json.loads(file.read_text(encoding="utf-8")) for file in sorted((plant / "flights").iterdir())]
    assert [flight["fileType"] for flight in flights] == ["Plan", "Plan"]
    items = [item for flight in flights for item in flight["mission"]["items"]]
    assert [item.get("complexItemType") for item in items].count("survey") == 2


@pytest.mark.long
def test_a_warehouse_does_its_orders_and_charges(tmp_path, run):
    folder = tmp_path / "warehouse"
    shutil.copytree(ROOT / "examples" / "warehouse", folder)
    printed = run(block("Run a warehouse"), folder)
    assert "30: 30 done" in printed
    assert "0 contacts" in printed
