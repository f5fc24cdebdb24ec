"""Consistency rules between the parts of a mission: ids, references, units, order of tasks and deliveries."""
