"""Why a plan is as it is: found once, for the command and for mission control."""

from muster._explaining.answers import LeftOut, OneTask, left_out, one_task, require_fit

__all__ = ["LeftOut", "OneTask", "left_out", "one_task", "require_fit"]
