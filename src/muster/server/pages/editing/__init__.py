"""A mission that is being edited.

| part | what it does |
|---|---|
| `history` | undo and redo |
| `concurrent_edits` | merges typed changes with a text that is being sent to the browser |
| `draft` | the text, its version and its errors; workers make changes (`server.work.editing`) |
"""
