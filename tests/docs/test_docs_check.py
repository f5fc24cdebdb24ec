"""The checker of documents: each way to fail fails, what is skipped is counted, and what holds passes."""

import json

import pytest
from tools.docs_check import measured
from tools.docs_check.commands import look_up, run_command
from tools.docs_check.consoles import compare_console
from tools.docs_check.measured import numbers, unknown_numbers
from tools.docs_check.outcomes import summary
from tools.docs_check.page_run import check_page
from tools.docs_check.pages import Marker, read_page


@pytest.fixture
def check(tmp_path):
    def checked(text):
        page = tmp_path / "page.md"
        page.write_text(text, encoding="utf-8")
        return [(outcome.status, outcome.kind, outcome.detail) for outcome in check_page(page)]

    return checked


def block(language, text, *markers):
    return "".join(f"<!-- docs-check: {m} -->\n" for m in markers) + f"```{language}\n{text}\n```\n"


def test_commands_share_a_folder_and_an_unmarked_failure_fails(check):
    assert check(block("sh", "echo 1 > a\ncat a  # there")) == [("run", "command", "")] * 2 + [("run", "block", "")]
    ((status, kind, detail), *_) = check(block("sh", "false"))
    assert (status, kind) == ("failed", "command")
    assert "exit code 1" in detail


def test_a_block_that_is_skipped_is_not_run_and_says_why(check):
    assert check(block("sh", "false", "skip: needs a drone")) == [("skipped", "block", "needs a drone")]
    found = check(block("sh", "false --fly\ntrue", "skip /--fly/: a drone"))
    assert found == [("skipped", "command", "a drone"), ("run", "command", ""), ("run", "block", "")]


def test_reasons_are_counted(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(block("sh", "false", "skip: a drone") * 2 + block("text", "?"), encoding="utf-8")
    lines = summary(check_page(page))
    assert "    2 a drone" in lines
    assert lines[-1] == "1 failed"


def test_consoles_are_compared(check):
    assert check(block("console", "$ echo a; echo b\na\nb"))[1][0] == "compared"
    assert check(block("console", "$ echo a\nb"))[1][0] == "failed"
    assert check(block("console", "$ echo took 2.5 s\ntook 3.1 s", "mask times"))[1][0] == "compared"
    assert check(block("console", "$ echo took 2.5 s\ntook 3.1 s"))[1][0] == "failed"


def test_dots_stand_for_lines(tmp_path):
    ran = run_command("seq 5", tmp_path)
    assert compare_console(["1", "...", "5"], ran, masks=False) == ""
    assert compare_console(["2", "...", "5"], ran, masks=False) != ""


def test_python_blocks_share_names_and_their_output_is_compared(check):
    text = block("python", "a = 1") + block("python", "print(a + 1)") + block("text", "2", "output")
    assert [status for status, *_ in check(text)] == ["run", "run", "compared"]
    assert check(block("python", "print(1)") + block("text", "2", "output"))[-1][0] == "failed"
    assert check(block("python", "1 / 0"))[0][0] == "failed"


def test_missions_are_parsed_and_kept(check):
    mission = "schema: muster/1\nname: quay\nrobots: [{id: r, position: [0, 0]}]\ntasks: []"
    assert check(block("yaml", mission) + block("sh", "ls quay.yaml"))[:2] == [
        ("parsed", "block", ""),
        ("run", "command", ""),
    ]
    assert check(block("yaml", "schema: muster/1\nrobotz: []"))[0][0] == "failed"
    assert check(block("yaml", "events: [{at_s: 1, cancel_task: 7}]"))[0][0] == "failed"
    assert (
        check(block("yaml", "events: [{at_s: 1, cancel_task: 7}]", "with {tasks: [{id: 7, position: [0, 0]}]}"))[0][0]
        == "parsed"
    )


@pytest.mark.parametrize("text", [block("text", "?"), block("", "?"), "![a](b.png)\n", block("rust", "?")])
def test_what_has_no_marker_and_cannot_be_run_fails(check, text):
    assert [status for status, *_ in check(text)] == ["failed"]


def test_markers_before_nothing_fail(check):
    assert check("<!-- docs-check: skip: why -->\nwords\n")[0][0] == "failed"
    assert check("<!-- docs-check: numbers from x -->\n1.5\n")[0][0] == "failed"


def test_numbers_of_a_region_are_those_of_its_command(check):
    region = "<!-- docs-check: numbers by {} -->\n| 1.25 | 2.5 |\n<!-- docs-check: end -->\n"
    assert {status for status, *_ in check(region.format("echo 1.250 2.5"))} == {"compared"}
    failed = [detail for status, _, detail in check(region.format("echo 1.25")) if status == "failed"]
    assert failed == ["not printed by echo 1.25: 2.5"]


def test_numbers():
    assert numbers("22,853.5 m, +0.4 %, v1.2.3, 7 of 9, (4.36)") == ["22853.5", "0.4", "4.36"]
    assert unknown_numbers("1.3 and 1.4", "1.345") == ["1.4"]
    assert unknown_numbers("-1.3, +2.5, 0.7", "1.345 2.5 -0.7") == ["-1.3", "0.7"]


def test_pictures_are_compared_by_their_data(check, tmp_path, monkeypatch):
    plt = pytest.importorskip("matplotlib.pyplot")
    from tools.docs_check import pictures

    from muster.report.figures.files import save_figure

    monkeypatch.setattr(pictures, "ROOT", tmp_path)

    def draw(name, values, **style):
        figure, axes = plt.subplots()
        axes.plot(values, **style)
        axes.set_title("way")
        save_figure(axes, tmp_path / name)
        plt.close(figure)

    draw("kept.png", [1, 2, 3])
    draw("same.png", [1, 2, 3], color="red")
    draw("other.png", [1, 2, 4])
    made = "<!-- docs-check: made by cp {} kept.png -->\n![a](kept.png)\n"
    assert check(made.format(tmp_path / "same.png")) == [("compared", "picture", "")]
    ((status, _, detail),) = check(made.format(tmp_path / "other.png"))
    assert (status, detail) == ("failed", "kept.png: axes 1: other lines")


def test_stored_measurements_are_of_the_command_on_the_page(check, tmp_path, monkeypatch):
    monkeypatch.setattr("tools.docs_check.page_run.load", lambda name: measured.load(name, tmp_path))
    text = block("sh", "sleep 9  # long", "long naps")
    assert check(text)[0][0] == "failed"
    (tmp_path / "scratch").mkdir()
    measured.measure("naps", "echo 1.5", tmp_path / "scratch", tmp_path)
    assert "is of `echo 1.5`" in check(text)[0][2]
    stored = json.loads((tmp_path / "naps.json").read_text(encoding="utf-8"))
    assert (stored["output"], set(stored)) == (["1.5"], {"command", "commit", "seconds", "output"})
    assert check(block("sh", "echo 1.5", "long naps")) == [("measured", "command", "")]


def test_a_command_that_takes_too_long_ends_with_all_it_started(tmp_path):
    assert run_command("sleep 60 & sleep 60", tmp_path, limit_s=0.5).code == 124


def test_what_is_looked_up():
    assert look_up("make test  # all") == ""
    assert look_up("make nothing-of-the-kind") == "no such target of make: nothing-of-the-kind"
    assert look_up("pip install 'muster-robotics[plot,map]'") == ""
    assert look_up("pip install 'muster-robotics[plots]'") == "no such extra: plots"
    assert look_up("muster missions") is None


def test_markers_and_items(tmp_path):
    assert Marker.of("skip /^a b/: because") == Marker("skip", "because", "^a b")
    assert Marker.of("long name /--quick/") == Marker("long", "name", "--quick")
    page = tmp_path / "page.md"
    page.write_text("<!-- docs-check: setup\ntrue -->\n   ```sh\n   a\n   ```\n", encoding="utf-8")
    assert [(item.kind, item.line, item.text) for item in read_page(page)] == [
        ("setup", 1, "true"),
        ("block", 3, "a\n"),
    ]
