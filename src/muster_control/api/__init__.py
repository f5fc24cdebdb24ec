"""Mission control over HTTP and WebSocket, one module per resource, described by OpenAPI.

| part | what it does |
|---|---|
| `api` | the application that is mounted under /api/v1 |
| `dependencies` | what every route needs: the services, the user, known parameters |
| `bodies` | reads bodies within limits; accepts only JSON that databases can store |
| `parameter_types` | types of parameters: ids, names, texts, numbers |
| `problems` | errors as problem JSON |
| `responses` | answers that are not plain JSON: files; and the description of answers |
| `description` | OpenAPI, and a page that lists all routes |
| `missions`, `plans`, `jobs`, `runs`, `records`, `actions`, `about` | the resources |
"""

from muster_control.api.api import PREFIX, api

__all__ = ["PREFIX", "api"]
