"""The writers and readers that others have in a domain of DDS, by their builtin topics (DDS 1.4, 2.2.5)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from muster_robots.ros2.middleware import KEPT

_CYCLONE = "0110"
"""With what the GUIDs of Cyclone DDS begin: the vendor's number (RTPS 2.5, 9.3.1.5)."""


@dataclass(frozen=True)
class Endpoint:
    """A writer or a reader; `vendor` is the number of its make of DDS, `type_id` None where it does not tell its type.

    Parameters
    ----------
    key : str
        By which it is known, in hexadecimal digits.
    topic, kind : str
        Names of its topic and type in DDS.
    """

    key: str
    topic: str
    kind: str
    vendor: str
    type_id: Any

    @property
    def is_cyclone(self) -> bool:
        """Whether Cyclone DDS made it."""
        return self.vendor == _CYCLONE


class Endpoints:
    """Those of one kind that are there; polled.

    Parameters
    ----------
    reader : object
        A reader of the builtin topic of publications or of subscriptions.
    """

    def __init__(self, reader: Any) -> None:
        self._reader = reader
        self._topics: dict[Any, str] = {}  # by the endpoints' keys
        self._there: dict[str, dict[Any, Endpoint]] = {}  # by topic

    def all(self) -> Iterator[Endpoint]:
        """Yield those that are there now."""
        self._look()
        for endpoints in list(self._there.values()):
            yield from endpoints.values()

    def of_topic(self, topic: str) -> list[Endpoint]:
        """Return those of a topic, named as in DDS."""
        self._look()
        return list(self._there.get(topic, {}).values())

    def _look(self) -> None:
        while samples := self._reader.take(KEPT):
            for sample in samples:
                if sample.topic_name is None:  # it has ended
                    self._there.get(self._topics.pop(sample.key, ""), {}).pop(sample.key, None)
                    continue
                self._topics[sample.key] = sample.topic_name
                told = sample.key.hex, sample.topic_name, sample.type_name, sample.participant_key.hex[:4]
                self._there.setdefault(sample.topic_name, {})[sample.key] = Endpoint(*told, sample.type_id)
