"""What the tests of the verbs share: a mission of a yard, and how to look at what is printed."""

import json
import sysconfig
from pathlib import Path

MUSTER = Path(sysconfig.get_path("scripts")) / "muster"

MISSION = """\
schema: muster/1
name: yard
suitability:
  beta: {D: 0.9, E: 0.5}
  tau: {E: 0.8}
robots:
  - {id: r_0, type: beta, position: [0, 0], work_capacity: 30, skills: [camera]}
  - {id: r_1, type: tau, position: [9, 0], work_capacity: 12}
tasks:
  - {id: look, type: D, position: [4, 0], requires: [camera]}
  - {id: open, type: E, position: [8, 2]}
  - {id: enter, type: E, position: [7, 4], prerequisites: [open]}
  - {id: lift, type: D, position: [1, 1], requires: [gripper]}
"""
TASKS = 'index,x,y,type,actuation_cost,prerequisites\n1,4,5,D,0,[]\n2,6,1,E,12,[1]\n3,7,2,D,0,"[1,2]"\n'
ROBOTS = "id,type,x,y,work_capacity\nr_0,beta,0,0,50\nr_1,tau,2,0,inf\n"
TABLE = "robot_type,D,E\nbeta,0.9,0.7\ntau,0.5,0.9\n"


def table_rows(out):
    """The rows of a printed table as lists of words."""
    return [line.split() for line in out.splitlines() if line.strip()]


def comparable(path):
    """A plan's text without what is time."""
    data = json.loads(Path(path).read_text(encoding="utf-8"))
    data["elapsed_s"] = None
    data["history"] = [value for _, value in data["history"]]
    return json.dumps(data)


FOUND = "a plan for all tasks was found\n"
