"""Files of orders: events in order of time, and one line that says what is wrong with one."""

import pytest

from muster.mission.errors import MissionError
from muster.mission.model import Event, Task
from muster.mission.reading.order_files import OrderFile

HEAD = "at_s,id,x,y"


def written(tmp_path, text, name="orders.csv"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_csv_has_new_tasks(tmp_path):
    text = f"{HEAD},priority,duration_s,prerequisites\n0.5,a,1,2,,3,\n\n2,b,3,4.5,5,,a\n"
    orders = OrderFile(written(tmp_path, text))
    assert list(orders) == [
        Event(at_s=0.5, new_task=Task(id="a", position=(1, 2), duration_s=3)),
        Event(at_s=2, new_task=Task(id="b", position=(3, 4.5), priority=5, prerequisites=("a",))),
    ]
    assert list(orders) == list(orders)


def test_json_lines_have_all_that_concerns_tasks(tmp_path):
    text = '{"at_s": 1, "new_task": {"id": "a", "position": [1, 2, 3]}}\n\n{"at_s": 1, "cancel_task": "a"}\n'
    new, cancelled = OrderFile(written(tmp_path, text, "orders.jsonl"))
    assert (new.new_task.position, cancelled.cancel_task) == ((1, 2, 3), "a")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "orders.csv:1: at_s: missing column; expected the columns at_s,id,x,y, and if wanted z"),
        (f"{HEAD},colour\n", "orders.csv:1: colour: unknown column; expected the columns"),
        (f"{HEAD},x\n", "orders.csv:1: x: repeated column; expected the columns"),
        (f"{HEAD}\n1,a,2\n", "orders.csv:2: 3 cells; expected 4, one for each column"),
        (f"{HEAD}\n1,a,2,b\n", 'orders.csv:2: new_task.position[1]: "b"; expected a finite number'),
        (f"{HEAD}\n-1,a,2,3\n", "orders.csv:2: at_s: -1.0; expected a finite number, at least 0"),
        (f"{HEAD}\n2,a,2,3\n1,b,2,3\n", "orders.csv:3: at_s: 1; expected at least 2: lines are in order of time"),
        (f'{HEAD}\n1,"a,2,3\n', "unexpected end of data; expected CSV"),
        (b"at_s,id,x,y\n1,\xff,2,3\n", "is not UTF-8; expected a text in UTF-8"),
    ],
)
def test_what_is_wrong_in_csv_is_said_with_file_and_line(tmp_path, text, message):
    with pytest.raises(MissionError) as found:
        OrderFile(written(tmp_path, text))
    assert message in str(found.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", 'orders.jsonl:1: "{"; expected an event as JSON'),
        ("[1]", "orders.jsonl:1: [1]; expected an event"),
        ('{"at_s": 1, "new_tsk": 1}', "new_tsk: unknown key; expected a known key; did you mean 'new_task'?"),
        ('{"at_s": 1, "robot_fails": "r"}', "robot_fails: no order; expected one of new_task, cancel_task, move_task"),
        ('{"at_s": 1, "new_task": {"id": "a"}}', "orders.jsonl:1: new_task"),
    ],
)
def test_what_is_wrong_in_json_lines_is_said_with_file_and_line(tmp_path, text, message):
    with pytest.raises(MissionError) as found:
        OrderFile(written(tmp_path, text, "orders.jsonl"))
    assert message in str(found.value)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(MissionError, match=r"nowhere.csv: No such file or directory; expected a file to read"):
        OrderFile(tmp_path / "nowhere.csv")
