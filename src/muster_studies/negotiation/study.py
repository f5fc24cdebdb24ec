"""The study: the cost of agreement without a centre, as a table and a picture.

Cost and plan quality of agreement without a centre, for teams of growing size in a simulated network.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from random import Random
from typing import TYPE_CHECKING

from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.generation.uniform import uniform_mission
from muster.mission.model import Mission
from muster.model.problem import Problem
from muster.verification import verify
from muster_studies.effort import Effort
from muster_studies.figures import StudyFigure
from muster_studies.repetition import Repetition, one_by_one
from muster_studies.tables import Cell, Table
from muster_team.negotiators.methods import METHODS
from muster_team.negotiators.robot_view import view_of
from muster_team.network.codec import Codec
from muster_team.network.encryption import OVERHEAD
from muster_team.network.memory_network import LinkConditions, MemoryNetwork

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TASKS_A_ROBOT = 2.5
DELAY_S = 0.05
LOSSES = (0.0, 0.3)
SIZES, QUICK_SIZES = (5, 10, 20, 50, 100), (5, 10)
MOST_SEEDS = {50: 2, 100: 1}
"""Of large teams not all seeds are tried: an auction of 100 robots takes half a minute."""
SEARCH_ITERATIONS = 20_000
LONGEST_S = 600.0


@dataclass(frozen=True)
class AuctionRun:
    """One auction of a team: the method, the number of robots, and the loss of the network."""

    method: str
    robots: int
    loss: float
    seed: int

    @property
    def mission(self) -> Mission:
        """Robots and tasks without limits at random places of a square."""
        random, tasks = Random(f"{self.robots} {self.seed}"), round(TASKS_A_ROBOT * self.robots)
        return uniform_mission(random, robots=self.robots, tasks=tasks)


@dataclass(frozen=True)
class AuctionCost:
    """The cost of an auction until all robots know that all agree.

    Parameters
    ----------
    rounds
        in which all said something: of the auction one a sale.
    news, repairs, heartbeats
        messages of the whole team; one to all counts once.
    bytes
        of these as they go over a network, sealed; one to all counts once.
    seconds
        of virtual time.
    gap
        by which share the objective is above that of `search`.
    """

    rounds: int
    news: int
    repairs: int
    heartbeats: int
    bytes: int
    seconds: float
    gap: float


def hold(talk: AuctionRun) -> AuctionCost:
    """Hold an auction.

    Raises
    ------
    MissingExtraError
        if the extra `net` is not installed.
    """
    mission = talk.mission
    problem = Problem.compile(mission).ready()
    method = METHODS[talk.method]
    params = method.allocator.parameters()
    names = [robot.id for robot in problem.robots]
    codec, weights = Codec(names, [task.id for task in problem.tasks]), list[int]()
    network = MemoryNetwork(
        lambda robot, incarnation: method.negotiator(problem, params, robot, incarnation=incarnation),
        names,
        talk.seed,
        LinkConditions(loss=talk.loss, delay_s=DELAY_S),
        sent=lambda message: weights.append(len(codec.encode(message)) + OVERHEAD),
    )
    network.start()
    if not network.run(LONGEST_S, lambda: all(node.settled for node in network.nodes.values())):
        raise RuntimeError(f"{talk}: no agreement within {LONGEST_S:g} s of virtual time")
    node = next(iter(network.nodes.values()))
    counts = [one.counts for one in network.nodes.values()]
    value = verify(mission, method.plan(problem, params, view_of(node), None)).value()
    assert value is not None
    return AuctionCost(
        rounds=node.stage.round,
        news=sum(count.news for count in counts),
        repairs=sum(count.repairs for count in counts),
        heartbeats=sum(count.heartbeats for count in counts),
        bytes=sum(weights),
        seconds=network.now,
        gap=value / searched(talk.robots, talk.seed) - 1,
    )


@cache
def searched(robots: int, seed: int) -> float:
    """The objective of the plan that one process finds, by `search`."""
    mission = AuctionRun("auction", robots, 0.0, seed).mission
    search = ALLOCATORS["search"]
    plan = search.solve(Problem.compile(mission).ready(), Stop(iterations=SEARCH_ITERATIONS), seed=seed)
    value = verify(mission, plan).value()
    assert value is not None
    return value


@dataclass(frozen=True)
class Cost:
    """Messages and bytes a task, time, and the gap to the central search, as the team grows."""

    number: str = "cost"

    def jobs(self, effort: Effort) -> Iterator[AuctionRun]:
        for method in METHODS:
            for robots in QUICK_SIZES if effort.quick else SIZES:
                for loss in LOSSES:
                    for seed in range(min(effort.seed_count, MOST_SEEDS.get(robots, effort.seed_count))):
                        yield AuctionRun(method, robots, loss, seed)

    def table(self, effort: Effort, found: Mapping[AuctionRun, AuctionCost]) -> Table:
        figures = ("news a task", "all a task", "kB a task", "s", "gap %")
        columns = ("method", "robots", "tasks", "loss %", "runs", "rounds", *figures)
        rows: list[tuple[Cell, ...]] = []
        cases = dict.fromkeys((talk.method, talk.robots, talk.loss) for talk in self.jobs(effort))
        for method, robots, loss in cases:
            case = (method, robots, loss)
            of = [said for talk, said in found.items() if (talk.method, talk.robots, talk.loss) == case]
            tasks, n = round(TASKS_A_ROBOT * robots), len(of)
            rows.append(
                (
                    method,
                    robots,
                    tasks,
                    round(100 * loss),
                    n,
                    round(sum(said.rounds for said in of) / n),
                    sum(said.news for said in of) / n / tasks,
                    sum(said.news + said.repairs + said.heartbeats for said in of) / n / tasks,
                    sum(said.bytes for said in of) / n / tasks / 1000,
                    sum(said.seconds for said in of) / n,
                    100 * sum(said.gap for said in of) / n,
                )
            )
        return Table(self.number, "What agreeing costs, and how good the plans are", columns, tuple(rows), _NOTES)


_NOTES = (
    "Robots and 2.5 tasks a robot at random places of a square, without limits; total+max; 50 ms each way, nothing "
    "else is slow. news: declarations and bids of all robots. all: with repairs and heartbeats. A message to all "
    "counts once; over UDP to peers it is sent to each. kB: sealed, as on the network. s: until all know that all "
    "agree. gap: to search in one process, 20,000 iterations, which no loss touches. Of 50 robots two missions "
    "at most, of 100 one.",
)


_held = cache(hold)


def _hold(talk: AuctionRun) -> AuctionCost:
    """Hold an auction, once for the table and the picture."""
    return _held(talk)


_DO = one_by_one(_hold)


def draw(effort: Effort) -> Figure:
    """Draw messages and bytes a task over the size of the team, and how much higher the objective is than by search."""
    cost = Cost()
    found = _DO(cost.jobs(effort), None, 1, None).found
    return _figure(cost.table(effort, found))


def _figure(table: Table) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from muster.report.figures.styles import PALETTE

    figure = Figure(figsize=(10, 3.6), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    records = table.records()
    for ax, (column, label) in zip(figure.subplots(1, 3), _SHOWN, strict=True):
        for k, method in enumerate(dict.fromkeys(str(row["method"]) for row in records)):
            for loss, style in zip(LOSSES, ("-", "--"), strict=True):
                rows = [row for row in records if row["method"] == method and row["loss %"] == round(100 * loss)]
                name = f"{method}, {100 * loss:.0f} % lost"
                points = [row["robots"] for row in rows], [row[column] for row in rows]
                ax.plot(*points, style, marker="o", markersize=3.5, color=PALETTE[k], label=name)
        ax.set_xscale("log")
        ax.set_xticks([row["robots"] for row in rows], [str(row["robots"]) for row in rows])
        ax.minorticks_off()
        ax.set_xlabel("robots")
        ax.set_title(label, fontsize=9)
        ax.grid(alpha=0.3)
        ax.set_ylim(bottom=0)
    ax.legend(fontsize=7)
    return figure


_SHOWN = (("all a task", "messages a task"), ("kB a task", "kB a task"), ("gap %", "objective above search, %"))

NEGOTIATION = Repetition[AuctionRun, AuctionCost](
    name="negotiation",
    summary="what agreeing without a centre costs as the team grows, and how good the plans are",
    document="no publication: simulated network, 50 ms each way",
    reproductions=(Cost(),),
    perform=_DO,
    extras=("net",),
    figures=(
        StudyFigure(
            number="negotiation",
            shows="messages, bytes and the objective of auctions without a centre over the size of the team",
            draw=draw,
            tables=(Cost().number,),
        ),
    ),
)
"""The auction and bundles without a centre, beside search in one process, with and without loss."""
