"""Which reader an instance file of the field is for, by its first lines."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path as FilePath

from muster.mission.model import Mission
from muster.mission.texts.text_files import first_lines
from muster_files.instances.cordeau import looks_like_cordeau, read_cordeau
from muster_files.instances.electric_vrptw import looks_like_electric_vrptw, read_electric_vrptw
from muster_files.instances.li_lim import looks_like_li_lim, read_li_lim
from muster_files.instances.line_fates import LineFates
from muster_files.instances.solomon import looks_like_solomon, read_solomon
from muster_files.instances.vrplib import TYPES, read_vrplib
from muster_files.number_rows import Row, text_rows

VehicleReader = Callable[[FilePath, int | None, LineFates | None], Mission]
"""Reads an instance file with so many robots, or with as many as the file says; tells what becomes of its lines."""

TSPLIB = "TSPLIB"
"""In place of a reader: a file of TSPLIB, which has no robots of its own."""

_LAYOUTS: tuple[tuple[Callable[[Sequence[Row]], bool], VehicleReader], ...] = (
    (looks_like_electric_vrptw, read_electric_vrptw),
    (looks_like_li_lim, read_li_lim),
    (looks_like_cordeau, read_cordeau),
    (looks_like_solomon, read_solomon),
)
_OTHER_FORMS = (".yaml", ".yml", ".csv", ".json", ".sol")
_TYPE = re.compile(r"^TYPE\s*:\s*(\w*)", re.MULTILINE)


def instance_form(path: FilePath) -> VehicleReader | str | None:
    """The reader of a file, or TSPLIB; None for a file of another form. What decides are its first lines."""
    suffix = path.suffix.lower()
    if suffix in _OTHER_FORMS or not path.is_file():
        return TSPLIB if suffix in (".tsp", ".atsp") else None
    text = first_lines(path)
    kind = _TYPE.search(text)
    if suffix == ".vrp" or (kind is not None and kind[1] in TYPES):
        return read_vrplib
    if suffix in (".tsp", ".atsp") or kind is not None:
        return TSPLIB
    rows = text_rows(text)
    return next((reader for looks_so, reader in _LAYOUTS if looks_so(rows)), None)
