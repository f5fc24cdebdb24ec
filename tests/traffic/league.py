"""Small instances of the League of Robot Runners, made for tests."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from tests.muster_studies.movingai_maps import map_text

from muster.traffic.lifelong.league_instance import LeagueInstance


def league(rows: Sequence[str], starts: Sequence[int], tasks: Sequence[Sequence[int]], revealed: int) -> LeagueInstance:
    """Return an instance on a map whose blocked cells are `#`."""
    blocked = np.array([[cell == "#" for cell in row] for row in rows])
    return LeagueInstance("test", blocked, list(starts), [list(task) for task in tasks], revealed)


def random_league(rows: Sequence[str], robots: int, seed: int, ratio: float = 1.5) -> LeagueInstance:
    """Return an instance with random starts, and 200 random tasks of one to four cells."""
    cells = [k for k, cell in enumerate("".join(rows)) if cell != "#"]
    random = np.random.default_rng(seed)
    starts = random.permutation(cells)[:robots].tolist()
    tasks = [random.choice(cells, size=random.integers(1, 5)).tolist() for _ in range(200)]
    return league(rows, starts, tasks, max(1, round(ratio * robots)))


def write_league(folder: Path, instance: LeagueInstance, ratio: float = 1.5) -> Path:
    """Write the files of an instance, and return the one that names the others."""
    (folder / "a.map").write_text(map_text(instance.blocked))
    (folder / "a.agents").write_text("\n".join(map(str, ["# robots", len(instance.starts), *instance.starts])) + "\n")
    lines = [",".join(map(str, task)) for task in instance.tasks]
    (folder / "a.tasks").write_text("\n".join(["# tasks", str(len(lines)), *lines]) + "\n")
    fields = {
        "mapFile": "a.map",
        "agentFile": "a.agents",
        "teamSize": len(instance.starts),
        "taskFile": "a.tasks",
        "numTasksReveal": ratio,
        "version": "2024 LoRR",
    }
    (folder / "a.json").write_text(json.dumps(fields))
    return folder / "a.json"
