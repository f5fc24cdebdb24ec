"""Missions as workers are given them."""

import base64

from muster.library import mission_path

TINY = """
schema: muster/1
name: tiny
robots:
  - {id: r_0, position: [0, 0]}
  - {id: r_1, position: [10, 0]}
tasks:
  - {id: a, position: [1, 0]}
  - {id: b, position: [9, 0], prerequisites: [a]}
"""
MAPPED = """
schema: muster/1
name: mapped
map: {image: floors/floor.png, resolution_m: 1}
robots: [{id: r_0, position: [0.5, 0.5]}]
tasks: [{id: a, position: [2.5, 0.5]}]
"""
FLOOR = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAQAAAACCAAAAABawyK/AAAAEklEQVR4nGP8z8DAwMTAwMAAAAkVAQPWmbXHAAAAAElFTkSuQmCC"
)


def given(text, files=None, name="m"):
    """A mission as workers take it."""
    plain = {key: base64.b64encode(data).decode("ascii") for key, data in (files or {}).items()}
    return {"text": text, "name": name, "files": plain}


def shipped(name):
    return given(mission_path(name).read_text(encoding="utf-8"), name=name)
