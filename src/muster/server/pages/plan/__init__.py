"""The view *Plan*: a mission on the map, as a form and as text, its plans, and their explanations."""

from muster.server.pages.plan import compare, view

__all__ = ["compare", "view"]
