"""The study: the cost of agreement without a centre, as a table and a picture."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from muster_studies.effort import Effort
from muster_studies.figures import StudyFigure
from muster_studies.negotiation.cost import LOSSES, AuctionCost, AuctionRun, Cost, hold
from muster_studies.repetition import Repetition, one_by_one
from muster_studies.tables import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
