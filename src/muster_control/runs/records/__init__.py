"""What a worker makes of the log and the tracks of a run.

| part | what it does |
|---|---|
| `recording` | an MCAP record, the page of a replay, figures |
| `exports` | tables, tracks and maps for other programs |
| `record_files` | the files in which the worker gets log and tracks |
"""
