"""A plan as files of the tools that people already use, and missions from them; nothing is sent to a robot.

A room of its own beside `report`, not a part of `bridges`: it needs the judge's schedule and the ways that robots go,
which lie beside the bridges and are not theirs to import.
"""
