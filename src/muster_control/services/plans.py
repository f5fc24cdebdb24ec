"""Plans: listed, uploaded, judged, explained, exported, drawn and compared."""

from __future__ import annotations

import asyncio
import base64
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from muster.mission.errors import ParameterError
from muster_control.contract import PAGE_ROWS, PlanEntry, User
from muster_control.services.actions import Actions, Refused, ignore_refusal
from muster_control.services.comparison import compared
from muster_control.services.missions import Missions
from muster_control.services.uploads import mission_input
from muster_control.store import Store
from muster_control.work import Pool

_MOST_VERDICTS = 16  # in the cache: plans never change


class Plans:
    """The plans of a server. Workers do what takes computation."""

    def __init__(self, store: Store, pool: Pool, refused: Refused = ignore_refusal) -> None:
        self._store = store
        self._pool = pool
        self._missions = Missions(store, pool)
        self._actions = Actions(store, refused)
        self._allocators: list[dict[str, Any]] = []
        self._verdicts: OrderedDict[tuple[object, ...], dict[str, Any]] = OrderedDict()

    async def get(self, plan: int) -> PlanEntry:
        """A plan.

        Raises
        ------
        NotFoundError
            if there is none.
        """
        return await asyncio.to_thread(self._store.plans.get, plan)

    async def allocators(self) -> list[dict[str, Any]]:
        """Each allocator's name, summary and parameters, and whether it is anytime and the default."""
        if not self._allocators:
            self._allocators = (await self._pool.run("allocators", {}))["allocators"]
        return self._allocators

    async def upload(self, who: User, mission: str, plan: Mapping[str, Any]) -> PlanEntry:
        """Store a plan for the newest version of a mission, from any program, valid or not.

        Raises
        ------
        WorkError
            with everything that is wrong with the plan file.
        NotFoundError, ForbiddenError
        """
        async with self._actions.of(who, "plan.upload", {"mission": mission}):
            version = await self._missions.stored(mission)
            given = mission_input(version.text, version.files, mission)
            adopted = (await self._pool.run("upload_plan", {"mission": given, "plan": plan}))["plan"]
            return await asyncio.to_thread(
                self._store.plans.add, mission, version.version, "uploaded", who.name, adopted
            )

    async def verdict(
        self, plan: int, ignore: Sequence[str] | None = None, objective: str | None = None
    ) -> dict[str, Any]:
        """The judge's verdict: see `work.tasks.judge`.

        Parameters
        ----------
        ignore
            rules that do not hold; by default those without which the server made the plan.
        objective
            the one that was to be minimised; by default the one for which the server made the plan, or the mission's.

        Raises
        ------
        NotFoundError, WorkError
        """
        key = (plan, None if ignore is None else tuple(sorted(ignore)), objective)
        if key not in self._verdicts:
            self._verdicts[key] = await self._asked("judge", plan, ignore=ignore, objective=objective)
            while len(self._verdicts) > _MOST_VERDICTS:
                self._verdicts.popitem(last=False)
        self._verdicts.move_to_end(key)
        return self._verdicts[key]

    async def explain(self, plan: int, task: str | None = None, ignore: Sequence[str] | None = None) -> dict[str, Any]:
        """Why tasks are unassigned, or why one task is done by its robot: data, and `words` for people.

        Raises
        ------
        NotFoundError, WorkError
        """
        return await self._asked("explain", plan, task=task, ignore=ignore)

    async def export(
        self,
        plan: int,
        to: str,
        options: Mapping[str, Any] | None = None,
        ignore: Sequence[str] | None = None,
    ) -> dict[str, str]:
        """Files for other programs (base64, by name); NOTES.txt holds what a person must know before the flight.

        Raises
        ------
        NotFoundError
        WorkError
            also if the plan is not valid.
        """
        answer = await self._asked("export", plan, to=to, options=dict(options or {}), ignore=ignore)
        files: dict[str, str] = answer["files"]
        if not answer["messages"]:
            return files
        notes = "".join(f"{message}\n" for message in answer["messages"])
        return {**files, "NOTES.txt": base64.b64encode(notes.encode("utf-8")).decode("ascii")}

    async def picture(self, plan: int, what: str, form: str) -> bytes:
        """Routes on the map (`routes`) or over time (`gantt`), as `png`, `svg` or `pdf`.

        Raises
        ------
        NotFoundError, WorkError
        """
        answer = await self._asked("picture", plan, what=what, format=form)
        return base64.b64decode(answer["data"])

    async def compare(self, a: int, b: int) -> dict[str, Any]:
        """The comparison of two plans of one mission: see `compared`.

        Raises
        ------
        ParameterError
            if they are of different missions.
        NotFoundError, WorkError
        """
        first, second = await self.get(a), await self.get(b)
        if first.mission != second.mission:
            raise ParameterError(f"plan {b} is of {second.mission}; expected one of {first.mission}, as plan {a}")
        return compared(first, await self.verdict(a), second, await self.verdict(b))

    async def missions(self) -> list[str]:
        """The missions of the newest plans, the one that was planned last first."""
        return await asyncio.to_thread(self._store.plans.missions)

    async def list(
        self, mission: str | None = None, limit: int = PAGE_ROWS, before: int | None = None
    ) -> list[PlanEntry]:
        """Plans of one mission or of all, newest first, without their routes and histories; ids below `before`."""
        return await asyncio.to_thread(self._store.plans.list, mission, limit, before)

    async def _asked(self, what: str, plan: int, /, **arguments: Any) -> dict[str, Any]:
        """A worker's answer about a plan and its mission."""
        return await self._pool.run(what, partial(self._given, plan, arguments))

    def _given(self, plan: int, arguments: Mapping[str, Any]) -> dict[str, Any]:
        """Read the worker's arguments from the database."""
        entry = self._store.plans.get(plan)
        mission = self._store.missions.get(entry.mission, entry.mission_version)
        given = {name: value for name, value in arguments.items() if value is not None}
        rules = {"ignore": entry.ignored, "objective": entry.objective}
        return {
            "mission": mission_input(mission.text, mission.files, entry.mission),
            "plan": dict(entry.plan),
            **rules,
            **given,
        }
