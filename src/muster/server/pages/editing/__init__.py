"""A mission that is being edited.

| part | what it does |
|---|---|
| `history` | undo and redo |
| `draft` | text, version, what is wrong with it; changes are made by workers (`server.work.editing`) |
"""
