"""docs/events.md lists every kind of event, as the classes in `muster.state` have it.

`python -m tests.docs.test_events_doc` prints the tables anew.
"""

import re
import sys
from dataclasses import MISSING, fields
from inspect import getdoc
from pathlib import Path

from muster.state.event import KINDS
from muster.state.words import MARKS

TEXT = (Path(__file__).parents[2] / "docs" / "events.md").read_text(encoding="utf-8")
PARTS = {
    "task_events": "Tasks",
    "robot_events": "Robots",
    "station_events": "Energy, stations and doors",
    "run_events": "The run",
    "ground_events": "Ground without a map",
}


def rows(part):
    for kind, cls in KINDS.items():
        if cls.__module__.endswith(part):
            told = [one for one in fields(cls) if one.name != "time_s"]
            given = [f"`{one.name}`" for one in told if is_required(one)]
            given += [f"[`{one.name}`]" for one in told if not is_required(one)]
            mark = "by its data" if callable(MARKS[kind]) else MARKS[kind]
            yield f"| `{kind}` | {', '.join(given)} | {' '.join(getdoc(cls).split())} | {mark} |"


def is_required(field):
    return field.default is MISSING and field.default_factory is MISSING


def table(part):
    return "\n".join(["| kind | data | meaning | mark |", "|---|---|---|---|", *rows(part)])


def test_each_part_has_the_table_of_its_classes():
    for part, title in PARTS.items():
        (found,) = re.findall(rf"^## {title}\n\n((?:\|.*\n)+)", TEXT, re.MULTILINE)
        assert found.strip() == table(part), f"python -m {__name__}"


def test_no_kind_is_left_out():
    assert sum(len(list(rows(part))) for part in PARTS) == len(KINDS)


if __name__ == "__main__":
    sys.stdout.write("\n\n".join(f"## {title}\n\n{table(part)}" for part, title in PARTS.items()) + "\n")
