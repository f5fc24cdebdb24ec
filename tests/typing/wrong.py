"""What a type checker must refuse: each line that ends in `# error`, and no other."""

import muster

muster.Robot()  # error
muster.Robot(id="r")  # error
muster.Robot(id="r", postion=(0.0, 0.0))  # error
muster.Robot(id="r", position="here")  # error
muster.Task(id="t", position=(0.0, 0.0), duration="long")  # error
muster.Camera(fov=60.0)  # error
mission = muster.load("31T-6R50")
mission.robot  # error
muster.load("31T-6R50", robts="r.csv")  # error
plan = muster.solve(mission)
muster.solve(mission, time_limt=3)  # error
muster.solve(mission, "genetic", population_size="many")  # error
plan.save()  # error
muster.verify(mission, 3)  # error
muster.verify(mission, plan).valit  # error
muster.simulate(mission, plan, wrold="physics")  # error
muster.simulate(mission, plan, dt_s="short")  # error
muster.simulate(mission, plan).mission_time  # error
muster.plot(mission, plan).no_such_thing()  # error
muster.gantt(mission, plan).no_such_thing()  # error
muster.export(mission, plan, "qgc", altitud=10.0)  # error
muster.solve(mission, objective=lambda verdict: verdict.max_use)  # error
muster.explain(mission, plan, "t").unassigned  # error
