"""Who may do what: tokens and roles, sessions, hosts and origins, limits; `guard` puts them before every request.

| part | what it does |
|---|---|
| `rules` | which ways of serving are safe enough to begin at all |
| `tokens` | the file of tokens with roles; how a new one is made |
| `sessions` | the page's signed cookie |
| `origins` | which host a request may name, and from which origin it may come |
| `authenticator` | who asks: a bearer's token, a session, a proxy's header, or whoever sits at this machine |
| `limits` | how often, how much, how long, how many |
| `headers` | what every answer tells browsers to forbid |
| `refusals` | what was refused, in the audit log, without filling it |
| `guard` | all of this, before everything that answers |
| `login` | the page's login and logout |
"""

from muster.server.security.authentication import user_of

__all__ = ["user_of"]
