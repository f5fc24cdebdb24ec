"""What is kept of a run: the entries of its log, the tracks of its robots, its checkpoints.

| part | what it does |
|---|---|
| `writer` | writes entries and tracks to the database in order, and to the journal while the database refuses |
| `journal`, `journal_replay` | a file of what the database has not taken; how that gets into the database |
| `checkpoints`, `tracks` | when a checkpoint is due; how checkpoints and positions are packed |
"""
