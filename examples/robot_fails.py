"""A mission carried out while a robot fails: the others take over what they can."""

import dataclasses

import muster

mission = muster.load("31T-6R50")
failing = mission.robots[0].id
mission = dataclasses.replace(mission, events=(muster.Event(at_s=5.0, robot_fails=failing),))
plan = muster.solve(mission, allocator="greedy")
report = muster.simulate(mission, plan)
print(f"{failing} fails after 5 s; {len(report.tasks_done)} tasks are done, {len(report.tasks_lost)} are lost")
