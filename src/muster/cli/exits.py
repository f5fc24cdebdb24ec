"""Exit codes of the command."""

DONE = 0
REJECTED = 1
BAD_INPUT = 2
INCOMPLETE = 3
"""Tasks are left out that are required; or no run of a comparison has a plan."""
STILL_MOVING = 4
"""A real robot still flies or drives, or did when it was last heard."""
TASKS_LOST = 5
"""Real robots are safe, and tasks were lost."""
INTERNAL_ERROR = 70
INTERRUPTED = 130
BROKEN_PIPE = 141
