"""Proofs without a solver: lower bounds of the objective, of usage and of times, and what follows from them."""
