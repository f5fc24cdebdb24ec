"""The folder of a property's examples, as the tests of Muster's own files have it."""

from tests.mission.conftest import folder

__all__ = ["folder"]
