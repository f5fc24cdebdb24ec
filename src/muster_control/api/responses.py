"""Responses that are files, and the description of responses in OpenAPI."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from urllib.parse import quote

from starlette.responses import Response

from muster_control.problem import MEDIA_TYPE
from muster_control.services.archives import archive_of

Responses = dict[int | str, dict[str, Any]]

_WHY = {
    400: "What was sent is wrong; `findings` says where.",
    401: "No token, or one that nobody has.",
    403: "Whoever asked may only watch.",
    404: "There is no such thing.",
    405: "Not with this method.",
    409: "It cannot be done as things are now.",
    413: "The body is too long.",
    422: "A parameter or body is of a wrong form; `findings` says where.",
    428: "Neither If-Match nor base_version says which version it is based on.",
    429: "A limit is reached; ask again after Retry-After.",
    501: "An optional part of the server's installation is absent.",
    503: "The database cannot be used, or the server is about to stop.",
}
ALWAYS = (400, 401, 403, 404, 413, 422, 429, 501, 503)
"""Statuses of errors of every route."""


def errors(*statuses: int) -> Responses:
    """The description of errors."""
    schema = {"$ref": "#/components/schemas/Problem"}
    return {status: {"description": _WHY[status], "content": {MEDIA_TYPE: {"schema": schema}}} for status in statuses}


def file_described(*kinds: str, what: str) -> Responses:
    """The description of a response that is a file of one of these media types."""
    schema = {"type": "string", "contentMediaType": "application/octet-stream"}
    header = {"description": "How the file is called.", "schema": {"type": "string"}}
    content = {kind: {"schema": schema} for kind in kinds}
    return {200: {"description": what, "content": content, "headers": {"Content-Disposition": header}}}


def with_location(status: int, what: str, *, etag: bool = False) -> Responses:
    """The description of a response with the header `Location`."""
    headers = {"Location": {"description": "Where it is.", "schema": {"type": "string"}}}
    if etag:
        headers["ETag"] = {"description": "Its version, for If-Match.", "schema": {"type": "string"}}
    return {status: {"description": what, "headers": headers}}


PAGED: Responses = {
    200: {
        "headers": {
            "Link": {
                "description": 'Where there is more: the address of the next page, with `rel="next"` (RFC 8288).',
                "schema": {"type": "string"},
            }
        }
    }
}
"""The description of a page of a list."""


def file_response(data: bytes, name: str, kind: str, *, shown_in_place: bool = False) -> Response:
    """A file: browsers save it, or show it in a sandbox."""
    plain = "".join(c if c.isascii() and (c.isalnum() or c in "._- ") else "_" for c in name) or "file"
    how = "inline" if shown_in_place else "attachment"
    headers = {
        "Content-Disposition": f"{how}; filename=\"{plain}\"; filename*=UTF-8''{quote(name, safe='')}",
        "X-Content-Type-Options": "nosniff",
        "Content-Security-Policy": "sandbox allow-scripts allow-downloads",
        "Cache-Control": "no-store",
    }
    return Response(data, headers=headers, media_type=kind)


async def archive_response(files: Mapping[str, str], name: str) -> Response:
    """Files (base64, by name) as one response: the file itself, or a ZIP of several."""
    data, called = await archive_of(files, name)
    return file_response(data, called, "application/octet-stream" if len(files) == 1 else "application/zip")
