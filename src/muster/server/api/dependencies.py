"""What every route needs: the desk, and who asks."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from muster.exchange.mission_control import Who
from muster.server.services.services import Desk


def _desk(connection: HTTPConnection) -> Desk:
    found: Desk = connection.app.state.desk_of()
    return found


def _asker(connection: HTTPConnection) -> Who:
    found: Who = connection.app.state.who_of(connection)
    return found


TheDesk = Annotated[Desk, Depends(_desk)]
Asker = Annotated[Who, Depends(_asker)]
