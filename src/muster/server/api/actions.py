"""The audit log of users' actions."""

from __future__ import annotations

from fastapi import APIRouter

from muster.exchange.mission_control import Action
from muster.server.api.bodies import BoundedRoute
from muster.server.api.dependencies import TheServices
from muster.server.api.parameter_types import Before, Limit, RunQuery

router = APIRouter(prefix="/actions", tags=["actions"], route_class=BoundedRoute)


@router.get("", summary="Read the audit log")
async def actions(
    services: TheServices, run: RunQuery = None, limit: Limit = 200, before: Before = None
) -> list[Action]:
    """Newest first; `before` the last `id` gives the next ones."""
    return list(await services.actions.list(run=run, limit=limit, before=before))
