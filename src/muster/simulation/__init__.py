"""Worlds in which a plan is carried out."""
