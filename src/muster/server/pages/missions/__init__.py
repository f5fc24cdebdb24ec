"""The view *Missions*: those of this server and those that ship; search, make, duplicate, delete."""

from muster.server.pages.missions.view import view

__all__ = ["view"]
