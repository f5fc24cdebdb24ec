"""Draws the figures of all studies and makes the page that shows them."""
