"""Runs: missions that are carried out, a process each, which resume after a crash.

| part | process | what it does |
|---|---|---|
| `runner` | one a run | carries a plan out: a simulated world or real robots |
| `log` | server, runner | what the database keeps of a run, and a journal while it refuses |
| `records` | worker | records, pages, figures and files of other programs, made of the log |
| `run_settings` | server | the checks of a requested run and of users' actions |
| `run_session` | server | one run: its runner, started again after a crash; its log; its state |
| `runner_input`, `runner_process` | server | what a runner reads first; its process: started, spoken to, ended |
| `crash_history` | server | when runners have died too often |
| `subscribers` | server | those who watch a run |
"""
