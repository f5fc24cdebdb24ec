"""Missions that are carried out: a process each, their log, their tracks, and how they go on after a crash.

| part | where | what it does |
|---|---|---|
| `runner` | own process | carries one plan out, paced by the wall clock, and obeys |
| `simulated`, `real` | own process | what is carried out: a simulated world, or robots behind a bridge |
| `recorder`, `tracks`, `lines` | own process | all that is told becomes entries of a log and stretches of tracks |
| `run_loop` | own process | goes on by the wall clock, obeys at once, tells what happens |
| `pipe`, `pace`, `given` | own process | lines both ways; when time goes on; events as users give them |
| `runner` | server | a runner's process: started, spoken to, ended |
| `crashes` | server | when runners have died too often |
| `session` | server | one run: its runner, again after a crash; its log; its state |
| `runner_input`, `packed_log` | server | what a runner is told first; the log, packed in memory |
| `log_writer` | server | writes a run's log to the database, and to the journal while that refuses |
| `journal`, `journal_replay` | server | what the database has not taken: a file; and its way into the database |
| `subscribers` | server | tells watchers |
| `terms` | server | what may be asked |
| `claims` | server | which real robots a run has for itself |
| `recording`, `exports` | a worker | a record, a page, figures and files of other tools, from the log |
"""
