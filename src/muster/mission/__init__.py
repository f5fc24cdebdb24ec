"""The question and the answer as data: robots, tasks, missions, plans, and their files.

What a mission consists of has a module each here, `model` and `plan` hold both together, and `value_types` and
`records` declare fields. Wings: `reading` of files, `consistency` between the parts, `areas` of tasks, further kinds of
`values`, `texts`, and the operating `system`.
"""
