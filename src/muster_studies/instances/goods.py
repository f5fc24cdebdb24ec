"""Published instances with goods and energy: Solomon [solomon1987], Li and Lim [li2001], Schneider [schneider2014]."""

from __future__ import annotations

from importlib.resources import as_file, files

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster_files.instances.electric_vrptw import read_electric_vrptw
from muster_files.instances.li_lim import read_li_lim
from muster_studies.instances.references import numbered

_FOLDER = "goods_instances"
_TRANSPORTS = ("lc101", "lr101")

GOODS_REFERENCES = numbered("goods")
"""By instance and number of robots: the total distance of the best plan known."""


def goods_instance(name: str, robots: int) -> Mission:
    """A shipped instance with so many robots: lc101, lr101 (transports), c101C5, r105C5 or c101_21 (batteries).

    Raises
    ------
    ParameterError
        for any other name.
    """
    names = sorted({instance for instance, _ in GOODS_REFERENCES})
    if name not in names:
        raise ParameterError(f"instance: {name}; expected {' or '.join(names)}")
    read = read_li_lim if name in _TRANSPORTS else read_electric_vrptw
    with as_file(files("muster_studies.instances") / _FOLDER / f"{name}.txt") as path:
        return read(path, robots)
