"""A mission that is being edited: on the map, as a form and as text.

| part | what it does |
|---|---|
| `draft` | the text, its version and its errors; workers make changes (`server.work.editing`) |
| `history` | undo and redo |
| `editors` | map, form and text of one draft, which show the same |
| `form`, `table`, `cell_texts` | the form: tables of robots, tasks and stations; the texts of their cells |
| `text_view`, `text_editor` | the text with marked errors; the editor in the browser |
| `concurrent_edits` | merges typed changes with a text that is being sent to the browser |
| `zone_form` | the dialog of a new zone |
| `findings` | what is wrong with the mission, and the tasks that can never be done |
"""
