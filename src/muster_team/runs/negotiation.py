"""The request of a negotiation: how robots agree before and while they carry out a mission without a central planner.

No heavy module is imported.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from muster.mission.records import record, spec
from muster.mission.value_types import Choice, Text
from muster.running.coordination import Coordination
from muster_team.network.transport import TRANSPORTS

if TYPE_CHECKING:
    from muster.execution import Recorder, Report
    from muster.mission.model import Mission
    from muster.running.observed_run import ObservedRun


@record
class Negotiation(Coordination):
    """How robots agree.

    Attributes
    ----------
    params : mapping or object, optional
        Parameters of the method's allocator: by name, or as an instance of their class.
    limit_s : float
        Real seconds within which robots have to agree before the mission begins.
    """

    summary: ClassVar[str] = "No plan: each robot is a process, and they agree among themselves."

    method: str = spec(Text(), "how robots agree", default="auction", metavar="NAME")
    transport: str = spec(Choice(TRANSPORTS), "what carries messages", default="udp")
    limit_s: float = 60.0

    @property
    def terms(self) -> Any:
        """The parameters of the method's allocator, which all robots share."""
        from muster.allocation.allocator import make_parameters
        from muster_team.negotiators.methods import method_named

        allocator = method_named(self.method).allocator
        if self.params is None or isinstance(self.params, Mapping):
            return make_parameters(allocator, dict(self.params or {}))
        return self.params

    def refuse_mission(self, mission: Mission) -> None:
        """See `Coordination`."""
        from muster_team.auctions.capabilities import refuse_mission
        from muster_team.negotiators.methods import method_named

        refuse_mission(mission, method_named(self.method).can)
        _ = self.terms

    def carry_out(self, mission: Mission, request: ObservedRun, recorder: Recorder | None) -> Report:
        """See `Coordination`."""
        from muster_team.runs.simulation import negotiate_and_carry_out

        how: dict[str, Any] = {"method": self.method, "terms": self.terms, "transport": self.transport}
        return negotiate_and_carry_out(mission, request, recorder, **how, limit_s=self.limit_s)
