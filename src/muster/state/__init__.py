"""All that is known of a mission under way: typed events, and the state that is the fold of them, and nothing else."""

import muster.state.ground_events
import muster.state.robot_events
import muster.state.run_events
import muster.state.station_events
import muster.state.task_events  # noqa: F401 - each makes its kinds known
from muster.state.checkpoint import checkpoint_of, restored
from muster.state.event import ExecutionEvent, OtherEvent, event_of
from muster.state.mission_state import MissionState

__all__ = ["ExecutionEvent", "MissionState", "OtherEvent", "checkpoint_of", "event_of", "restored"]
