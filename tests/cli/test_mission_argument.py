"""The MISSION that verbs take, and the flags that go with it."""

from pathlib import Path

import pytest
from tests.cli.yard import FOUND, MISSION

from muster.library import mission_path
from muster.mission.reading.plan_reader import read_plan

pytestmark = pytest.mark.usefixtures("folder")


def test_task_list_csv(muster):
    flags = ["t.csv", "--robots", "r.csv", "--suitability", "s.csv"]
    assert muster("check", *flags) == (0, "t: 2 robots, 3 tasks; no errors\n" + FOUND, "")
    code, out, err = muster("solve", *flags, "--iterations", 10, "-o", "p.json", "--require-complete")
    assert (code, err) == (0, "")
    assert out.startswith("t: search, seed 0")
    assert {task for route in read_plan("p.json").routes for task in route.tasks} == {"1", "2", "3"}
    assert muster("verify", *flags, "p.json")[0] == 0
    assert muster("explain", *flags, "p.json", "--task", 2)[0] == 0


def test_task_list_csv_without_suitability(muster):
    assert muster("check", "t.csv", "--robots", "r.csv")[0] == 0


def test_tsplib(muster):
    flags = ["eil51", "--salesmen", 3, "--depot", 7]
    assert muster("check", *flags) == (
        0,
        "eil51-3: 3 robots, 50 tasks; no errors\n" + FOUND,
        "",
    )
    code, _, err = muster("solve", *flags, "--iterations", 2, "-o", "p.json")
    assert (code, err) == (0, "")
    tours = read_plan("p.json").routes
    assert [tour.robot for tour in tours] == ["r_0", "r_1", "r_2"]
    assert sorted((task for tour in tours for task in tour.tasks), key=int) == [str(k) for k in range(1, 52) if k != 7]
    assert muster("verify", *flags, "p.json")[0] == 0
    assert muster("verify", "eil51", "--salesmen", 3, "p.json")[0] == 1  # node 1 is no task there


@pytest.mark.parametrize("verb", ["check", "solve"])
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["t.csv"], "t.csv: --robots missing; expected with a .csv file"),
        (["eil51"], "eil51: --salesmen missing; expected with a .tsp file"),
        (
            ["yard.yaml", "--robots", "r.csv"],
            "yard.yaml: --robots given; expected no --robots with this kind of mission",
        ),
        (
            ["eil51", "--salesmen", "2", "--suitability", "s.csv"],
            "eil51: --suitability given; expected no --suitability",
        ),
        (["yard.yaml", "--depot", "2"], "--depot given; expected it together with --salesmen"),
        (["none.txt"], "none.txt: No such file or directory; expected a file to read"),
        (["none.vrp"], "none.vrp: No such file or directory; expected a file to read"),
        (["none.yaml"], "none.yaml: No such file or directory; expected a file to read"),
        (
            ["31T-6R5"],
            "31T-6R5: no such file or mission; expected a file, or the name of a shipped mission; did you mean",
        ),
        (["."], ".: Is a directory; expected a file to read"),
    ],
)
def test_flags_that_do_not_fit(verb, arguments, message, muster):
    code, out, err = muster(verb, *arguments)
    assert (code, out) == (2, "")
    assert err.startswith(message)
    assert len(err.splitlines()) == 1


def test_instance_files_have_robots_of_their_own(muster):
    Path("tiny.txt").write_text(
        "2 20 1\n0 0 0 0 0 90 0 0 0\n1 3 4 5 0 50 1 0 2\n2 6 8 -5 0 80 1 1 0\n", encoding="utf-8"
    )
    assert muster("check", "tiny.txt")[1].startswith("tiny-2: 2 robots, 2 tasks; no errors")
    assert muster("check", "tiny.txt", "--salesmen", 5)[1].startswith("tiny-5: 5 robots")
    code, _, err = muster("check", "tiny.txt", "--salesmen", 5, "--depot", 2)
    assert (code, err) == (2, "tiny.txt: --depot given; expected no --depot with this kind of mission\n")
    assert muster("solve", "tiny.txt", "--iterations", 5, "-o", "p.json")[0] == 0
    assert muster("verify", "tiny.txt", "p.json")[0] == 0


def test_suffixes_in_capitals(muster):
    Path("t.csv").rename("T.CSV")
    assert muster("check", "T.CSV", "--robots", "r.csv")[0] == 0
    Path("eil51.TSP").write_bytes(mission_path("eil51").read_bytes())
    assert muster("check", "eil51.TSP", "--salesmen", 2)[0] == 0


def test_a_file_comes_before_a_shipped_mission_of_that_name(muster):
    Path("6T-2R").write_text(MISSION, encoding="utf-8")
    assert muster("check", "6T-2R")[1].startswith("yard: ")
