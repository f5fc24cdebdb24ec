"""Coordinations: how robots of a simulated mission decide who does what without a plan, found by entry point.

No heavy module is imported.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

from muster.mission.errors import ParameterError
from muster.mission.records import Settings, record
from muster.mission.system.plugins import Registry

if TYPE_CHECKING:
    from muster.execution import Recorder, Report
    from muster.mission.model import Mission
    from muster.running.observed_run import ObservedRun


@record
class Coordination(Settings, ABC):
    """A way in which robots decide who does what without a plan, while time passes as in reality.

    `muster simulate` has a flag named after the entry point of each subclass, and an option for each of the fields that
    the subclass declares by `spec`.

    Attributes
    ----------
    params : mapping or object, optional
        Parameters of the method by which robots decide: by name, or as an instance of the method's own class. Without
        them the method's defaults hold.
    """

    summary: ClassVar[str]
    """The help of the flag."""

    params: Any = None

    @abstractmethod
    def refuse_mission(self, mission: Mission) -> None:
        """Raise `ParameterError` if a setting is wrong, or if robots cannot decide on the mission in this way."""

    @abstractmethod
    def carry_out(self, mission: Mission, request: ObservedRun, recorder: Recorder | None) -> Report:
        """Let robots decide and work until the mission is over, or until `halt` of the request is set.

        Raises
        ------
        MusterError
            if the mission cannot be carried out in this way.
        """


def _checked(name: str, found: object) -> type[Coordination]:
    if not (isinstance(found, type) and issubclass(found, Coordination)):
        raise ParameterError(f"it is a {type(found).__name__}; expected a class made from Coordination")
    return found


COORDINATIONS: Registry[type[Coordination]] = Registry("coordination", "muster.coordination", _checked)
