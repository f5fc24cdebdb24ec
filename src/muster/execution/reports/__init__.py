"""Results: the report beside the plan, the places of each robot by time, and the separation between robots."""
