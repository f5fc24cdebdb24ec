"""Tables on standard output: how one is printed, and the tables of plans, schedules, reports and reasons."""
