"""One request, one judged plan: load, compile, solve, judge, explain, export; for Python, command and server alike."""
