"""The server, its user, and its allocators."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from typing import Any

from fastapi import APIRouter

from muster_control.api.bodies import BoundedRoute
from muster_control.api.dependencies import TheServices, TheUser
from muster_control.contract import Role

API = 1
"""Of the paths under /api/v1; grows when what a client relies on changes."""

router = APIRouter(tags=["about"], route_class=BoundedRoute)


@dataclass(frozen=True, kw_only=True)
class About:
    """What this server is.

    Parameters
    ----------
    worlds
        in which this server may start runs.
    upload_bytes
        the largest body of a request.
    """

    muster: str
    api: int
    worlds: list[str]
    upload_bytes: int


@dataclass(frozen=True, kw_only=True)
class Me:
    """The user, as the server sees them."""

    name: str
    role: Role
    address: str


@router.get("/about", summary="See what this server is")
async def about(services: TheServices) -> About:
    """Versions and limits."""
    worlds = ["kinematic", "physics", *services.settings.bridges]
    return About(muster=_version(), api=API, worlds=worlds, upload_bytes=services.settings.upload_bytes)


@router.get("/me", summary="See who asks")
async def me(who: TheUser) -> Me:
    """The role `watch` may read, the role `command` may also change."""
    return Me(name=who.name, role=who.role, address=who.address)


@router.get("/allocators", summary="List allocators")
async def allocators(services: TheServices) -> list[dict[str, Any]]:
    """Algorithms that plan, with their parameters."""
    return list(await services.plans.allocators())


@cache
def _version() -> str:
    return version("muster-robotics")
