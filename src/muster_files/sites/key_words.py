"""Headings of names and of energy in the languages of those who write tables: lower case, without spaces and marks."""

from __future__ import annotations

from muster.mission.texts.packaged_files import packaged_data

_WORDS = packaged_data("muster_files.sites", "key_words.yaml")


def _words(subject: str) -> tuple[str, ...]:
    return tuple(_WORDS[subject].split())


NAMES, TYPES, MODELS, ENDURANCE, RANGE = map(_words, ("names", "types", "models", "endurance", "range"))
BATTERY = _words("battery")
"""Of what may be a time, a length, or neither."""
OF_ROBOTS = ("drone", "uav", "uas", "ugv", "rover", "vehicle", "aircraft")
"""Words before headings that say that they are of robots: `Drone ID`."""
SUBJECTS, MOST = _words("subjects"), _words("most")
