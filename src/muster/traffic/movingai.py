"""Maps and scenarios of the MovingAI benchmarks: files `.map` and `.scen` ([stern2019])."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from muster.mission.errors import Finding, InputError
from muster.mission.texts.text_files import read_text

Bools = npt.NDArray[np.bool_]
Cell = tuple[int, int]
"""(row, column), from 0."""
_FREE = frozenset(".EGS")
_BLOCKED = frozenset("@OTW")


@dataclass(frozen=True)
class Ends:
    """One line of a scenario: where a robot starts and where it is to go, as (row, column)."""

    start: Cell
    goal: Cell


def read_map(path: Path) -> Bools:
    """Which cells of a `.map` are blocked, (rows, columns).

    `.`, `G`, `S`, and `E` of the League of Robot Runners are free; `@`, `O`, `T` and `W` are blocked.

    Raises
    ------
    InputError
        where the file is no such map, with the line.
    OSError
        where it cannot be read.
    """
    lines = read_text(path).splitlines()
    head = {line.split()[0]: line.split()[-1] for line in lines[:3] if line.strip()}
    for line, key in enumerate(("type", "height", "width"), 1):
        if key not in head or (key != "type" and not head[key].isdigit()):
            raise _wrong(path, line, key, head.get(key, "missing"), f"a line `{key}` with its value")
    rows, columns = int(head["height"]), int(head["width"])
    if len(lines) < 4 + rows or lines[3].strip() != "map":
        raise _wrong(path, 4, "map", f"{max(0, len(lines) - 4)} rows", f"`map` and {rows} rows")
    for line, row in enumerate(lines[4 : 4 + rows], 5):
        if len(row) != columns or not set(row) <= _FREE | _BLOCKED:
            raise _wrong(path, line, "row", row, f"{columns} cells of {' '.join(sorted(_FREE | _BLOCKED))}")
    return np.array([[cell in _BLOCKED for cell in row] for row in lines[4 : 4 + rows]], dtype=np.bool_)


def read_scenario(path: Path) -> list[Ends]:
    """The robots of a `.scen`, in its order.

    Raises
    ------
    InputError
        where the file is no such scenario, with the line.
    OSError
        where it cannot be read.
    """
    lines = read_text(path).splitlines()
    if not lines or lines[0].split()[:1] != ["version"]:
        raise _wrong(path, 1, "", lines[0] if lines else "empty", "`version 1`")
    ends = []
    for line, text in enumerate(lines[1:], 2):
        if not text.strip():
            break
        parts = text.split()
        if len(parts) != 9 or not all(part.isdigit() for part in parts[4:8]):
            raise _wrong(path, line, "", text, "bucket, map, width, height, start x and y, goal x and y, length")
        x, y, goal_x, goal_y = map(int, parts[4:8])
        ends.append(Ends((y, x), (goal_y, goal_x)))
    return ends


def require_fitting(path: Path, ends: Sequence[Ends], blocked: Bools) -> None:
    """Raise `InputError` where a robot of a scenario has no free cell of a map, or one that another has.

    Parameters
    ----------
    path : Path
        The scenario file, for the message.
    ends : Sequence[Ends]
        The robots of the file, from its first on.
    blocked : Bools
        Which cells of the map are blocked, (rows, columns).
    """
    for side in ("start", "goal"):
        taken: dict[Cell, int] = {}
        for robot, one in enumerate(ends):
            row, column = cell = getattr(one, side)
            line, told = robot + 2, f"x {column}, y {row}"
            if row >= blocked.shape[0] or column >= blocked.shape[1] or blocked[cell]:
                raise _wrong(path, line, side, told, f"a free cell of the map, {blocked.shape[1]} x {blocked.shape[0]}")
            if cell in taken:
                raise _wrong(path, line, side, told, f"a cell that no other robot has; line {taken[cell]} has it")
            taken[cell] = line


def _wrong(path: Path, line: int, field: str, value: str, expected: str) -> InputError:
    return InputError([Finding(str(path), line, field, value, expected)])
