"""The file from which a robot's process takes orders that revoke keys of robots, while it runs."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from muster.mission.errors import Finding, InputError, ParameterError
from muster_team.negotiators.negotiator import Negotiator
from muster_team.network.robot_keys import order_of

_EXPECTED = "lines that `muster auction --revoke` prints"


@dataclass
class RevocationFile:
    """A file with an order a line, to which operators add lines.

    Parameters
    ----------
    file
        its name.
    negotiator
        the robot that the orders are given to.
    """

    file: Path
    negotiator: Negotiator
    _seen: tuple[int, int] = (0, 0)  # when it was changed last, and its size
    _lines: set[str] = field(default_factory=set)

    def look(self) -> list[str]:
        """Give the robot all orders that are new; return what is wrong, a line each.

        Raises
        ------
        InputError
            if the file cannot be read the first time.
        """
        try:
            status = self.file.stat()
            if (status.st_mtime_ns, status.st_size) == self._seen:
                return []
            text = self.file.read_text(encoding="utf-8", errors="replace")
        except OSError as error:
            if self._seen != (0, 0):
                return []  # it is read again when it is back
            raise InputError([Finding(str(self.file), None, "revocations", str(error.strerror), _EXPECTED)]) from None
        self._seen = status.st_mtime_ns, status.st_size
        wrong = [self._give(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
        return [told for told in wrong if told]

    def _give(self, number: int, line: str) -> str:
        """Give the robot the order in a line, once; return what is wrong with it."""
        if line in self._lines:
            return ""
        self._lines.add(line)
        if (order := order_of(line)) is None:
            return f"{self.file}:{number}: other content; expected {_EXPECTED}"
        try:
            self.negotiator.revoke(order)
        except ParameterError as error:
            return f"{self.file}:{number}: {error}"
        return ""
