"""A package, so that a fixture may last as long as all of its tests, and no longer."""
