"""Writes closed missions of several salesmen as TSPLIB, to be read back."""

from muster.mission.errors import Finding, MissionError
from muster.mission.reading.from_data import mission_from


def write_tsplib(mission, path):
    """Write a closed multiple-salesmen mission as TSPLIB, the depot as node 1.

    Raises
    ------
    MissionError
        if the mission is more than salesmen who start at one place, visit plain places and return.
    """
    start = mission.robots[0].position
    tasks = [{"id": str(k), "position": t.position} for k, t in enumerate(mission.tasks, 2)]
    robots = [{"id": f"r_{k}", "position": start} for k in range(len(mission.robots))]
    data = {"name": mission.name, "rules": {"return_to_start": True}, "robots": robots, "tasks": tasks}
    if mission.dimensions == 3 or mission_from(data, mission.source, []) != mission:
        value = "more than TSPLIB can say"
        raise MissionError([Finding(mission.source.file, None, "", value, "salesmen, one depot, plain tasks in 2-D")])
    nodes = [start, *(t.position for t in mission.tasks)]
    name = mission.name.removesuffix(f"-{len(mission.robots)}")
    lines = [f"NAME : {name}", "TYPE : TSP", f"DIMENSION : {len(nodes)}", "EDGE_WEIGHT_TYPE : EUC_2D"]
    lines += ["NODE_COORD_SECTION", *(f"{k} {x!r} {y!r}" for k, (x, y) in enumerate(nodes, 1)), "EOF"]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
