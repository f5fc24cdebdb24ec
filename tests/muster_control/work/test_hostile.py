"""Missions that mean harm: refused in a line, in bounded time and memory, and nothing outside is read."""

import struct
import zlib

import pytest
from tests.muster_control.work.asking import FLOOR, MAPPED, TINY, given

from muster_control.work import OutOfMemory, TimedOut, WorkError

SECRET = "a secret of this machine"


@pytest.mark.parametrize("way", ["{}", "../../../../../../../../{}", "./../{}", "../../../../../{}/../{}"])
@pytest.mark.parametrize(
    "key",
    [
        "map: {{ros_yaml: '{}'}}",
        "map: {{image: '{}', resolution_m: 1}}",
        "rules: {{travel: matrix}}\ntravel: {{beta: '{}'}}",
    ],
)
def test_a_mission_leads_nowhere_else(asked, tmp_path, way, key):
    secret = tmp_path / "secret"
    secret.write_text(SECRET, encoding="utf-8")
    answer = asked("check", mission=given(TINY + key.format(way.replace("{}", str(secret)))))
    (error,) = answer["errors"]
    assert error["expected"] == "one of the files that are with the mission"
    assert SECRET not in str(answer)


def test_a_map_file_leads_nowhere_else(asked):
    floor = (
        b"image: /etc/passwd\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n"
    )
    text = MAPPED.replace("{image: floors/floor.png, resolution_m: 1}", "{ros_yaml: f.yaml}")
    (error,) = asked("check", mission=given(text, {"f.yaml": floor}))["errors"]
    assert (error["field"], error["expected"]) == ("map.ros_yaml", "an image that is with the mission")
    beside = floor.replace(b"/etc/passwd", b"floor.png")
    assert asked("check", mission=given(text, {"f.yaml": beside, "floor.png": FLOOR}))["errors"] == []


@pytest.mark.parametrize(
    "name", ["/tmp/x", "../../x", "a/../../../x", "..", ".", "", "a\nb", "a\0b", "x" * 300, "a/" * 3000]
)
def test_a_file_is_laid_down_nowhere_else(asked, name):
    with pytest.raises(WorkError, match=r"^[^\n]*; expected [^\n]*$"):
        asked("judge", mission=given(TINY, {name: b"x"}), plan={"schema": "muster-plan/1", "routes": []})


@pytest.mark.parametrize("key", ["image", "resolution", "origin", "negate"])
def test_a_map_file_that_is_a_bomb_describes_no_floor(asked, key):
    """The worker reads it, never the server, and says no more of it than fits into a line."""
    text = MAPPED.replace("{image: floors/floor.png, resolution_m: 1}", "{ros_yaml: f.yaml}")
    described = {"image": "floor.png", "resolution": "1", "origin": "[0, 0, 0]", "negate": "0"} | {key: "*b8"}
    said = bomb("x", 9) + "".join(f"\n{name}: {value}" for name, value in described.items())
    files = {"f.yaml": f"{said}\noccupied_thresh: 0.65\nfree_thresh: 0.2\n".encode(), "floor.png": FLOOR}
    answer = asked("check", mission=given(text, files))
    assert answer["errors"]
    assert all(len(str(error)) < 1000 for error in answer["errors"])
    assert (answer["floor"], answer["mission"]["name"]) == (None, "mapped")
    assert asked("floor_plan", mission=given(text, files)) == {"floor": None, "earth": None}


def bomb(first, levels):
    lines = [f"b0: &b0 [{', '.join([first] * 9)}]"]
    return "\n".join([*lines, *(f"b{k}: &b{k} [{', '.join([f'*b{k - 1}'] * 9)}]" for k in range(1, levels))])


@pytest.mark.parametrize(
    "text",
    [
        bomb("x", 30) + "\nname: *b29\nrobots: *b29\ntasks: *b29",
        bomb("{id: 1, position: [0, 0]}", 30) + "\nrobots: *b29\ntasks: *b29",
        "[" * 100_000,
        "a: " + "{a: " * 100_000,
        "\n".join(" " * k + "a:" for k in range(2000)),
        TINY.replace("[1, 0]", f"[{'9' * 1_000_000}, 0x{'f' * 1_000_000}]"),
        TINY.replace("[1, 0]", "[1e999, .nan]"),
        "a\0b",
        "name: \ud800",
        "!!python/object/apply:os.system ['true']",
        "",
    ],
)
def test_a_text_that_means_harm_is_refused(asked, text):
    answer = asked("check", limit_s=60, mission=given(text))
    assert answer["errors"]
    assert all(len(str(error)) < 1000 for error in answer["errors"])
    assert answer["summary"] is None


@pytest.mark.long
def test_a_million_tasks_end_with_a_line(asked):
    tasks = "\n".join(f"  - {{id: t{k}, position: [{k}, 0]}}" for k in range(1_000_000))
    with pytest.raises((TimedOut, OutOfMemory), match=r"^it (took longer than|needs more than) [^\n]*$"):
        asked("check", limit_s=4, mission=given(TINY + tasks))


@pytest.mark.long
def test_an_image_that_unpacks_to_gigabytes_ends_with_a_line(asked):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", 50_000, 50_000, 8, 0, 0, 0, 0))
    image = b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(bytes(50_001) * 1000)) + chunk(b"IEND", b"")
    mission = given(MAPPED, {"floors/floor.png": image})
    try:
        errors = asked("check", limit_s=10, mission=mission)["errors"]
    except (TimedOut, OutOfMemory) as error:
        errors = [error]
    assert len(errors) == 1


@pytest.mark.parametrize(
    "plan", [None, [], {}, {"schema": "muster-plan/1", "routes": [[]]}, {"schema": 1e400, "routes": {}}]
)
def test_a_plan_that_means_harm_is_refused(asked, plan):
    with pytest.raises(WorkError, match=r"^plan: [^\n]*; expected [^\n]*$"):
        asked("judge", mission=given(TINY), plan=plan)


@pytest.mark.parametrize(
    "text",
    [
        "rules: {}\n" + bomb("x", 9) + "\nrobots: *b8\ntasks: *b8",
        "tasks: " + "[" * 100_000,
    ],
)
def test_an_edit_of_a_bomb_is_refused_by_a_worker(asked, text):
    for task, how in (("read_mission", {"keys": ["tasks"]}), ("edit", {"change": "add", "with": ["task", 1, 2]})):
        with pytest.raises(WorkError, match=r"^[^\n]+$"):
            asked(task, text=text, **how)


def test_more_than_a_page_can_show_is_not_read_into_the_server(asked):
    with pytest.raises(WorkError, match="too many values; expected at most"):
        asked("read_mission", text="tasks: [" + "1," * 60_000 + "]", keys=["tasks"])


@pytest.mark.long
def test_an_edit_is_made_and_what_is_unknown_refused(asked):
    moved = asked("edit", text=TINY, change="move", **{"with": [{"what": "task", "id": "a"}, 2.5, 3]})["text"]
    assert moved == TINY.replace("[1, 0]", "[2.5, 3]")
    assert asked("read_mission", text=moved, keys=["name", "map"]) == {"data": {"name": "tiny"}}
    with pytest.raises(WorkError, match="expected move, add"):
        asked("edit", text=TINY, change="eval", **{"with": []})
