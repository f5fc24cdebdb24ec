"""The weights of TSPLIB and VRPLIB files as travel tables of missions that are in other files."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path as FilePath

from muster.mission.errors import Finding, MissionError
from muster.mission.site import TravelTable
from muster_files.instances.keyword_files import is_keyword_file, read_keyword_file


def read_weights(path: FilePath, robots: Sequence[str], others: Collection[str]) -> TravelTable | None:
    """Return the table of an instance file, in which robots start at the one node that is not among `others`.

    Returns None for a file of another kind.

    Raises
    ------
    MissionError
        if the file cannot be read, or has not one such node.
    """
    if not is_keyword_file(path):
        return None
    from muster_files.instances.weighted_nodes import weighted_nodes  # NumPy is not loaded for tables in CSV

    nodes = weighted_nodes(read_keyword_file(path), exact=False)
    depots = [node.id for node in nodes.nodes if node.id not in others]
    if len(depots) != 1 or nodes.weights is None:
        value = f"{len(depots)} nodes that are no tasks of the mission"
        raise MissionError([Finding(str(path), None, "", value, "one, where the robots start")])
    return nodes.travel_table(robots, depots[0])
