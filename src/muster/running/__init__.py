"""One plan -> one run: in a simulated world, on real robots, or without a centre."""
