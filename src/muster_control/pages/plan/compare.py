"""Two plans of a mission side by side: two maps that show the same part of the ground, and what differs."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from nicegui import ui

from muster_control.contract import PlanEntry
from muster_control.pages.frame import frame
from muster_control.pages.map import MissionMap
from muster_control.pages.map.ground import ground_of
from muster_control.pages.notices import errors_shown
from muster_control.pages.plan.figures import LESS_IS_BETTER, figures_of, lines_of, meaning_of
from muster_control.pages.plan.plan_panel import title_of
from muster_control.pages.visitor import PATIENCE_S, the_services
from muster_control.services.comparison import doers


@ui.page("/plan/{mission}/compare", response_timeout=PATIENCE_S)
async def compare(mission: str, a: int, b: int) -> None:
    """Plans `a` and `b` of a mission."""
    with frame("Plan", f"Two plans of {mission}") as content:
        with ui.element("div").classes("bar"):
            ui.link(f"Back to {mission}", f"/plan/{mission}?plan={b}")
        spinner = ui.spinner(size="2em")

        async def build() -> None:
            with content, errors_shown():
                await _build(mission, a, b)
            spinner.delete()

        ui.timer(0, build, once=True)  # after the page is there: judging plans takes a moment


async def _build(mission: str, a: int, b: int) -> None:
    services = the_services()
    entries = [await services.plans.get(one) for one in (a, b)]
    listed = await services.plans.list(mission)
    titles = {entry.id: title_of(entry) for entry in (*listed, *entries)}
    verdicts = [await services.plans.verdict(entry.id) for entry in entries]
    scenes = [await _scene(entry) for entry in entries]
    chosen = [a, b]
    maps: list[MissionMap] = []
    with ui.element("div").classes("two"):
        for k, (entry, verdict) in enumerate(zip(entries, verdicts, strict=True)):
            with ui.element("section").props(f'aria-label="Plan {entry.version}"'):

                def turn(event: Any, k: int = k) -> None:
                    chosen[k] = event.value
                    ui.navigate.to(f"/plan/{mission}/compare?a={chosen[0]}&b={chosen[1]}")

                select = ui.select(titles, value=entry.id, on_change=turn, label=f"Plan {'AB'[k]}")
                select.props("outlined dense options-dense").classes("full control")
                lines, label = lines_of(entry.plan, verdict), f"Plan {'AB'[k]}"
                maps.append(MissionMap(scenes[k], plan=lines, group="two", label=label))
    for one, other in (maps, maps[::-1]):
        one.on("choose", lambda event, other=other: _follow(other, event.args))
    _differences(entries, verdicts, maps)


async def _scene(entry: PlanEntry) -> dict[str, Any]:
    version = await the_services().missions.get(entry.mission, entry.mission_version)
    found = await the_services().missions.check(version.text, dict(version.files))
    return ground_of(found["mission"] or {}, found["floor"], version)


def _follow(ground: MissionMap, one: Mapping[str, Any] | None) -> None:
    if one is None:
        ground.choose_none()
    else:
        ground.choose(one["what"], one["id"])


def _differences(entries: Sequence[PlanEntry], verdicts: Sequence[Mapping[str, Any]], maps: list[MissionMap]) -> None:
    figures = [dict(figures_of(entry.plan, verdict)) for entry, verdict in zip(entries, verdicts, strict=True)]
    names = list(dict.fromkeys([*figures[0], *figures[1]]))
    rows = [(name, *(part.get(name, "") for part in figures)) for name in names]
    marked = [(name, *with_better(name, first, second)) for name, first, second in rows]
    changed = moved_tasks(entries[0].plan, entries[1].plan)
    with ui.element("div").classes("two differences-of-plans"):
        with ui.element("div").classes("panel scrolling"):
            _table(("Figure", "Plan A", "Plan B"), marked)
        with ui.element("div").classes("panel scrolling"):
            with ui.element("h3"):
                ui.label(
                    f"{len(changed)} tasks are done by another robot" if changed else "Every task has the same robot"
                )
            if changed:
                _table(("Task", "Plan A", "Plan B"), changed)


def _table(heads: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> None:
    with ui.element("table").classes("plain"):
        with ui.element("tr"):
            for head in heads:
                with ui.element("th").props('scope="col"'):
                    ui.label(head)
        for row in rows:
            with ui.element("tr").classes("differs" if len(set(row[1:])) > 1 else ""):
                for text in row:
                    cell = ui.element("td")
                    cell.props["title"] = meaning_of(text)
                    with cell:
                        ui.label(text)


def with_better(name: str, first: str, second: str) -> tuple[str, str]:
    """Two values of a figure, with the better one marked if there is one."""
    kind = name.partition(",")[0]
    least, most = kind in LESS_IS_BETTER, kind in ("Tasks done", "Equality")
    try:
        a, b = (float(text.split()[0]) for text in (first, second))
    except (ValueError, IndexError):
        return first, second
    if a == b or not (least or most):
        return first, second
    return (f"{first} (better)", second) if (a < b) == least else (first, f"{second} (better)")


def _in_order(task: str) -> tuple[list[int], str]:
    """Numbers in names by their size: 2 before 12."""
    return [int(number) for number in re.findall(r"\d+", task)], task


def moved_tasks(a: Mapping[str, Any], b: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Tasks that two plans give to different robots, with both; `left out` where none does one."""
    robots = [doers(plan) for plan in (a, b)]
    tasks = sorted({*robots[0], *robots[1]}, key=_in_order)
    pairs = [(task, *(part.get(task, "left out") for part in robots)) for task in tasks]
    return [(task, first, second) for task, first, second in pairs if first != second]
