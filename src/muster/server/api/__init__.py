"""Mission control over HTTP and WebSocket: the services of `desk`, a file a resource, described by OpenAPI.

| part | what it does |
|---|---|
| `api` | puts it together: what is mounted under /api/v1 |
| `asking` | what every route needs: the desk, who asks |
| `bodies` | reads bodies within limits; JSON that a database and other programs can take |
| `checked` | kinds of parameters: ids, names, texts, numbers |
| `problems` | every failure as problem JSON |
| `answers` | what answers beside plain words: files, what was made, what was accepted |
| `description` | OpenAPI, and a page that lists it |
| `missions`, `plans`, `jobs`, `runs`, `records`, `actions`, `about` | the resources |
"""

from muster.server.api.api import PREFIX, api

__all__ = ["PREFIX", "api"]
