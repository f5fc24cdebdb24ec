"""Mission control: missions, plans, runs and records of a team, in the browser and over HTTP, stored in a database.

| part | what it does |
|---|---|
| `contract` | the data and errors that the server and its client exchange |
| `settings` | the settings of a server |
| `app`, `serving` | the application, and the HTTP server that runs it |
| `store` | the database: tables, migrations, backup |
| `work` | planning and other long work, in worker processes with limits |
| `runs` | runs: a process each, their log, and how they resume after a crash |
| `services` | what mission control can do; the API and the pages call it |
| `security` | authentication, roles, origins and limits |
| `api` | HTTP and WebSocket, described by OpenAPI |
| `pages` | the web pages |
"""
