"""The study: `search` beside others on missions with time windows, prerequisites and teams."""

from __future__ import annotations

from muster_studies.peers.contest import Result, Run
from muster_studies.peers.ordered_table import ORDERED
from muster_studies.peers.teams_table import Teams
from muster_studies.peers.timed_contest import timed_contest
from muster_studies.peers.windows_table import Windows
from muster_studies.repetition import Repetition


def peers_timed_study() -> Repetition[Run, Result]:
    """`search` beside OR-Tools, PyVRP, VROOM and published figures, one run at a time."""
    return timed_contest(
        name="peers-timed",
        summary="search beside OR-Tools, PyVRP and VROOM: time windows, prerequisites, teams",
        document="search beside solvers from elsewhere: time windows, prerequisites, teams",
        reproductions=(Windows(), ORDERED, Teams()),
        random="search and PyVRP are random; the others are not, and run once.",
        notes=(
            "windows: instances of Solomon; service times are the work, demands are left out, robots as many as "
            "vehicles of the reference. That all tasks can be done is told to PyVRP as required clients, without which "
            "it does fewer tasks more often; OR-Tools and VROOM may leave tasks out at a price above any way.",
            "ordered: 3 to 10 robots, 9 to 60 tasks on 100 m x 100 m, work of 20 to 40 s, one window each that opens "
            "in 0 to 400 s and is 30 to 1,600 s long, a tenth of the pairs ordered; windows-SEED. PyVRP and VROOM have "
            "no prerequisites.",
            "teams: the instances of two published generators, by their seeds. A robot has its skills for its team's "
            "sum; all robots return, and the makespan includes it.",
        ),
    )
