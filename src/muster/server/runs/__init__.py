"""Missions that are carried out: a process each, their log, their tracks, and how they go on after a crash.

| part | where | what it does |
|---|---|---|
| `runner` | own process | carries one plan out, paced by the wall clock, and obeys |
| `simulated`, `real` | own process | what is carried out: a simulated world, or robots behind a bridge |
| `scribe`, `tracks`, `lines` | own process | all that is told becomes entries of a log and stretches of tracks |
| `performance` | own process | goes on by the wall clock, obeys at once, tells what happens |
| `pipe`, `pace`, `given` | own process | lines both ways; when time goes on; events as users give them |
| `child` | server | a runner's process: started, spoken to, ended |
| `deaths` | server | when runners have died too often |
| `carrying` | server | one run: its runner, again after a crash; its log; its state |
| `brief`, `memory` | server | what a runner is told first; the log, packed in memory |
| `journal` | server | writes a run's log to the database, and keeps it in memory while that refuses |
| `unkept` | server | actions that the database has not taken in time |
| `feed` | server | tells watchers |
| `terms` | server | what may be asked |
| `claims` | server | which real robots a run has for itself |
| `recording`, `exports` | a worker | a record, a page, figures and files of other tools, from the log |
"""
