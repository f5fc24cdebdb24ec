"""The lines of the report about robots that agreed without a centre."""

from muster.cli.tables.team import print_team


def test_each_fate_has_a_line(capsys):
    print_team(
        {
            "ended": [{"robot": "b", "at_s": 8.0, "why": "killed by SIGKILL"}],
            "silent": [{"robot": "a", "from_s": 1.0, "until_s": None, "why": "its radio was off"}],
            "splits": [{"groups": [["a"], ["b", "c"]], "from_s": 5.0, "until_s": 60.5}],
            "refused_statements": [
                {"robot": "a", "sender": "c", "reason": "the epoch 9", "count": 3},
                {"robot": "b", "sender": "c", "reason": "the price inf", "count": 2},
                {"robot": "b", "sender": "", "reason": "", "count": 1},
            ],
            "refused_orders": [
                {"robot": "a", "task": "x", "reason": "there is a task"},
                {"robot": "c", "task": "", "reason": "new task: y"},
            ],
        }
    )
    assert capsys.readouterr().out.splitlines() == [
        "process ended     b at 8.00 s, killed by SIGKILL",
        "process silent    a from 1.00 s on, its radio was off",
        "split             a | b, c from 5.00 s to 60.50 s",
        "refused           5 statements of c, by 2 robots: the epoch 9, and 1 other reason",
        "refused           1 statement of others, by 1 robot: for other reasons",
        "order refused     x given to a: there is a task",
        "order refused     given to c: new task: y",
    ]


def test_where_nothing_happened_there_is_no_line(capsys):
    print_team(None)
    print_team({"ended": [], "silent": [], "splits": [], "refused_statements": [], "refused_orders": []})
    assert capsys.readouterr().out == ""
