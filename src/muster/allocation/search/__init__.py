"""Ruin and recreate under simulated annealing; large teams in parts, on threads or machines; short searches."""
