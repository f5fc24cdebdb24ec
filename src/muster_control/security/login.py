"""Login and logout of the pages: a plain HTML form, the only page that needs no login."""

from __future__ import annotations

from html import escape
from string import Template
from urllib.parse import parse_qs

from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import Route

from muster.mission.texts.packaged_files import packaged_text
from muster_control.contract import User
from muster_control.security.authentication import SCOPE_KEY, Caller
from muster_control.security.guard import GuardState
from muster_control.security.refusal import RefusalError
from muster_control.security.sessions import COOKIE, SECURE_COOKIE

_FORM_BYTES = 4096

_PAGE = Template(packaged_text("muster_control.security", "login.html"))


def login_routes(guard_state: GuardState) -> list[Route]:
    """The routes `/login` and `/logout`."""

    async def show(request: Request) -> Response:
        if guard_state.authenticator.tokens is None:
            return RedirectResponse("/", 303)
        return _form(request.query_params.get("next", "/"))

    async def log_in(request: Request) -> Response:
        return await _logged_in(guard_state, request)

    async def log_out(request: Request) -> Response:
        caller: Caller = request.scope[SCOPE_KEY]
        if caller.session is not None and guard_state.authenticator.sessions is not None:
            guard_state.authenticator.sessions.end(caller.session)
            guard_state.audit.logged_out(caller.who)
        response = RedirectResponse("/login", 303)
        for name in (COOKIE, SECURE_COOKIE):
            response.delete_cookie(name, secure=name == SECURE_COOKIE, httponly=True, samesite="strict")
        return response

    return [
        Route("/login", show, methods=["GET"], include_in_schema=False),
        Route("/login", log_in, methods=["POST"], include_in_schema=False),
        Route("/logout", log_out, methods=["POST"], include_in_schema=False),
    ]


async def _logged_in(guard_state: GuardState, request: Request) -> Response:
    """Begin a session for a right token; show the form again for a wrong one."""
    authenticator = guard_state.authenticator
    if authenticator.tokens is None or authenticator.sessions is None:
        return RedirectResponse("/", 303)
    caller: Caller = request.scope[SCOPE_KEY]
    address = caller.who.address
    form = await _fields(request)
    holder = authenticator.tokens.holder(form.get("token", "").strip())
    if holder is None:
        guard_state.count_wrong_token(address)
        guard_state.audit.refused(User("", "watch", address), "wrong token at login", "/login", 403)
        return _form(form.get("next", "/"), "Nobody has this token.", status=403)
    guard_state.audit.logged_in(User(holder.name, holder.role, address))
    cookie, lasts_s = authenticator.sessions.begin(holder)
    response = RedirectResponse(_own_path(form.get("next", "/")), 303)
    secure = request.url.scheme == "https" or request.headers.get("origin", "").startswith("https://")
    name = SECURE_COOKIE if secure else COOKIE
    response.set_cookie(name, cookie, max_age=int(lasts_s), secure=secure, httponly=True, samesite="strict")
    return response


async def _fields(request: Request) -> dict[str, str]:
    """The fields of a small form.

    Raises
    ------
    RefusalError
        if it is no form, or too large.
    """
    body = b""
    async for piece in request.stream():
        body += piece
        if len(body) > _FORM_BYTES:
            raise RefusalError(413, f"the form is too large; expected at most {_FORM_BYTES} bytes")
    try:
        fields = parse_qs(body.decode("ascii"), max_num_fields=10)
    except ValueError:
        raise RefusalError(400, "the form cannot be read; expected token=...") from None
    return {name: values[0] for name, values in fields.items()}


def _form(following: str, alert: str = "", status: int = 200) -> Response:
    told = f'<p role="alert">{escape(alert)}</p>' if alert else ""
    return HTMLResponse(_PAGE.substitute(alert=told, next=escape(_own_path(following), quote=True)), status)


def _own_path(path: str) -> str:
    """The path, if it is one of this server; `/` otherwise."""
    own = path.startswith("/") and not path.startswith(("//", "/\\")) and path.isprintable()
    return path if own and not path.startswith("/login") else "/"
