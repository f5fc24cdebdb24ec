"""Tables where there is little room: words fold, figures never."""

import pytest

from muster.cli.tables.table import print_table

FIGURES = ("1234.56", "712.10 to\n739.15")
SEQUENCE = ", ".join(map(str, range(40)))


@pytest.fixture
def printed(capsys, monkeypatch):
    """The lines of a table on a terminal of so many columns."""

    def lines(width, columns, rows, right):
        monkeypatch.setattr("muster.cli.tables.table._WIDTH_WITHOUT_TERMINAL", width)
        print_table(columns, rows, right=right)
        return capsys.readouterr().out.splitlines()

    return lines


def numbered(count):
    return tuple(f"figure {k}" for k in range(count))


def test_sequences_fold_and_figures_do_not(printed):
    rows = [("r_0", SEQUENCE, SEQUENCE, *FIGURES), ("r_1", "-", "-", *FIGURES)]
    lines = printed(80, ("robot", "tasks", "own tasks", *numbered(2)), rows, numbered(2))
    assert max(map(len, lines)) <= 80
    assert sum("1234.56" in line for line in lines) == 2
    assert sum("712.10 to" in line for line in lines) == 2
    assert all(f"{k}," in "".join(lines) for k in range(39))


@pytest.mark.parametrize("width", [20, 40, 80])
def test_a_table_of_many_figures_takes_the_room_it_needs(width, printed):
    names = numbered(12)
    lines = printed(width, ("what", *names), [("greedy hill-climbing", *["1234.56"] * 12)], names)
    assert sum(line.count("1234.56") for line in lines) == 12
    assert any("greedy" in line for line in lines)
    assert max(map(len, lines)) == 10 + 12 * 7 + 3 * 13 - 1


def test_with_enough_room_nothing_folds(printed):
    rows = [("r_0", SEQUENCE, "1234.56")]
    (head, _, row) = [line.split() for line in printed(300, ("robot", "tasks", "usage [m]"), rows, ()) if line.strip()]
    assert head == ["robot", "tasks", "usage", "[m]"]
    assert row == ["r_0", *SEQUENCE.split(), "1234.56"]


def test_a_long_table_is_printed_as_a_short_one(capsys, monkeypatch):
    columns, rows = ("robot", "where", "usage [m]"), [(f"r_{k}", "機械 ü"[: k % 5], f"{k / 7:.2f}") for k in range(30)]
    prints = []
    for most in (100, 5):
        monkeypatch.setattr("muster.cli.tables.table._MOST_STYLED", most)
        print_table(columns, rows, title="Ways", right=("usage [m]",))
        prints.append(capsys.readouterr().out)
    assert prints[0] == prints[1]
    assert prints[0].count("\n") == 34 + 1


@pytest.mark.parametrize("cell", ["1\n2", SEQUENCE * 2])
def test_a_long_table_with_cells_of_several_lines_folds(cell, capsys, monkeypatch):
    monkeypatch.setattr("muster.cli.tables.table._MOST_STYLED", 5)
    print_table(("a", "b"), [("r", cell)] * 9)
    assert len(capsys.readouterr().out.splitlines()) > 3 + 9 * 2
