"""All allocators that plan the shipped mission 31T-6R50 within a second, by figures of the judge."""

import muster
from muster.allocation.registry import ALLOCATORS

mission = muster.load("31T-6R50")
for allocator in ALLOCATORS:
    try:
        plan = muster.solve(mission, allocator, time_limit=1.0, seed=1)
    except muster.MusterError as error:
        print(f"{allocator:>20}  {error}")
        continue
    verdict = muster.verify(mission, plan)
    print(f"{allocator:>20}  {plan.tasks_completed} of {plan.tasks_total} tasks, {verdict.value():.2f}")
