"""Authentication, roles and limits. `guard` checks every request before the application sees it.

| part | what it does |
|---|---|
| `serving_rules` | which settings are safe to serve with |
| `tokens` | the file of tokens with roles; how a new one is made |
| `sessions` | the page's signed cookie |
| `origins` | which host a request may name, and from which origin it may come |
| `authentication` | the user of a request: by a token, a session, a proxy's header, or as the user of this machine |
| `limits` | limits of rates, sizes, times and WebSockets |
| `headers` | security headers of every response |
| `refusal`, `refusal_log` | a refused request; refusals and logins in the audit log |
| `guard` | the middleware that applies all of this |
| `login` | the page's login and logout |
"""

from muster_control.security.authentication import user_of

__all__ = ["user_of"]
