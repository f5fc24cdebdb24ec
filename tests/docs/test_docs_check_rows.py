"""Rows of a page: what holds passes; wrong figures, failing commands, rows without command or reason are refused."""

import pytest
from tools.docs_check.page_run import check_page
from tools.docs_check.rows import SHARES, Due, Row, read_rows

PLACE = "`motion/frames.py`"
TEST = "`tests/docs/test_docs_check_rows.py`"


@pytest.fixture
def check(tmp_path, monkeypatch):
    """Check a page of rows; `muster` is a program that prints its arguments, and fails where the first is `fail`."""
    program = tmp_path / "bin" / "muster"
    program.parent.mkdir()
    program.write_text('#!/bin/sh\necho "$@"\n[ "$1" != fail ]\n', encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setattr("tools.docs_check.commands.sys.executable", str(program))

    def checked(*rows, due=None):
        page = tmp_path / "page.md"
        head = "| section | described | where | shown by | state |\n|---|---|---|---|---|\n"
        body = "".join(f"{row}\n" for row in rows)
        page.write_text(f"<!-- docs-check: rows -->\n{head}{body}<!-- docs-check: end -->\n", encoding="utf-8")
        return [(outcome.status, outcome.detail) for outcome in check_page(page, due)]

    return checked


def row(shown="", state="done", where=PLACE, section="1", described="it"):
    return f"| {section} | {described} | {where} | {shown} | {state} |"


@pytest.mark.parametrize(
    ("printed", "figure"),
    [
        ("cost 18.04 m", "18.04 m"),
        ("cost 18.04 m", "cost 18.0±0.05 m"),
        ("a 1 b 2 c 3", "a ... b 2 ... 3"),
        ("way 1,234.5 m, all", "1,234±1 m, all"),
        ("(12.5%) -3.25", "(12±1%) -3±0.5"),
        ("mean 0.5, most 2", "mean 0.4±0.2, most"),
    ],
)
def test_figures_that_are_printed_hold(check, printed, figure):
    assert check(row(f"`muster '{printed}'` → `{figure}`")) == [("compared", "")]


@pytest.mark.parametrize(
    ("printed", "figure"),
    [
        ("cost 18.04 m", "18.05 m"),
        ("cost 18.04 m", "18.3±0.2 m"),
        ("cost 118.04 m", "18.04 m"),
        ("cost none m", "cost 18±1000 m"),
        ("a 1 b 2", "b ... a"),
        ("cost 18.04 m", "cost m"),
        ("cost 18", "cost 18 m"),
    ],
)
def test_a_wrong_figure_is_refused(check, printed, figure):
    ((status, detail),) = check(row(f"`muster '{printed}'` → `{figure}`"))
    assert status == "failed"
    assert f"not printed: {figure}" in detail
    assert printed in detail


def test_one_wrong_figure_of_several_is_refused(check):
    ((status, detail),) = check(row("`muster a 1 b 2` → `a 1`, `b 3`; `muster c 4` → `c 4`"))
    assert (status, detail.splitlines()[:2]) == ("failed", ["muster a 1 b 2", "not printed: b 3"])


def test_a_failing_command_is_refused_whatever_it_prints(check):
    ((status, detail),) = check(row("`muster fail 7` → `fail 7`"))
    assert status == "failed"
    assert "exit code 1" in detail


def test_commands_of_a_row_share_a_folder(check):
    assert check(row("`muster a > kept && muster b` → `b`; `muster $(cat kept)` → `a`")) == [("compared", "")]


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        (row(), "no place, or no command or test"),
        (row(f"{TEST}", where=""), "no place, or no command or test"),
        (row("`muster missions`"), "no figure of what it prints: muster missions"),
        (row("`simulate --law thesis`"), "neither commands with figures nor tests"),
        (row("the tests"), "neither commands with figures nor tests"),
        (row("`tests/docs/test_nothing.py`"), "no such path: tests/docs/test_nothing.py"),
        (row(f"{TEST}", where="`motion/nothing.py`"), "no such path: motion/nothing.py"),
        (row(state="not", where=""), "no state with a reason"),
        (row(state="not:", where=""), "no state with a reason"),
        (row(state="not: yet", where=""), "no state with a reason"),
        (row(f"{TEST}", state="differs"), "no state with a reason"),
        (row(f"{TEST}", state="mostly"), "no state with a reason"),
        ("| 1 | it | done |", "3 cells where five are expected"),
    ],
)
def test_a_row_without_command_or_reason_is_refused(check, wrong, word):
    found = check(wrong)
    assert {status for status, _ in found} == {"failed"}
    assert any(word in detail for _, detail in found)


def test_rows_that_tests_show_and_reasons_are_no_commands(check):
    assert check(row(TEST), row(state="not: the print gives no rule", where="")) == []


def test_long_rows_are_left_to_their_turns(check):
    long = row("`muster fail` (long, 4 min) → `9`")
    assert check(long, row("`muster 1` → `1`")) == [("left to another turn", ""), ("compared", "")]
    assert check(long, due=Due(every=True))[0][0] == "failed"


def test_ten_turns_in_a_row_run_every_row_once():
    rows = read_rows("\n".join(row("`muster 1` (long, 4 min) → `1`", described=f"it {k}") for k in range(50)))
    ran = [sum(Due(turn).has(one) for turn in range(23, 23 + SHARES)) for one in rows]
    assert ran == [1] * 50


@pytest.mark.parametrize(
    ("file", "due"),
    [
        ("src/muster/motion/frames.py", True),
        ("src/muster_studies/rvo/runs.py", True),
        ("src/muster/motion/grid.py", False),
    ],
)
def test_a_change_runs_the_rows_that_name_its_files(file, due):
    (one,) = read_rows(row("`muster 1` → `1`", where=f"{PLACE}, `muster_studies/rvo/`"))
    turns = [turn for turn in range(SHARES) if not Due(turn).has(one)]
    assert Due(turns[0], changed=frozenset({file})).has(one) is due


def test_a_row_that_has_changed_is_run():
    (one,) = read_rows(row("`muster 1` → `1`"))
    turn = next(turn for turn in range(SHARES) if not Due(turn).has(one))
    assert Due(turn, added=frozenset({one.text})).has(one)


def test_a_long_command_has_longer():
    (one,) = read_rows(row("`muster 1` (long, 4 min) → `1`; `muster 2` → `2`"))
    assert isinstance(one, Row)
    long, short = one.commands
    assert long.minutes == 4
    assert long.limit_s > short.limit_s
