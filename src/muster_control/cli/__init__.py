"""The verbs `serve` and `db`."""
