"""A checked model: every run of the shipped core within bounds, for three robots, two tasks and two orders."""
