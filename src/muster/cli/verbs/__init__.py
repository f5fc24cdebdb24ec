"""The verbs of `muster` that ship, a module each, and what one verb alone needs."""
