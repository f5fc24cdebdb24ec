"""Who does what, in which order: one algorithm a file, behind one interface."""
