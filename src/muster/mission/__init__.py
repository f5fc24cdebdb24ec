"""The question and the answer as data: robots, tasks, missions, plans, and their files."""
