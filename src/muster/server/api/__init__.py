"""Mission control over HTTP and WebSocket: a file a resource, described by OpenAPI.

| part | what it does |
|---|---|
| `api` | puts it together: what is mounted under /api/v1 |
| `dependencies` | what every route needs: the services, the user, known parameters |
| `bodies` | reads bodies within limits; JSON that a database and other programs can take |
| `parameter_types` | kinds of parameters: ids, names, texts, numbers |
| `problems` | every failure as problem JSON |
| `responses` | answers that are not plain JSON: files; and the description of answers |
| `description` | OpenAPI, and a page that lists it |
| `missions`, `plans`, `jobs`, `runs`, `records`, `actions`, `about` | the resources |
"""

from muster.server.api.api import PREFIX, api

__all__ = ["PREFIX", "api"]
