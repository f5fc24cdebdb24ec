"""The process that carries out one run; the server starts it as `python -m muster_control.runs.runner.main`.

| part | what it does |
|---|---|
| `main` | starts a new or resumed run, within its limit of memory |
| `run_loop`, `pacing` | advances the run by the wall clock, and applies users' actions at once |
| `simulated_run`, `real_run` | what is advanced: a simulated world, or robots of a fleet |
| `user_events` | reads events from users |
| `log_recorder` | turns what happens into log entries and tracks |
| `pipe` | lines from and to the server |
| `lock` | one runner a run of real robots |
"""
