"""Mission control: missions, plans, runs and records of a team, in the browser and over HTTP, kept in a database.

| part | what it does |
|---|---|
| `words` | what is passed between the parts: plain frozen data |
| `settings` | how a server was asked to be |
| `store` | the database: tables, migrations, backup |
| `work` | planning and other long work, in processes of their own with limits |
| `runs` | missions that are carried out: a process each, their log, and how they go on after a crash |
| `services` | all that mission control can do; the API and the pages are its two faces |
| `security` | who may do what: tokens, roles, origins, limits |
| `api` | HTTP and WebSocket, described by OpenAPI |
| `pages` | the web page |
| `client` | a server seen from Python |
"""
