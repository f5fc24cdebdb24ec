"""What docs/execution.md says is so."""

import re
from pathlib import Path

TEXT = (Path(__file__).parents[2] / "docs" / "execution.md").read_text(encoding="utf-8")


def test_an_executor_in_a_world(capsys):
    exec(re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL)[1], {})
    assert "'tasks_lost': []" in capsys.readouterr().out


def test_a_fleet_of_ones_own(capsys):
    blocks = re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL)
    names = {}
    exec(blocks[1], names)
    capsys.readouterr()
    exec(blocks[2], names)
    assert "the mission is over" in capsys.readouterr().out
    assert set(names["report"].tasks_done) == {task.id for task in names["mission"].tasks}


def test_a_mission_goes_on_as_far_as_it_is_let(capsys):
    example = re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL)[0]
    names = {}
    exec(example, names)
    simulation = names["simulation"]
    assert simulation.done
    assert "late" in simulation.result().tasks_done
    ends = simulation.result().ends_s
    assert all(ends[task.task] <= 30 for task in simulation.result().tasks if task.robot == "r_1")
    assert " is at task " in capsys.readouterr().out
