"""The audit log of users' actions."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from muster.exchange.mission_control import PAGE_ROWS, Action
from muster.server.api.bodies import BoundedRoute
from muster.server.api.dependencies import TheServices
from muster.server.api.parameter_types import BeforeAction, Limit, RunQuery
from muster.server.api.responses import PAGED, page_of

router = APIRouter(prefix="/actions", tags=["actions"], route_class=BoundedRoute)


@router.get("", summary="Read the audit log", responses=PAGED)
async def actions(
    services: TheServices,
    request: Request,
    response: Response,
    run: RunQuery = None,
    limit: Limit = PAGE_ROWS,
    before: BeforeAction = None,
) -> list[Action]:
    """Newest first; `before` the last `id` gives the next ones."""
    found = await services.actions.list(run, limit + 1, before)
    return page_of(found, limit, request, response, before=lambda action: action.id)
