"""Where the mutation of the random algorithms looks for k1 and k2, the bounds of a task's new place.

[tcf-thesis], section 3.2.2, Algorithm 4, steps 4 and 5: a task is put between its latest prerequisite (k1) and its
earliest dependant (k2). The text leaves two things open.

- Of which sequences k1 and k2 are order numbers: of the one that receives the task (`receiver`), of every one (`all`),
  or of every one but that which the task leaves (`others`).
- Whether every place from k1 to k2 may be drawn, or only those strictly between them (`-inner`): then a task never
  becomes the first of a sequence, nor takes the place just before its dependant; without prerequisites k1 is the first
  place, without dependants k2 is the end.

Only `receiver` is a sound bound. With the others the shortest sequence bounds the places in all, and when it is empty
no task with dependants moves any more: the algorithm is trapped. The published runs are so (`muster study thesis-3.3
--tables readings`).
"""

from __future__ import annotations

from muster.mission.values.keywords import require_one_of

RECEIVER, AS_RUN = "receiver", "others-inner"
BOUNDS = (RECEIVER, "receiver-inner", "all", "all-inner", "others", AS_RUN)


def checked_bounds(bounds: str) -> None:
    """Raise ParameterError unless `bounds` is one of BOUNDS."""
    require_one_of("bounds", bounds, BOUNDS, joined_by=" or ")
