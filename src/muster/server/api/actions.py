"""The audit log of users' actions."""

from __future__ import annotations

from fastapi import APIRouter

from muster.server.api.bodies import BoundedRoute
from muster.server.api.dependencies import ThePage, TheServices
from muster.server.api.parameter_types import BeforeAction, RunQuery
from muster.server.api.responses import PAGED
from muster.server.contract import Action

router = APIRouter(prefix="/actions", tags=["actions"], route_class=BoundedRoute)


@router.get("", summary="Read the audit log", responses=PAGED)
async def actions(
    services: TheServices, page: ThePage, run: RunQuery = None, before: BeforeAction = None
) -> list[Action]:
    """Newest first; `before` the last `id` gives the next ones."""
    return page.of(await services.actions.list(run, page.rows, before), before=lambda action: action.id)
