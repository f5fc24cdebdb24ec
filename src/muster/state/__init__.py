"""All that is known of a mission under way: typed events, and the state that is the fold of them, and nothing else."""

from muster.state.event import ExecutionEvent, OtherEvent, event_of
from muster.state.mission_state import MissionState

__all__ = ["ExecutionEvent", "MissionState", "OtherEvent", "event_of"]
