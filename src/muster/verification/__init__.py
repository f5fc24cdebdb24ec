"""An independent judge of plans: every figure and every rule recomputed, sharing no code with allocators."""

from muster.verification.judge import verify
from muster.verification.verdict import RouteFigures, Stop, Verdict, Violation, Visit

__all__ = ["RouteFigures", "Stop", "Verdict", "Violation", "Visit", "verify"]
