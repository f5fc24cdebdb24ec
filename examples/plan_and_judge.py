"""A mission built in Python: two rovers, one of them with a gripper, and tasks that wait for each other."""

import muster

mission = muster.Mission(
    name="yard",
    robots=(
        muster.Robot(id="digger", position=(0, 0), work_capacity=60),
        muster.Robot(id="gripper", position=(10, 0), work_capacity=60, skills=("gripper",)),
    ),
    tasks=(
        muster.Task(id="survey", position=(4, 8)),
        muster.Task(id="clear", position=(5, 9), prerequisites=("survey",), actuation_cost=5),
        muster.Task(id="fetch", position=(9, 9), prerequisites=("clear",), requires=("gripper",)),
        muster.Task(id="lift", position=(12, 3), requires=("crane",)),  # nobody has one
    ),
)
plan = muster.solve(mission, allocator="search", time_limit=0.5, seed=1)
for route in plan.routes:
    print(f"{route.robot}: {', '.join(route.tasks)}")
for left in plan.unassigned:
    print(f"{left.task} is left out: {', '.join(sorted({reason.reason for reason in left.reasons}))}")
verdict = muster.verify(mission, plan)
print(f"valid: {verdict.valid}, total cost {verdict.total_cost:.2f}")
