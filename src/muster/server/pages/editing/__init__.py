"""A mission that is being edited.

| part | what it does |
|---|---|
| `history` | undo and redo |
| `crossing` | what is typed while another text is on its way to the browser |
| `draft` | text, version, what is wrong with it; changes are made by workers (`server.work.editing`) |
"""
