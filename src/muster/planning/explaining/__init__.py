"""What can be done of a mission, and why a plan is as it is: found once, for the command and for mission control."""

from muster.planning.explaining.explanations import LeftOut, OneTask, left_out, one_task, require_fit
from muster.planning.explaining.impossible import Possible, possible

__all__ = ["LeftOut", "OneTask", "Possible", "left_out", "one_task", "possible", "require_fit"]
