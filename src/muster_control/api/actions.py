"""The audit log of users' actions."""

from __future__ import annotations

from fastapi import APIRouter

from muster_control.api.bodies import BoundedRoute
from muster_control.api.dependencies import ThePage, TheServices
from muster_control.api.parameter_types import BeforeAction, RunQuery
from muster_control.api.responses import PAGED
from muster_control.contract import Action

router = APIRouter(prefix="/actions", tags=["actions"], route_class=BoundedRoute)


@router.get("", summary="Read the audit log", responses=PAGED)
async def actions(
    services: TheServices, page: ThePage, run: RunQuery = None, before: BeforeAction = None
) -> list[Action]:
    """Newest first; `before` the last `id` gives the next ones."""
    return page.of(await services.actions.list(run, page.rows, before), before=lambda action: action.id)
