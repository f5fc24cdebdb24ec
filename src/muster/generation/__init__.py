"""Random missions by families: the same family, parameters and seed give the same mission on every machine."""
