"""Records: one MCAP file of a mission that is carried out, written and read."""

from muster.report.record.reader import read_record
from muster.report.record.recording import PlanVersion, Recording, Tracks
from muster.report.record.writer import RecordWriter
from muster.state import ExecutionEvent

__all__ = ["ExecutionEvent", "PlanVersion", "RecordWriter", "Recording", "Tracks", "read_record"]
