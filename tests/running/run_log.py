"""The log of a run, as the database has it, for tests that look at its entries."""

import json

from muster.mission.yaml_writer import plain


class Log:
    """The entries of a run's log."""

    def __init__(self):
        self.entries = []

    def on_event(self, now, kind, data):
        self.entries.append(json.loads(json.dumps({"time_s": now, "kind": kind, "data": plain(data)})))

    def on_plan(self, now, plan):
        self.on_event(now, "plan", {"plan": plan.as_dict()})

    def on_report(self, report):
        self.on_event(0.0, "report", report)

    def on_telemetry(self, *_): ...

    on_step = on_telemetry
